// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/block_scheduler.h"

namespace lisco {

void BlockScheduler::begin(std::size_t block_columns) {
  block_columns_ = block_columns;
  staged_.clear();
  pending_.clear();
  pending_laser_ = columns_since_block_ = 0;
  columns_read_ = 0;
  budget_.begin();
}

void BlockScheduler::add(const CellSource& cells, std::size_t first, std::size_t count, std::size_t lasers,
                         Partition& partition, DisjointSets& subclusters) {
  staged_.add(cells, first, count, lasers);
  if (columnsLeft() == 0) {
    finishPending(partition, subclusters);
    std::swap(staged_, pending_);
    columns_since_block_ = 0;
  }
  budget_.addColumns(count);
  while (partition.farPartsLeft() > 0 && budget_.isBehind()) budget_.spend(partition.linkFarPart(subclusters));
  readPending(count, partition, subclusters);
}

/// Reads the share of the pending block that falls to a number of columns.
void BlockScheduler::readPending(std::size_t columns, Partition& partition, DisjointSets& subclusters) {
  if (pending_.columns() == 0) return;
  partition.addLasers(pending_.lasers());
  columns_since_block_ = std::min(columns_since_block_ + columns, block_columns_);
  for (; pending_laser_ < pending_.lasers() * columns_since_block_ / block_columns_; ++pending_laser_)
    partition.readRing(pending_.ring(pending_laser_), pending_laser_, columns_read_, pending_.columns(), subclusters);
  if (pending_laser_ < pending_.lasers()) return;
  pending_laser_ = 0;
  columns_read_ += static_cast<std::uint32_t>(pending_.columns());
  pending_.clear();
  partition.scheduleFar();
  budget_.plan(partition.farPartsLeft());
}

void BlockScheduler::finish(Partition& partition, DisjointSets& subclusters) {
  finishPending(partition, subclusters);
  if (isEmpty()) return;
  std::swap(staged_, pending_);
  columns_since_block_ = 0;
  finishPending(partition, subclusters);
  std::swap(staged_, pending_);  // back, so that the next rotation finds the same memory
}

}  // namespace lisco
