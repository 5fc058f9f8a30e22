// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <atomic>
#include <thread>

namespace lisco {

/// Whether the far returns of a rotation are worth range images: one thread decides it, by the first columns; the
/// others read theirs as if they were, until they learn that they are not.
class FarTrial {
 public:
  /// The first call counts.
  void decide(bool is_worthwhile) {
    Verdict open = Verdict::kOpen;
    verdict_.compare_exchange_strong(open, is_worthwhile ? Verdict::kWorthwhile : Verdict::kRefused);
  }

  bool isRefused() const { return verdict_.load(std::memory_order_relaxed) == Verdict::kRefused; }

  /// Waits until it is decided. \return whether far returns are worthwhile
  bool await() const {
    while (verdict_.load(std::memory_order_relaxed) == Verdict::kOpen) std::this_thread::yield();
    return !isRefused();
  }

 private:
  enum class Verdict { kOpen, kWorthwhile, kRefused };
  std::atomic<Verdict> verdict_{Verdict::kOpen};
};

}  // namespace lisco
