// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/block_scheduler.h"

#include <algorithm>
#include <utility>

namespace lisco {

namespace {

/// Columns over which the work that is left is spread: more make it more even and leave more for the end
/// (benchmarks/suite.sh latency).
constexpr std::size_t kSpreadOver = 128;
/// The same shortly before the end.
constexpr std::size_t kMinSpreadOver = 80;
/// The smallest blocks. Smaller ones are read in fewer columns, which take longer, and leave little less for the end.
constexpr std::size_t kMinBlock = 24;
/// Work of putting a near return into its voxel, where reading a cell is 1.
constexpr std::size_t kWorkOfNear = 7;

}  // namespace

void BlockScheduler::begin(std::size_t block_columns) {
  block_columns_ = block_columns;
  staged_.clear();
  pending_.clear();
  pending_laser_ = columns_since_block_ = 0;
  columns_expected_ = std::exchange(columns_read_, 0);
  budget_.begin();
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

/// Does the work that is due with some columns that were taken: reads their share of the pending block, then links
/// until they have taken as long as they should.
void BlockScheduler::workAfter(std::size_t columns, Partition& partition, DisjointSets& subclusters) {
  if (columnsLeft() == 0) {
    finishPending(partition, subclusters);
    std::swap(staged_, pending_);
    columns_since_block_ = 0;
    budget_.plan(Budget::kReading, pending_.lasers(), stagedColumns());
  }
  budget_.addColumns(columns);
  const std::size_t block = pending_.columns();
  const std::size_t near_before = partition.notPlacedCount();
  const std::size_t lasers = readPending(columns, partition, subclusters);
  const std::size_t near_returns = partition.notPlacedCount() - near_before;
  budget_.record(Budget::kReading, lasers, lasers * block + kWorkOfNear * near_returns);
  while (budget_.isBehind()) {
    const bool has_far = partition.farPartsLeft() > 0;
    const std::size_t near = partition.nearBricksLeft();
    if (!has_far && near == 0) return budget_.drop();
    if (has_far && (near == 0 || budget_.isBefore(Budget::kFar, Budget::kNear))) {
      const std::size_t work = partition.linkFarPart(subclusters);
      budget_.record(Budget::kFar, 1, work);
    } else {
      const std::size_t work = partition.linkNearPart(subclusters);
      budget_.record(Budget::kNear, near - partition.nearBricksLeft(), work);
    }
  }
}

/// Reads the share of the pending block that falls to a number of columns. \return number of lasers read
std::size_t BlockScheduler::readPending(std::size_t columns, Partition& partition, DisjointSets& subclusters) {
  if (pending_.columns() == 0) return 0;
  partition.addLasers(pending_.lasers());
  const std::size_t until_next = stagedColumns();
  columns_since_block_ = std::min(columns_since_block_ + columns, until_next);
  const std::size_t first = pending_laser_;
  for (; pending_laser_ < pending_.lasers() * columns_since_block_ / until_next; ++pending_laser_)
    partition.readRing(pending_.ring(pending_laser_), pending_laser_, columns_read_, pending_.columns(), subclusters);
  const std::size_t read = pending_laser_ - first;
  if (pending_laser_ < pending_.lasers()) return read;
  pending_laser_ = 0;
  columns_read_ += static_cast<std::uint32_t>(pending_.columns());
  pending_.clear();
  partition.scheduleFar();
  budget_.plan(Budget::kFar, partition.farPartsLeft(), columnsToSpreadOver());
  budget_.plan(Budget::kNear, partition.nearBricksLeft(), columnsToSpreadOver());
  return read;
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
