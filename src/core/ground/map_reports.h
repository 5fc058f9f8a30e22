// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned_vector.h"
#include "core/ground/follow_rows.h"
#include "core/ground/ground_map.h"
#include "core/ground/unevenness.h"

namespace lisco::ground {

/// What a block's rows have shown, in their order.
struct Shown {
  FollowSetting setting;
  FollowResult result;
  float start_height;               ///< of the ground beneath the sensor, metres
  bool turns_left;                  ///< sense of rotation
  const std::int32_t* with_ground;  ///< positions of the rows with ground, even if all was dropped as scattered
  std::size_t with_ground_count;
};

/// Writes a block's ground into the map. Arrays may be longer than their content. Distances and heights are metres.
/// Flags are words, since stores of bytes may alias any array.
struct MapReports {
  /// Ground found from one distance to another.
  struct Stretches {
    AlignedVector<float> from_rho, from_height, rho, height;
    AlignedVector<float> slope_before;        ///< of the ground further inwards; kNoSlope: none
    AlignedVector<float> long_slope;          ///< of the ground up to rho, over a longer way
    AlignedVector<float> slope, offset, ray;  ///< of the line that is entered, and of the ray to its end
    AlignedVector<std::int32_t> first, last;  ///< bins; last is -1 for a stretch that is not entered
    std::vector<std::uint32_t> sector;        ///< of the map
    std::vector<std::uint32_t> is_doubted;    ///< 1 if it is off the ground of the blocks before, else 0
    std::vector<std::uint32_t> is_last;       ///< element s + 1: 1 if stretch s is the outermost, else 0
  };
  Stretches stretches;
  Unevenness unevenness;           ///< of the ground in all blocks entered
  std::uint32_t block_number = 0;  ///< blocks entered since begin ()
  /// By position in the order, of rows that have reached ground: 1 + the outermost stretch up to there, or 0.
  std::vector<std::uint32_t> latest;

  /// Allocates only if there are more lasers than ever before.
  void begin(std::size_t lasers);
  /// Erases the map's ground above the rays of some rows; enters what the latest column of each row has shown; then,
  /// beyond the last ground, that it is expected to go on.
  void enter(const Shown& shown, GroundMap::Sector* sectors);
};

}  // namespace lisco::ground
