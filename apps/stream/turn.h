// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "lisco/return.h"
#include "sensors/decoder.h"

namespace lisco_apps {

/// The columns received of one turn of the sensor.
struct Turn {
  std::uint64_t number = 0;  ///< from 1
  std::size_t lasers = 0;
  std::vector<Cell> cells;            ///< column by column, in each from the top laser to the bottom one
  std::vector<std::uint32_t> labels;  ///< of the cells: cluster id, 0: in none
  double azimuth = 0;                 ///< of its first column, degrees clockwise
  std::int64_t time_us = 0;           ///< of the packet of its last column, microseconds since 1970
  std::uint64_t returns = 0;          ///< above the ground
  std::uint64_t lost = 0;             ///< packets missing in it, or between it and the next one

  std::size_t columns() const { return lasers == 0 ? 0 : cells.size() / lasers; }

  /// Starts an empty turn. Keeps the memory.
  void begin(std::uint64_t new_number, std::size_t new_lasers, double new_azimuth) {
    cells.clear();
    labels.clear();
    *this = {new_number, new_lasers, std::move(cells), std::move(labels), new_azimuth, 0, 0, 0};
  }

  /// Adds a column.
  /// \param ground_z returns below it are not clustered, metres
  /// \param first_index source index of the column's first cell; the others follow
  /// \param to_cluster receives the column without the ground
  void add(const std::vector<Cell>& column, float ground_z, std::uint32_t first_index,
           std::vector<lisco::Return>& to_cluster) {
    cells.insert(cells.end(), column.begin(), column.end());
    labels.resize(cells.size(), 0);
    to_cluster.resize(column.size());
    for (std::size_t i = 0; i < column.size(); ++i) {
      const Cell& cell = column[i];
      const bool is_clustered = lisco::isReturn(cell.x, cell.y, cell.z) && cell.z >= ground_z;
      to_cluster[i] = is_clustered ? lisco::Return{cell.x, cell.y, cell.z, first_index + static_cast<std::uint32_t>(i)}
                                   : lisco::kNoReturn;
      if (is_clustered) ++returns;
    }
  }
};

}  // namespace lisco_apps
