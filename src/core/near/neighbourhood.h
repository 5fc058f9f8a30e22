// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

/// Bricks around one, itself included: number (dz + 1) * 9 + (dy + 1) * 3 + (dx + 1).
inline constexpr std::size_t kNearBricks = 27;
inline constexpr std::size_t kOwnBrick = kNearBricks / 2;

/// What is around one of 4 x 4 x 4 places. Bit x + 4 y + 16 z of a word is a place.
/// \tparam kReach by which numbers along an axis differ, at most
template <int kReach>
struct Neighbourhood {
  /// of[place][i]: the places around a place of the own word that are in near word i, numbered as near bricks are.
  std::uint64_t of[64][kNearBricks] = {};

  constexpr Neighbourhood() {
    for (int place = 0; place < 64; ++place)
      for (int dz = -kReach; dz <= kReach; ++dz)
        for (int dy = -kReach; dy <= kReach; ++dy)
          for (int dx = -kReach; dx <= kReach; ++dx) {
            const int x = (place & 3) + dx;
            const int y = (place >> 2 & 3) + dy;
            const int z = (place >> 4) + dz;
            const int word = (z + 4) / 4 * 9 + (y + 4) / 4 * 3 + (x + 4) / 4;
            of[place][word] |= std::uint64_t{1} << ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
          }
  }
};
inline constexpr Neighbourhood<2> kNeighbourhood;       ///< of voxels that may hold neighbours
inline constexpr Neighbourhood<1> kBrickNeighbourhood;  ///< of bricks with such voxels

}  // namespace lisco
