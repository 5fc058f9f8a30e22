// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>

#include "core/pi.h"

namespace lisco::ground {

inline constexpr std::size_t kSectors = 256;                   ///< of azimuth
inline constexpr float kTurn = static_cast<float>(2.0 * kPi);  ///< radians

/// A unit vector.
struct Direction {
  float x, y;
};

/// The middle of a sector.
Direction directionOf(std::size_t sector);

}  // namespace lisco::ground
