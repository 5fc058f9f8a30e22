// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lisco/export.h"

namespace lisco {

/// What one laser measured in up to 64 columns that follow each other: one bit of a machine word for each.
struct Row {
  static constexpr std::size_t kColumns = 64;
  static constexpr std::size_t kMargin = 16;  ///< floats before the first column's, so that vectors may begin there

  float x[kMargin + kColumns], y[kMargin + kColumns], z[kMargin + kColumns];
  std::uint32_t source_index[kColumns];
};

/// What a row looks like from the sensor.
struct MeasuredRow {
  std::uint64_t returns;             ///< columns with a return
  std::uint64_t starts;              ///< of these, those that are no neighbour of a return in the column before
  std::uint64_t far;                 ///< horizontal distance within [FarRange::near_end, FarRange::far_end)
  std::uint64_t only_far;            ///< all neighbours are far, too
  float lowest, highest;             ///< slope (z / rho) of the far ones; lowest > highest if there are none
  float rho[Row::kColumns];          ///< horizontal distance, metres
  std::uint32_t run[Row::kColumns];  ///< the run of each return; filled by the engine
};

/// Which returns are far, by their horizontal distance from the sensor, metres.
struct FarRange {
  std::array<float, 3> origin{};  ///< the sensor
  float near_end = 0;
  float far_end = 0;
  float far_enough = 0;  ///< from here on all neighbours are at least at near_end
  float not_too_far = 0;
};

/// Finds the returns of a row, their links and their distances. Cells that are no returns get NaN for x.
/// \param columns number of columns; those behind are taken for empty
LISCO_EXPORT void measureRow(Row& row, std::size_t columns, float squared_tolerance, const FarRange& range,
                             MeasuredRow& measured);

}  // namespace lisco
