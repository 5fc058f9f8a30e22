// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace lisco::ground {

// Bins of horizontal distance: eight of equal width in each octave of the squared distance, each 3 to 6 % of its
// distance wide. Bin 0 begins at 0.5 m; nearer returns belong to it. A bin's number is the exponent and the three
// highest bits of the mantissa of the squared distance, less those of 0.25 m2.
inline constexpr std::int32_t kFirstDistanceBin = (127 - 2) << 3;
inline constexpr int kDistanceBinShift = 20;

/// Bin of a distance, metres; what is farther than the last of `bins` belongs to that.
inline std::int32_t distanceBin(float rho, std::int32_t bins) {
  const float squared = rho * rho;
  std::int32_t bits;
  std::memcpy(&bits, &squared, sizeof bits);
  return std::clamp((bits >> kDistanceBinShift) - kFirstDistanceBin, 0, bins - 1);
}

/// Where a bin begins, metres, squared.
inline float squaredDistanceOf(std::int32_t bin) {
  const std::int32_t bits = (bin + kFirstDistanceBin) << kDistanceBinShift;
  float squared;
  std::memcpy(&squared, &bits, sizeof squared);
  return squared;
}

}  // namespace lisco::ground
