// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <vector>

#include "core/ring_block.h"
#include "lisco/return.h"

namespace lisco {

/// Columns that are gathered until they are read laser by laser.
class ColumnBlock {
 public:
  /// Appends columns, of which the block holds RingBlock::kColumns.
  void add(const CellSource& cells, std::size_t first, std::size_t count, std::size_t lasers) {
    const auto nothing = [](std::size_t, std::size_t) { return kNoReturn; };
    const CellSource empty(nothing);
    if (rings_.size() < lasers) rings_.resize(lasers);
    for (; lasers_ < lasers; ++lasers_) rings_[lasers_].read(0, empty, lasers_, 0, columns_);
    for (std::size_t laser = 0; laser < lasers; ++laser) rings_[laser].read(columns_, cells, laser, first, count);
    for (std::size_t laser = lasers; laser < lasers_; ++laser) rings_[laser].read(columns_, empty, laser, 0, count);
    columns_ += count;
  }
  /// Appends a column.
  void add(const Return* cells, std::size_t lasers) {
    const auto cell_at = [cells](std::size_t laser, std::size_t) { return cells[laser]; };
    add(CellSource(cell_at), 0, 1, lasers);
  }

  std::size_t lasers() const { return lasers_; }  ///< of the column that has the most
  std::size_t columns() const { return columns_; }
  RingBlock& ring(std::size_t laser) { return rings_[laser]; }

  /// Forgets the columns. Keeps its memory.
  void clear() { lasers_ = columns_ = 0; }

 private:
  std::vector<RingBlock> rings_;  ///< by laser
  std::size_t lasers_ = 0;
  std::size_t columns_ = 0;
};

}  // namespace lisco
