// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/sensor_hints.h"

namespace lisco::ground {

/// Columns whose decisions are made together, laser by laser: cell (laser, column) is element laser * kColumns +
/// column.
struct Block {
  static constexpr std::size_t kColumns = 8;
  static constexpr std::int32_t kNoCell = -1;

  std::vector<float> x, y, z;        ///< as received, metres
  std::vector<float> rho;            ///< horizontal distance from the sensor, metres
  std::vector<float> height;         ///< above the sensor's horizon, metres
  std::vector<std::int32_t> cell;    ///< of the polar grid, see sectorOf and binOf; kNoCell if there is no return
  std::vector<std::uint8_t> ground;  ///< the decisions
  std::size_t size = 0;              ///< number of elements

  static std::size_t sectorOf(std::int32_t cell) { return static_cast<std::size_t>(cell) >> 8; }
  static std::size_t binOf(std::int32_t cell) { return static_cast<std::size_t>(cell) & 255; }

  /// Allocates only if there are more lasers than ever before.
  void resize(std::size_t lasers);

  /// Fills rho, height and cell.
  void measure(const SensorHints& sensor);
};

}  // namespace lisco::ground
