// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned_vector.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco::ground {

/// Returns as received, laser by laser: cell (laser, column) is element laser * stride + column.
struct Columns {
  AlignedVector<float> x, y, z;  ///< metres
  std::size_t stride = 0;

  /// Allocates only if there are more cells than ever before.
  void resize(std::size_t lasers, std::size_t columns);
  void set(std::size_t laser, std::size_t column, const Return& cell) {
    const std::size_t i = laser * stride + column;
    x[i] = cell.x;
    y[i] = cell.y;
    z[i] = cell.z;
  }
  /// Makes the cells of a column no returns.
  void clear(std::size_t column, std::size_t lasers);
};

/// Columns whose decisions are made together, measured in the sensor's frame: cell (laser, column) is element
/// laser * kColumns + column.
struct Block {
  static constexpr std::size_t kColumns = 8;
  static constexpr float kMinRho = 0.05F;  ///< metres; nearer returns are not looked at

  AlignedVector<float> rho;           ///< horizontal distance from the sensor, metres; 0: no return
  AlignedVector<float> height;        ///< above the sensor's horizon, metres
  std::vector<std::uint8_t> returns;  ///< of each laser, the columns with rho > kMinRho, as bits
  std::size_t size = 0;               ///< number of elements, without those of noRow ()

  /// By laser, x, y, rho and height of the last of its returns; arrays are longer than there are lasers by up to
  /// kColumns - 1. If there is none, rho is not above kMinRho.
  AlignedVector<float> last_x, last_y, last_rho, last_height;
  std::vector<std::uint32_t> last;  ///< by laser, the column of that return; 0 if there is none

  /// A row without returns, beyond the lasers.
  std::size_t noRow() const { return size / kColumns; }

  /// Allocates only if there are more lasers than ever before.
  void resize(std::size_t lasers);

  /// Measures kColumns columns from the first one on.
  void measure(const Columns& columns, std::size_t first, const SensorHints& sensor);
};

}  // namespace lisco::ground
