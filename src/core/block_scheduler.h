// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/column_block.h"
#include "core/column_budget.h"
#include "core/partition.h"

namespace lisco {

/// Columns that come one by one, read into a partition: gathers them into blocks, reads a block while the next one is
/// gathered, and links it in small parts while those after it come.
class BlockScheduler {
 public:
  void begin(std::size_t block_columns);

  /// Whether columns were taken or skipped since begin ().
  bool hasColumns() const { return columns_read_ > 0 || !isStageEmpty() || pending_.columns() > 0; }

  /// Number of columns until the block is complete.
  std::size_t columnsLeft() const { return stagedColumns() - staged_.columns(); }
  bool isStageEmpty() const { return staged_.columns() == 0; }

  /// Takes at most columnsLeft () columns, and does the work that is due.
  void add(const CellSource& cells, std::size_t first, std::size_t count, std::size_t lasers, Partition& partition,
           DisjointSets& subclusters) {
    staged_.add(cells, first, count, lasers);
    workAfter(count, partition, subclusters);
  }
  /// The same for one column.
  void add(const Return* column, std::size_t lasers, Partition& partition, DisjointSets& subclusters) {
    staged_.add(column, lasers);
    workAfter(1, partition, subclusters);
  }

  /// Reads the block that is pending.
  void finishPending(Partition& partition, DisjointSets& subclusters) {
    readPending(block_columns_, partition, subclusters);
  }
  /// Reads all columns taken.
  void finish(Partition& partition, DisjointSets& subclusters);

  /// Counts columns that were read without the scheduler.
  void skipColumns(std::size_t columns) { columns_read_ += static_cast<std::uint32_t>(columns); }
  /// Number of columns read or skipped.
  std::uint32_t columnsRead() const { return columns_read_; }

 private:
  std::size_t halfOfLeft(std::size_t before, std::size_t least, std::size_t most) const;
  std::size_t stagedColumns() const;
  void workAfter(std::size_t columns, Partition& partition, DisjointSets& subclusters);
  std::size_t readPending(std::size_t columns, Partition& partition, DisjointSets& subclusters);
  std::size_t columnsToSpreadOver() const;

  std::size_t block_columns_ = RingBlock::kColumns;  ///< of the largest blocks
  ColumnBlock staged_;                               ///< an incomplete block
  ColumnBlock pending_;                              ///< a complete block, read while the next one is staged
  std::size_t pending_laser_ = 0;                    ///< the next to be read
  std::size_t columns_since_block_ = 0;
  std::uint32_t columns_read_ = 0;
  std::uint32_t columns_expected_ = 0;  ///< as many as the rotation before had
  using Budget = ColumnBudget<>;
  Budget budget_;
};

}  // namespace lisco
