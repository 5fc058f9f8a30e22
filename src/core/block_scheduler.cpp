// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/block_scheduler.h"

namespace lisco {

namespace {

/// Columns over which the work that is left is spread: more make it more even and leave more for the end
/// (benchmarks/suite.sh latency).
constexpr std::size_t kSpreadOver = 128;
/// The same shortly before the end.
constexpr std::size_t kMinSpreadOver = 48;
/// The smallest blocks: smaller ones leave no less for the end.
constexpr std::size_t kMinBlock = 16;

}  // namespace

void BlockScheduler::begin(std::size_t block_columns) {
  block_columns_ = block_columns;
  staged_.clear();
  pending_.clear();
  pending_laser_ = columns_since_block_ = 0;
  columns_expected_ = std::exchange(columns_read_, 0);
  far_budget_.begin();
  near_budget_.begin();
}

/// Half of the columns that are expected after the first `before`; `most` if none is.
std::size_t BlockScheduler::halfOfLeft(std::size_t before, std::size_t least, std::size_t most) const {
  return before < columns_expected_ ? std::clamp((columns_expected_ - before) / 2, least, most) : most;
}

/// Number of columns of the staged block, once it is complete: towards the end of the rotation blocks become smaller,
/// as the last two wait for update ().
std::size_t BlockScheduler::stagedColumns() const {
  return halfOfLeft(columns_read_ + pending_.columns(), std::min(kMinBlock, block_columns_), block_columns_);
}

/// Does the work that is due with some columns that were taken.
void BlockScheduler::workAfter(std::size_t columns, Partition& partition, DisjointSets& subclusters) {
  if (columnsLeft() == 0) {
    finishPending(partition, subclusters);
    std::swap(staged_, pending_);
    columns_since_block_ = 0;
  }
  far_budget_.addColumns(columns);
  if (partition.nearBricksLeft() > 0) near_budget_.addColumns(columns);
  while (partition.farPartsLeft() > 0 && far_budget_.isBehind())
    far_budget_.spend(partition.linkFarPart(subclusters), 1);
  for (std::size_t left = partition.nearBricksLeft(); left > 0 && near_budget_.isBehind();) {
    const std::size_t work = partition.linkNearPart(subclusters);
    near_budget_.spend(work, left - partition.nearBricksLeft());
    left = partition.nearBricksLeft();
  }
  readPending(columns, partition, subclusters);
}

/// Reads the share of the pending block that falls to a number of columns.
void BlockScheduler::readPending(std::size_t columns, Partition& partition, DisjointSets& subclusters) {
  if (pending_.columns() == 0) return;
  partition.addLasers(pending_.lasers());
  const std::size_t until_next = stagedColumns();
  columns_since_block_ = std::min(columns_since_block_ + columns, until_next);
  for (; pending_laser_ < pending_.lasers() * columns_since_block_ / until_next; ++pending_laser_)
    partition.readRing(pending_.ring(pending_laser_), pending_laser_, columns_read_, pending_.columns(), subclusters);
  if (pending_laser_ < pending_.lasers()) return;
  pending_laser_ = 0;
  columns_read_ += static_cast<std::uint32_t>(pending_.columns());
  pending_.clear();
  partition.scheduleFar();
  far_budget_.plan(partition.farPartsLeft(), columnsToSpreadOver());
  near_budget_.plan(partition.nearBricksLeft(), columnsToSpreadOver());
}

/// Towards the end of the rotation the work is spread over fewer columns, so that less is left for update ().
std::size_t BlockScheduler::columnsToSpreadOver() const {
  return halfOfLeft(columns_read_, kMinSpreadOver, kSpreadOver);
}

void BlockScheduler::finish(Partition& partition, DisjointSets& subclusters) {
  finishPending(partition, subclusters);
  if (isStageEmpty()) return;
  std::swap(staged_, pending_);
  columns_since_block_ = 0;
  finishPending(partition, subclusters);
  std::swap(staged_, pending_);  // back, so that the next rotation finds the same memory
}

}  // namespace lisco
