// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

/// Bricks around one, itself included: number (dz + 1) * 9 + (dy + 1) * 3 + (dx + 1).
inline constexpr std::size_t kNearBricks = 27;
inline constexpr std::size_t kOwnBrick = kNearBricks / 2;

/// The voxels around one. Bit x + 4 y + 16 z of a word is a voxel of a brick.
struct Neighbourhood {
  /// of[voxel][i]: the voxels of near brick i whose numbers differ by 2 at most from those of a voxel of the own brick.
  std::uint64_t of[64][kNearBricks] = {};

  constexpr Neighbourhood() {
    for (int voxel = 0; voxel < 64; ++voxel)
      for (int dz = -2; dz <= 2; ++dz)
        for (int dy = -2; dy <= 2; ++dy)
          for (int dx = -2; dx <= 2; ++dx) {
            const int x = (voxel & 3) + dx;
            const int y = (voxel >> 2 & 3) + dy;
            const int z = (voxel >> 4) + dz;
            const int brick = (z + 4) / 4 * 9 + (y + 4) / 4 * 3 + (x + 4) / 4;
            of[voxel][brick] |= std::uint64_t{1} << ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
          }
  }
};
inline constexpr Neighbourhood kNeighbourhood;

}  // namespace lisco
