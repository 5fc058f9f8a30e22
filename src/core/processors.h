// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <utility>

namespace lisco {

/// The number of the processor that runs this thread; negative where the system does not tell.
int currentProcessor() noexcept;

/// Moves this thread to another processor, if this one runs it and it may run on others. It may return later: the
/// processors allowed to it stay as they are.
void leaveProcessor(int processor) noexcept;

/// Spreads threads that start together over the processors. After a pause, Linux often wakes a thread on the processor
/// of the caller though others are idle, as it takes a virtual machine's idle processors for occupied; it moves the
/// thread milliseconds later, which is longer than a rotation takes (benchmarks/suite.sh threads, "paused").
class SpreadStart {
 public:
  /// Made by the caller. \param threads with the caller
  explicit SpreadStart(std::size_t threads)
      : caller_(std::this_thread::get_id()), processor_(currentProcessor()), missing_(threads - 1) {}

  /// Called by each thread, including the caller, when it starts.
  void enter() noexcept {
    if (std::this_thread::get_id() == caller_) return letOthersStart();
    missing_.fetch_sub(1, std::memory_order_relaxed);
    leaveProcessor(processor_);
  }

 private:
  /// Looks for threads that have not started, before they get this processor for a moment: about half a microsecond.
  /// Threads that wait for work on their own processors take less.
  static constexpr int kLooks = 1000;

  void letOthersStart() noexcept {
    if (std::exchange(has_looked_, true)) return;  // the caller does the work of threads that did not start
    for (int look = 0; missing_.load(std::memory_order_relaxed) != 0; ++look)
      if (look == kLooks) return std::this_thread::yield();
  }

  const std::thread::id caller_;
  const int processor_;      ///< of the caller
  bool has_looked_ = false;  ///< the caller
  std::atomic<std::size_t> missing_;
};

}  // namespace lisco
