// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "io/clock.h"

namespace lisco_apps {

/// A histogram of durations in fixed memory: percentiles are accurate to 2%, from a nanosecond to hours.
class Latency {
 public:
  void add(Clock::duration time) {
    const double ns = std::max(1., std::chrono::duration<double, std::nano>(time).count());
    const double bin = kBinsPerOctave * std::log2(ns);
    ++bins_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
    ++count_;
    max_ms_ = std::max(max_ms_, ns * kMsPerNs);
  }

  std::uint64_t count() const { return count_; }
  double maxMs() const { return max_ms_; }

  /// \param share of the durations, 0 to 1
  /// \return the duration, in milliseconds, that this share does not exceed; 0 if there are none
  double percentileMs(double share) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t up_to = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      up_to += bins_[bin];
      if (up_to == 0 || up_to < wanted) continue;
      return std::min(max_ms_, std::exp2((static_cast<double>(bin) + 1) / kBinsPerOctave) * kMsPerNs);
    }
    return 0;
  }

 private:
  static constexpr double kMsPerNs = 1e-6;
  static constexpr double kBinsPerOctave = 36;
  static constexpr std::size_t kBins = 36 * 45;  ///< 45 octaves of nanoseconds are 9.8 hours
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double max_ms_ = 0;
};

}  // namespace lisco_apps
