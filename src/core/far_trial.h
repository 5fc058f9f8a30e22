// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <atomic>
#include <thread>

namespace lisco {

/// Shared decision whether the far returns of a rotation are worth range images. The first part decides it by its first
/// columns; the others are read with range images meanwhile, and again without if it refuses them.
class FarTrial {
 public:
  /// Later calls have no effect.
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
