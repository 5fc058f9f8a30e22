// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/direction.h"

#include <array>
#include <cmath>

#include "core/pi.h"

namespace lisco::ground {

Direction directionOf(std::size_t sector) {
  static const auto directions = [] {
    std::array<Direction, kSectors> all;
    for (std::size_t i = 0; i < kSectors; ++i) {
      const double azimuth = 2.0 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(kSectors);
      all[i] = {static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth))};
    }
    return all;
  }();
  return directions[sector];
}

}  // namespace lisco::ground
