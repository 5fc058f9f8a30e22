// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

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

  /// Takes some columns; there is room for them.
  template <typename CellAt>
  void add(std::size_t first, std::size_t count, std::size_t lasers, CellAt&& cell_at) {
    const auto nothing = [](std::size_t, std::size_t) { return kNoReturn; };
    if (rows_.size() < lasers) rows_.resize(lasers);
    for (; lasers_ < lasers; ++lasers_) fill(rows_[lasers_], 0, lasers_, 0, columns_, nothing);
    for (std::size_t laser = 0; laser < lasers; ++laser) fill(rows_[laser], columns_, laser, first, count, cell_at);
    for (std::size_t laser = lasers; laser < lasers_; ++laser)
      fill(rows_[laser], columns_, laser, first, count, nothing);
    columns_ += count;
  }

  std::size_t lasers() const { return lasers_; }  ///< of the column that has the most
  std::size_t columns() const { return columns_; }
  Row& row(std::size_t laser) { return rows_[laser]; }

  /// Forgets the columns. Keeps its memory.
  void clear() { lasers_ = columns_ = 0; }

 private:
  std::vector<Row> rows_;  ///< by laser
  std::size_t lasers_ = 0;
  std::size_t columns_ = 0;
};

}  // namespace lisco
