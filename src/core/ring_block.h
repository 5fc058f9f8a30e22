// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/bits.h"
#include "lisco/return.h"

namespace lisco {

/// What one laser measured in up to 64 consecutive columns; sets of its columns are bits of a machine word.
struct RingBlock {
  static constexpr std::size_t kColumns = 64;
  /// Floats before the first column's and behind the last, where vectors may begin and end.
  static constexpr std::size_t kMargin = 16;
  static constexpr std::size_t kSize = kMargin + kColumns + kMargin;

  float x[kSize], y[kSize], z[kSize];
  std::uint32_t source_index[kColumns + kMargin];

  /// Copies cells of one laser, from the block's column `at` on.
  void read(std::size_t at, const CellSource& cells, std::size_t laser, std::size_t first, std::size_t count) {
    const std::size_t to = kMargin + at;
    cells.read(laser, first, count, {x + to, y + to, z + to, source_index + at});
  }
};

/// What is measured on a ring block, as seen from the sensor.
struct RingBlockInfo {
  std::uint64_t returns;           ///< columns with a return
  std::uint64_t starts;            ///< of these, those that are no neighbour of a return in the column before
  std::uint64_t far;               ///< horizontal distance within [FarRange::min_range, FarRange::max_range)
  std::uint64_t interior;          ///< of these, those whose neighbours are all far
  float lowest, highest;           ///< slope of the far ones; lowest > highest if there are none
  float rho[RingBlock::kColumns];  ///< horizontal distance, metres
  static constexpr std::size_t kFillStep = 16;  ///< elements written at a time, the last ones behind the last column
  std::uint32_t run[RingBlock::kColumns + kFillStep];  ///< element of each return's run; set by Runs::add
};

/// Which returns are far, by their horizontal distance from the sensor, metres.
struct FarRange {
  std::array<float, 3> origin{};  ///< of the sensor
  std::array<float, 2> tilt{};    ///< of its horizon, from which slopes are measured
  float min_range = 0;
  float max_range = 0;     ///< beyond, returns go to the voxels: their squares may overflow
  float interior_min = 0;  ///< from here on all neighbours are at least at min_range
  float interior_max = 0;  ///< up to here all neighbours are below max_range
};

/// The returns of a ring block.
/// \param columns number of columns; those behind count as empty
ColumnBits findReturns(const RingBlock& block, std::size_t columns);

/// Finds the returns of a ring block, and which of them are linked to the one before. None is far; what is known of far
/// ones, and the distances, are left as they are.
/// \param columns as above
void findRuns(const RingBlock& block, std::size_t columns, float squared_tolerance, RingBlockInfo& info);

/// The same, with the distances and the far returns.
void measure(const RingBlock& block, std::size_t columns, float squared_tolerance, const FarRange& range,
             RingBlockInfo& info);

}  // namespace lisco
