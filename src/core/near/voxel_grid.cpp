// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_grid.h"

#include <algorithm>
#include <cmath>

#include "core/near/constants.h"
#include "core/near/kernels.h"

namespace lisco {

namespace {

constexpr std::size_t kMinSlots = 256;  // of the hash table: 2 KiB

}  // namespace

std::size_t VoxelGrid::SparseList::add(std::uint32_t place, std::uint32_t value, std::vector<std::uint32_t>& lists) {
  const std::uint32_t count = countBits(used);
  if (count == capacity) {
    const auto moved = static_cast<std::uint32_t>(lists.size());
    capacity = std::max<std::uint32_t>(4, 2 * capacity);
    lists.resize(lists.size() + capacity);
    std::copy_n(lists.begin() + begin, count, lists.begin() + moved);
    begin = moved;
  }
  const std::size_t index = indexOf(place);
  used |= std::uint64_t{1} << place;
  std::copy_backward(lists.begin() + static_cast<std::ptrdiff_t>(index), lists.begin() + begin + count,
                     lists.begin() + begin + count + 1);
  lists[index] = value;
  return index;
}

void VoxelGrid::prepare(const Tolerance& new_tolerance) {
  tolerance = new_tolerance;
  voxels_per_metre_ = 1.0 / (kVoxelSide * std::max(tolerance.reach(), 1e-22));
  in_float_range_ = voxels_per_metre_ > 1e-30 && voxels_per_metre_ < 1e30;
  if (slots_.size() < kMinSlots) slots_.assign(kMinSlots, Slot());
  all_in_float_range = true;
  points_ = 0;
  if (fragments.empty()) return;  // nothing was added
  fragments.clear();
  cliques.clear();
  bricks.clear();
  groups_.clear();
  group_bricks_.clear();
  first_cliques.clear();
  new_bricks.clear();
  linked_bricks = 0;
  filter.clear();
  std::fill(recent_cliques_.begin(), recent_cliques_.end(), RecentClique());
  std::fill(slots_.begin(), slots_.end(), Slot());
}

void VoxelGrid::add(const RingBlock& block, const RingBlockInfo& info, ColumnBits which, DisjointSets& subclusters) {
  if (!tolerance.joinsAnything()) return;
  if (recent_cliques_.empty()) recent_cliques_.resize(kRecentCliques);
  const float* const block_x = block.x + RingBlock::kMargin;
  const float* const block_y = block.y + RingBlock::kMargin;
  const float* const block_z = block.z + RingBlock::kMargin;
  VoxelNumbers numbers;
  ColumnBits changes = 0;
  if (!in_float_range_ || !numberVoxels(block, which, static_cast<float>(voxels_per_metre_), numbers, changes)) {
    forEachBit(which, [&](std::size_t i) {
      const float point[3] = {block_x[i], block_y[i], block_z[i]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double number =
            std::clamp(static_cast<double>(point[axis]) * voxels_per_metre_, -kMaxDoubleNumber, kMaxDoubleNumber);
        numbers.of[axis][1 + i] = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(number)));
      }
    });
    changes = ~ColumnBits{0};
    all_in_float_range = false;
  }
  // A fragment goes on where the return before is in the same run and voxel.
  const ColumnBits starts = which & ~(which << 1 & ~info.starts & ~changes);
  std::size_t point = newPoints(countBits(which));
  forEachChain(starts, which, [&](std::size_t begin, std::size_t end) {
    const auto fragment = static_cast<std::uint32_t>(fragments.size());
    fragments.push_back({static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(end - begin), kNone});
    Box box = Box::around(block_x[begin], block_y[begin], block_z[begin]);
    for (std::size_t i = begin; i < end; ++i, ++point) {
      x[point] = block_x[i];
      y[point] = block_y[i];
      z[point] = block_z[i];
      box.add(Box::around(block_x[i], block_y[i], block_z[i]));
    }
    addFragment({numbers.of[0][1 + begin], numbers.of[1][1 + begin], numbers.of[2][1 + begin]}, box, fragment,
                info.run[begin], subclusters);
  });
}

/// Adds a number of points, with undefined coordinates. \return the first of them
std::size_t VoxelGrid::newPoints(std::size_t count) {
  const std::size_t first = points_;
  points_ += count;
  for (auto* coordinate : {&x, &y, &z}) coordinate->growInSteps(points_ + kReadBehind);
  return first;
}

void VoxelGrid::addFragment(const Key& voxel, const Box& box, std::uint32_t fragment, std::uint32_t element,
                            DisjointSets& subclusters) {
  // Most fragments lie in a voxel that was used recently.
  RecentClique& recent = recent_cliques_[hashOf(voxel) % kRecentCliques];
  if (recent.clique != kNone && areEqual(recent.voxel, voxel)) {
    Clique& clique = cliques[recent.clique];
    if (clique.state == State::kNew && Box::squaredSpan(clique.box, box) < tolerance.squared()) {
      addTo(clique, box, fragment, element, subclusters);
      return;
    }
  }
  const std::uint32_t brick_number = makeBrick(containerOf(voxel));
  Brick& brick = bricks[brick_number];
  if (!brick.is_new) {
    brick.is_new = true;
    new_bricks.push_back(brick_number);
  }
  std::uint32_t& first = firstClique(brick, placeOf(voxel));
  for (std::uint32_t i = first; i != kNone; i = cliques[i].next_in_voxel) {
    Clique& clique = cliques[i];
    if (!(Box::squaredSpan(clique.box, box) < tolerance.squared())) continue;
    addTo(clique, box, fragment, element, subclusters);
    recent = {voxel, i};
    return;
  }
  const auto number = static_cast<std::uint32_t>(cliques.size());
  cliques.push_back({box, element, fragment, first, State::kNew});
  first = number;
  recent = {voxel, number};
}

void VoxelGrid::addTo(Clique& clique, const Box& box, std::uint32_t fragment, std::uint32_t element,
                      DisjointSets& subclusters) {
  clique.box.add(box);
  clique.state = State::kNew;
  fragments[fragment].next_in_clique = clique.first_fragment;
  clique.first_fragment = fragment;
  if (clique.root != element) clique.root = subclusters.merge(clique.root, element);
}

std::uint32_t VoxelGrid::makeBrick(const Key& key) {
  Group& group = makeGroup(containerOf(key));
  const std::uint32_t place = placeOf(key);
  if (group.bricks.has(place)) return group_bricks_[group.bricks.indexOf(place)];
  const auto number = static_cast<std::uint32_t>(bricks.size());
  bricks.push_back({key, kNone, {}, false, false});
  group.bricks.add(place, number, group_bricks_);
  filter.add(key);
  return number;
}

VoxelGrid::Group& VoxelGrid::makeGroup(const Key& key) {
  const std::uint32_t found = findGroup(key);
  if (found != kNone) return groups_[found];
  const auto number = static_cast<std::uint32_t>(groups_.size());
  groups_.push_back({key, {}});
  if (2 * groups_.size() > slots_.size())
    rehash(2 * slots_.size());
  else
    takeSlot(number);
  return groups_[number];
}

void VoxelGrid::rehash(std::size_t count) {
  slots_.assign(count, Slot());
  for (std::size_t group = 0; group < groups_.size(); ++group) takeSlot(static_cast<std::uint32_t>(group));
}

/// Puts a group that is not in the table where it is looked for.
void VoxelGrid::takeSlot(std::uint32_t group) {
  const std::size_t mask = slots_.size() - 1;
  const std::uint32_t hash = hashOf(groups_[group].key);
  std::size_t slot = hash & mask;
  while (slots_[slot].group != kNone) slot = (slot + 1) & mask;
  slots_[slot] = {hash, group};
}

/// The first clique of a voxel, kNone if it is new.
std::uint32_t& VoxelGrid::firstClique(Brick& brick, std::uint32_t voxel) {
  const std::size_t index =
      brick.voxels.has(voxel) ? brick.voxels.indexOf(voxel) : brick.voxels.add(voxel, kNone, first_cliques);
  return first_cliques[index];
}

bool VoxelGrid::BloomFilter::mayHaveNear(const Key& brick) const {
  // Three bricks in a row lie in two pairs at most.
  for (const std::uint32_t column : {((brick[0] - 1) & kBrickMask) / 2, ((brick[0] + 1) & kBrickMask) / 2})
    for (const std::uint32_t row : {((brick[1] - 1) & kBrickMask) / 2, ((brick[1] + 1) & kBrickMask) / 2})
      if ((bits_[wordOf(column, row)] & bitOf(column, row)) != 0) return true;
  return false;
}

void VoxelGrid::compactFragments(Clique& clique) {
  std::uint32_t count = fragments[clique.first_fragment].count;
  std::uint32_t end = fragments[clique.first_fragment].next_in_clique;
  if (end == kNone || fragments[end].count > 2 * count) return;
  for (; end != kNone && fragments[end].count <= 2 * count; end = fragments[end].next_in_clique)
    count += fragments[end].count;
  const std::size_t first = newPoints(count);
  std::size_t point = first;
  for (std::uint32_t i = clique.first_fragment; i != end; i = fragments[i].next_in_clique)
    for (std::uint32_t k = fragments[i].first_point; k < fragments[i].first_point + fragments[i].count; ++k, ++point) {
      x[point] = x[k];
      y[point] = y[k];
      z[point] = z[k];
    }
  fragments[clique.first_fragment] = {static_cast<std::uint32_t>(first), count, end};
}

}  // namespace lisco
