// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

namespace lisco {

/// The shares of threads in work that comes again with each rotation: equal at first, then such that all take equally
/// long. For equal counted work, threads take up to a third longer or shorter: caches and branches differ.
class WorkShares {
 public:
  /// Begins a rotation. Shares are kept from one to the next if there are as many threads.
  void begin(std::size_t threads) {
    if (threads != threads_.size()) {
      threads_.assign(threads, Thread{1 / static_cast<double>(threads)});
      period_ = kFirstPeriod;
      rotations_ = 0;
      return;
    }
    if (isMeasured()) {
      for (Thread& thread : threads_) thread.least = std::min(thread.least, thread.seconds);
      ++rotations_;
    }
    for (Thread& thread : threads_) thread.seconds = 0;
    if (rotations_ < period_) return;
    adapt();
    for (Thread& thread : threads_) thread.least = kForever;
    period_ = std::min(2 * period_, kMaxPeriod);
    rotations_ = 0;
  }

  /// The share of a thread; the sum of all is 1.
  double of(std::size_t thread) const { return threads_[thread].share; }

  /// Does a part of a thread's work, and records how long it takes.
  template <typename Work>
  void time(std::size_t thread, Work&& work) {
    const auto begin = Clock::now();
    work();
    record(thread, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  /// Adds to the time of a thread in this rotation. Threads may call it at the same time.
  void record(std::size_t thread, double seconds) { threads_[thread].seconds += seconds; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kForever = std::numeric_limits<double>::infinity();
  /// Rotations before the shares change, of which each thread's least time counts, as others are disturbed: few at
  /// first, then as many as keep most rotations free of changes, which may take new memory.
  static constexpr std::size_t kFirstPeriod = 4;
  static constexpr std::size_t kMaxPeriod = 16;
  /// The longest time over the mean up to which shares stay.
  static constexpr double kMaxImbalance = 1.05;
  /// The most that a share differs from an equal one, as a factor, before all are made to sum to 1.
  static constexpr double kMaxFactor = 2;

  struct Thread {
    double share = 1;
    double seconds = 0;       ///< in this rotation
    double least = kForever;  ///< of those before
  };

  bool isMeasured() const {
    return std::all_of(threads_.begin(), threads_.end(), [](const Thread& thread) { return thread.seconds > 0; });
  }

  void adapt() {
    const auto count = static_cast<double>(threads_.size());
    double mean = 0;
    double most = 0;
    for (const Thread& thread : threads_) {
      mean += thread.least / count;
      most = std::max(most, thread.least);
    }
    if (most <= kMaxImbalance * mean) return;
    double sum = 0;
    for (Thread& thread : threads_) {
      thread.share = std::clamp(thread.share * mean / thread.least, 1 / (kMaxFactor * count), kMaxFactor / count);
      sum += thread.share;
    }
    for (Thread& thread : threads_) thread.share /= sum;
  }

  std::vector<Thread> threads_;
  std::size_t period_ = kFirstPeriod;
  std::size_t rotations_ = 0;  ///< measured in this period
};

}  // namespace lisco
