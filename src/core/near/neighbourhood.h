// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

/// Bricks around one, itself included: number (dz + 1) * 9 + (dy + 1) * 3 + (dx + 1).
inline constexpr std::size_t kNearBricks = 27;
inline constexpr std::size_t kOwnBrick = kNearBricks / 2;

/// What is around one of the places in a box of at most 64, each of them a bit of a word: the lowest bits of its number
/// count along x, the next along y, the highest along z.
/// \tparam kReach by which numbers along an axis differ, at most
/// \tparam kX bits of the number along x; kY and kZ likewise. Along an axis of no bits, only the own word has places.
template <int kReach, int kX = 2, int kY = 2, int kZ = 2>
struct Neighbourhood {
  static_assert(kX + kY + kZ <= 6, "a word holds 64 places");
  /// of[place][i]: the places around a place of the own word that are in near word i, numbered as near bricks are.
  std::uint64_t of[64][kNearBricks] = {};

  constexpr Neighbourhood() {
    constexpr int kSize[3] = {1 << kX, 1 << kY, 1 << kZ};
    constexpr int kAlong[3] = {kX == 0 ? 0 : kReach, kY == 0 ? 0 : kReach, kZ == 0 ? 0 : kReach};
    for (int place = 0; place < kSize[0] * kSize[1] * kSize[2]; ++place)
      for (int dz = -kAlong[2]; dz <= kAlong[2]; ++dz)
        for (int dy = -kAlong[1]; dy <= kAlong[1]; ++dy)
          for (int dx = -kAlong[0]; dx <= kAlong[0]; ++dx) {
            // Counted from the word before.
            const int x = place % kSize[0] + dx + kSize[0];
            const int y = place / kSize[0] % kSize[1] + dy + kSize[1];
            const int z = place / kSize[0] / kSize[1] + dz + kSize[2];
            const int word = z / kSize[2] * 9 + y / kSize[1] * 3 + x / kSize[0];
            const int around = x % kSize[0] + kSize[0] * (y % kSize[1] + kSize[1] * (z % kSize[2]));
            of[place][word] |= std::uint64_t{1} << around;
          }
  }
};
inline constexpr Neighbourhood<2> kNeighbourhood;                ///< of voxels that may hold neighbours
inline constexpr Neighbourhood<2, 3, 2, 0> kSliceNeighbourhood;  ///< the same in slices (VoxelNumbering)
inline constexpr Neighbourhood<1> kBrickNeighbourhood;           ///< of bricks with such voxels

}  // namespace lisco
