// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "io/clock.h"
#include "io/terminal_line.h"
#include "io/text.h"

namespace lisco_apps {

/// A progress bar with the rate of work and the time that is left, shown at most ten times a second.
class WorkProgress {
 public:
  explicit WorkProgress(bool enabled) : bar_(enabled) {}

  /// \param share of the work that is done, 0 to 1
  /// \param what the current item
  /// \param done items so far
  void show(double share, const std::string& what, std::size_t done) {
    constexpr double kPause = 0.1, kMinTime = 1;  // seconds
    const double now = std::chrono::duration<double>(Clock::now() - start_).count();
    if (done > 0 && now - shown_at_ < kPause) return;
    shown_at_ = now;
    std::string pace;
    if (now > kMinTime && done > 0) pace = formatted("%.1f a second, ", static_cast<double>(done) / now);
    bar_.show(share, pace + timeLeft(now, share) + what);
  }
  void clear() { bar_.clear(); }

 private:
  ProgressBar bar_;
  Clock::time_point start_ = Clock::now();
  double shown_at_ = 0;  ///< seconds since the start
};

}  // namespace lisco_apps
