// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>

namespace lisco::ground {

inline constexpr std::size_t kSectors = 256;  ///< of azimuth

/// A unit vector.
struct Direction {
  float x, y;
};

/// The middle of a sector.
Direction directionOf(std::size_t sector);

}  // namespace lisco::ground
