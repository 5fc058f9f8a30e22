// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/partition.h"

#include <algorithm>

#include "core/far/constants.h"

namespace lisco {

namespace {

/// Work of a run, and of the segment linker's unit, where reading a cell is 1: fitted to the times of blocks of columns
/// (benchmarks/suite.sh threads).
constexpr std::size_t kWorkOfRun = 3;
constexpr std::size_t kWorkOfLinking = 2;

}  // namespace

void Partition::prepare(const Tolerance& tolerance, const SensorHints& hints, std::size_t columns,
                        std::size_t capacity) {
  if (hints.steps_per_turn != 0) takeBackImageMemory();
  tolerance_ = tolerance;
  runs.clear();
  collects_near_ = false;
  near_returns_.count = 0;
  voxels_.prepare(tolerance);
  image_.prepare(tolerance, hints, columns, capacity);
  segments_.prepare(image_);
}

void Partition::lendImageMemory() noexcept {
  if (is_image_memory_lent_ || !image_.hasLargerMemoryThan(near_returns_.returns)) return;
  image_.exchangeMemory(near_returns_.returns);
  is_image_memory_lent_ = true;
}

void Partition::takeBackImageMemory() noexcept {
  if (is_image_memory_lent_) image_.exchangeMemory(near_returns_.returns);
  is_image_memory_lent_ = false;
}

void Partition::takeCollected(Partition& other, DisjointSets& subclusters) {
  collects_near_ = false;
  NearReturns& collected = other.near_returns_;
  for (std::size_t first = 0; first < collected.count; first += RingBlock::kColumns) {
    const std::size_t count = std::min(RingBlock::kColumns, collected.count - first);
    info_.starts = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const NearReturn& near = collected.returns[first + i];
      block_.x[RingBlock::kMargin + i] = near.x;
      block_.y[RingBlock::kMargin + i] = near.y;
      block_.z[RingBlock::kMargin + i] = near.z;
      info_.run[i] = near.element;
      if (i == 0 || near.element != info_.run[i - 1]) info_.starts |= ColumnBits{1} << i;
    }
    voxels_.add(block_, info_, ~bitsFrom(count), subclusters);
  }
  collected.count = 0;
}

void Partition::readColumns(const CellSource& cells, std::size_t first_cell, std::size_t count, std::size_t lasers,
                            std::uint32_t first_column, DisjointSets& subclusters) {
  addLasers(lasers);
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    block_.read(0, cells, laser, first_cell, count);
    readRing(block_, laser, first_column, count, subclusters);
  }
  segments_.link(image_, subclusters);
}

void Partition::readLasers(const CellSource& cells, std::size_t first, std::size_t end, std::size_t lasers,
                           DisjointSets& subclusters) {
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = first; column < end; column += RingBlock::kColumns) {
      const std::size_t count = std::min(end - column, RingBlock::kColumns);
      block_.read(0, cells, laser, column, count);
      readRing(block_, laser, static_cast<std::uint32_t>(column), count, subclusters);
    }
}

void Partition::addRing(const RingBlock& block, std::size_t laser, std::uint32_t first_column, std::size_t columns,
                        ColumnBits chosen, DisjointSets& subclusters) {
  runs.add(block, info_, laser, first_column, columns, first_element, subclusters);
  ColumnBits unplaced = 0;
  if (info_.far != 0) unplaced = image_.place(block, info_, laser, first_column);
  const ColumnBits near = chosen & (~info_.interior | unplaced);
  if (near == 0) return;
  if (collects_near_)
    near_returns_.add(block, info_.run, near);
  else
    voxels_.add(block, info_, near, subclusters);
}

void Partition::linkWithin(DisjointSets& subclusters) {
  segments_.linkRest(image_, subclusters);
  near_.link(voxels_, subclusters);
}

FarWork Partition::farWork() const {
  const auto far = static_cast<double>(image_.placed + image_.unplaced.size());
  if (far == 0) return {};
  const std::size_t placing = kWorkOfRealigning * image_.realigned + kWorkOfUnplaced * image_.unplaced.size();
  const double runs_per_return = static_cast<double>(runs.run_count) / static_cast<double>(runs.returns);
  const double sorted = std::min(kWorkOfSortedReturn + kWorkOfSortedRun * runs_per_return, kMaxWorkOfSorted);
  return {static_cast<double>(segments_.workDone() + placing), sorted * far};
}

FarWork Partition::expectedFarWork() const {
  FarWork work = farWork();
  const std::size_t begin = std::min(image_.begin, image_.end);
  const std::size_t linked = std::max(image_.linked, begin);
  const std::size_t left = image_.end - std::min(linked, image_.end);
  work.in_image +=
      static_cast<double>(segments_.workDone() * left) / static_cast<double>(std::max<std::size_t>(1, linked - begin));
  return work;
}

std::size_t Partition::workDone() const {
  return kWorkOfLinking * segments_.workDone() + kWorkOfRun * runs.run_count;
}

}  // namespace lisco
