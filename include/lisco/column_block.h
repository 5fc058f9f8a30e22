// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "lisco/return.h"
#include "lisco/row.h"

namespace lisco {

/// Columns that wait until there are enough of them to be read row by row.
class ColumnBlock {
 public:
  /// Copies cells of one laser into a row.
  /// \param cell_at callable as Return (std::size_t laser, std::size_t column)
  template <typename CellAt>
  static void fill(Row& row, std::size_t at, std::size_t laser, std::size_t first, std::size_t count,
                   CellAt&& cell_at) {
    float* const x = row.x + Row::kMargin + at;
    float* const y = row.y + Row::kMargin + at;
    float* const z = row.z + Row::kMargin + at;
    std::uint32_t* const source_index = row.source_index + at;
    for (std::size_t i = 0; i < count; ++i) {
      const Return cell = cell_at(laser, first + i);
      x[i] = cell.x;
      y[i] = cell.y;
      z[i] = cell.z;
      source_index[i] = cell.source_index;
    }
  }

  /// Makes room for so many lasers; those that were not there before have no returns in the columns that wait.
  void addLasers(std::size_t lasers) {
    while (rows_.size() < lasers) {
      rows_.emplace_back();
      std::fill_n(rows_.back().x, Row::kMargin + Row::kColumns, kNoReturn.x);
      std::fill_n(rows_.back().y, Row::kMargin + Row::kColumns, kNoReturn.y);
      std::fill_n(rows_.back().z, Row::kMargin + Row::kColumns, kNoReturn.z);
    }
  }

  /// Takes some columns; there is room for them.
  template <typename CellAt>
  void add(std::size_t first, std::size_t count, std::size_t lasers, CellAt&& cell_at) {
    addLasers(lasers);
    for (std::size_t laser = 0; laser < lasers; ++laser) fill(rows_[laser], columns_, laser, first, count, cell_at);
    for (std::size_t laser = lasers; laser < rows_.size(); ++laser)
      fill(rows_[laser], columns_, laser, first, count, [](std::size_t, std::size_t) { return kNoReturn; });
    columns_ += count;
  }

  std::size_t lasers() const { return rows_.size(); }
  std::size_t columns() const { return columns_; }
  Row& row(std::size_t laser) { return rows_[laser]; }

  /// Forgets the columns. Keeps its memory.
  void clear() { columns_ = 0; }

 private:
  std::vector<Row> rows_;  ///< by laser
  std::size_t columns_ = 0;
};

}  // namespace lisco
