// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/ring_block.h"
#include "lisco/return.h"

namespace lisco {

/// Columns that are gathered as they come, cell beside cell, until they are read laser by laser.
class ColumnBlock {
 public:
  /// Appends a column; the block holds RingBlock::kColumns.
  void add(const Return* cells, std::size_t lasers) { std::copy_n(cells, lasers, addColumns(1, lasers)); }
  /// Appends several columns.
  void add(const CellSource& cells, std::size_t first, std::size_t count, std::size_t lasers) {
    Return* const columns = addColumns(count, lasers);
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      ring_.read(0, cells, laser, first, count);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = RingBlock::kMargin + i;
        columns[i * stride_ + laser] = {ring_.x[at], ring_.y[at], ring_.z[at], ring_.source_index[i]};
      }
    }
  }

  std::size_t lasers() const { return lasers_; }  ///< of the column that has the most
  std::size_t columns() const { return columns_; }

  /// What a laser measured, until the next call of another function.
  RingBlock& ring(std::size_t laser) {
    const Return* cell = &cells_[laser];
    for (std::size_t i = 0; i < columns_; ++i, cell += stride_) {
      ring_.x[RingBlock::kMargin + i] = cell->x;
      ring_.y[RingBlock::kMargin + i] = cell->y;
      ring_.z[RingBlock::kMargin + i] = cell->z;
      ring_.source_index[i] = cell->source_index;
    }
    return ring_;
  }

  /// Forgets the columns. Keeps its memory.
  void clear() { lasers_ = columns_ = 0; }

 private:
  /// Cells from one column to the next: an odd number of cache lines, so that those of one laser spread over the cache.
  static std::size_t strideFor(std::size_t lasers) {
    constexpr std::size_t kLine = 64 / sizeof(Return);
    return ((lasers + kLine - 1) / kLine | 1U) * kLine;
  }

  /// \return the first of some new columns: the cells of their lasers, without values, and behind them no returns
  Return* addColumns(std::size_t count, std::size_t lasers) {
    if (lasers > stride_) widen(strideFor(lasers));
    for (; lasers_ < lasers; ++lasers_)
      for (std::size_t column = 0; column < columns_; ++column) cells_[column * stride_ + lasers_] = kNoReturn;
    Return* const first = cells_.data() + columns_ * stride_;
    for (std::size_t i = 0; i < count; ++i)
      std::fill(first + i * stride_ + lasers, first + i * stride_ + lasers_, kNoReturn);
    columns_ += count;
    return first;
  }

  void widen(std::size_t stride) {
    std::vector<Return> wider(RingBlock::kColumns * stride);
    for (std::size_t column = 0; column < columns_; ++column)
      std::copy_n(cells_.begin() + static_cast<std::ptrdiff_t>(column * stride_), lasers_,
                  wider.begin() + static_cast<std::ptrdiff_t>(column * stride));
    cells_.swap(wider);
    stride_ = stride;
  }

  std::vector<Return> cells_;  ///< column by column
  std::size_t stride_ = 0;     ///< cells from a column to the next
  std::size_t lasers_ = 0;
  std::size_t columns_ = 0;
  RingBlock ring_{};
};

}  // namespace lisco
