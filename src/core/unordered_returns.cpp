// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/unordered_returns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/near/constants.h"

namespace lisco {

namespace {

/// Shares of returns that begin a run, and that begin a fragment: a run or its part in another voxel. Above either,
/// runs take more time than they save; lower ones slow down dense clouds in order, higher ones sparse clouds
/// (benchmarks/suite.sh recordings).
constexpr double kManyRuns = 0.36;
constexpr double kManyFragments = 0.9;
/// Pairs of adjacent cells that are sampled, at most.
constexpr std::size_t kSampledPairs = 256;

}  // namespace

bool UnorderedReturns::isUnordered(std::size_t columns, std::size_t lasers, const CellSource& cells,
                                   const Tolerance& tolerance) {
  if (!tolerance.joinsAnything()) return false;
  // Odd, so that not always the same laser is met where the columns are firings.
  const std::size_t step = std::max<std::size_t>(1, columns * lasers / kSampledPairs) | 1;
  std::size_t returns = 0;
  std::size_t runs = 0;
  double fragments = 0;
  for (std::size_t cell = step / 2; cell < columns * lasers; cell += step) {
    const std::size_t laser = cell / columns;
    const std::size_t column = cell % columns;
    if (column == 0) continue;
    const Return here = cells.at(laser, column);
    if (!isReturn(here.x, here.y, here.z)) continue;
    ++returns;
    const Return before = cells.at(laser, column - 1);
    const float dx = std::fabs(here.x - before.x);
    const float dy = std::fabs(here.y - before.y);
    const float dz = std::fabs(here.z - before.z);
    const bool goes_on = isReturn(before.x, before.y, before.z) && squaredDistance(dx, dy, dz) < tolerance.squared();
    runs += goes_on ? 0 : 1;
    // About the probability of a voxel's border in between.
    const double border = static_cast<double>(dx + dy + dz) / (kVoxelSide * tolerance.reach());
    fragments += goes_on ? std::min(1.0, border) : 1.0;
  }
  const auto all = static_cast<double>(returns);
  return static_cast<double>(runs) > kManyRuns * all || fragments > kManyFragments * all;
}

void UnorderedReturns::begin(std::size_t parts) {
  if (parts_.size() < parts) parts_.resize(parts);
  part_count_ = parts;
  for (Part& part : parts_) {
    part.near.count = 0;
    part.blocks.clear();
  }
  numbered_.clear();
  is_sorted_ = false;
}

void UnorderedReturns::readPart(std::size_t number, const CellSource& cells, std::size_t first, std::size_t end,
                                std::size_t lasers) {
  Part& part = parts_[number];
  const std::size_t most = (end - first) * lasers + RingBlock::kColumns + kReadBehind;
  part.near.returns.grow(most);
  RingBlock block;
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = first; column < end; column += RingBlock::kColumns) {
      const std::size_t columns = std::min(end - column, RingBlock::kColumns);
      block.read(0, cells, laser, column, columns);
      const std::size_t count = part.near.count;
      const ColumnBits returns = findReturns(block, columns);
      if (returns == 0) continue;
      part.near.add(block, block.source_index, returns);
      reserveInSteps(part.blocks, part.blocks.size() + 1);
      part.blocks.push_back({static_cast<std::uint32_t>(laser), static_cast<std::uint32_t>(column),
                             static_cast<std::uint32_t>(count), returns});
    }
}

bool UnorderedReturns::link(VoxelSorter& sorter, const Tolerance& tolerance, std::vector<std::uint32_t>& sizes) {
  numbered_.clear();
  for (std::size_t i = 0; i < part_count_; ++i) numbered_.push_back({&parts_[i].near, 0});
  return sorter.number(numbered_, tolerance, sizes);
}

std::size_t UnorderedReturns::count() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < part_count_; ++i) count += parts_[i].near.count;
  return count;
}

void UnorderedReturns::sortBlocks() {
  if (is_sorted_) return;
  order_.sort(part_count_, [this](std::size_t i) -> const Part& { return parts_[i]; });
  is_sorted_ = true;
}

void UnorderedReturns::visit(const VoxelSorter& sorter, const RunVisitor& visit, bool from_both_ends) {
  if (numbered_.size() != part_count_) return;
  sortBlocks();
  const auto partAt = [this](std::size_t i) -> const Part& { return parts_[i]; };
  const auto visitBlock = [&](RunVisitor::From from, std::size_t number, const Part& part, const Block& block) {
    const NearReturn* const returns = part.near.returns.data() + block.first_return;
    const std::size_t first = numbered_[number].first + block.first_return;
    const std::uint32_t count = countBits(block.returns);
    std::uint32_t sets[RingBlock::kColumns];
    for (std::size_t i = 0; i < count; ++i) sets[i] = sorter.setOf(first + i);
    std::uint32_t columns[RingBlock::kColumns];
    std::uint32_t source_indices[RingBlock::kColumns];
    if (visit.takesPlaces()) {
      std::size_t i = 0;
      forEachBit(block.returns,
                 [&](std::size_t column) { columns[i++] = block.first_column + static_cast<std::uint32_t>(column); });
    } else {
      for (std::size_t i = 0; i < count; ++i) source_indices[i] = returns[i].element;
    }
    visit(from, SingleRunBlock{sets, count, block.laser, columns, source_indices});
  };
  order_.forEachBlock(from_both_ends, partAt, visitBlock);
}

std::uint32_t UnorderedReturns::setAt(const VoxelSorter& sorter, std::size_t laser, std::size_t column) {
  if (numbered_.size() != part_count_) return kNone;
  sortBlocks();
  LaserOrder::Entry entry{};
  if (!order_.find(
          laser, column, [this](std::size_t i) -> const Part& { return parts_[i]; }, entry))
    return kNone;
  const Part& part = parts_[entry.partition];
  const Block& block = part.blocks[entry.block];
  const std::size_t offset = column - block.first_column;
  if ((block.returns >> offset & 1) == 0) return kNone;
  return sorter.setOf(numbered_[entry.partition].first + block.first_return +
                      countBits(block.returns & ~bitsFrom(offset)));
}

void UnorderedReturns::moveTo(Partition& partition, DisjointSets& subclusters) {
  RingBlock ring{};
  for (std::size_t i = 0; i < part_count_; ++i)
    for (const Block& block : parts_[i].blocks) {
      std::fill(ring.x, ring.x + RingBlock::kSize, std::numeric_limits<float>::quiet_NaN());
      std::size_t number = block.first_return;
      forEachBit(block.returns, [&](std::size_t column) {
        const NearReturn& near = parts_[i].near.returns[number];
        ring.x[RingBlock::kMargin + column] = near.x;
        ring.y[RingBlock::kMargin + column] = near.y;
        ring.z[RingBlock::kMargin + column] = near.z;
        ring.source_index[column] = near.element;
        ++number;
      });
      const auto columns = static_cast<std::size_t>(64 - __builtin_clzll(block.returns));
      partition.readRing(ring, block.laser, block.first_column, columns, subclusters);
    }
  begin(0);
}

}  // namespace lisco
