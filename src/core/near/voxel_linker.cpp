// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_linker.h"

#include <algorithm>

#include "core/near/kernels.h"
#include "core/near/neighbourhood.h"

namespace lisco {

namespace {

using Brick = VoxelGrid::Brick;
using Clique = VoxelGrid::Clique;
using Fragment = VoxelGrid::Fragment;
using NearBrick = VoxelGrid::NearBrick;
using State = VoxelGrid::State;

constexpr std::uint32_t kNone = VoxelGrid::kNone;
/// Bits of a brick's number along an axis; those numbered in float have fewer.
constexpr unsigned kOrderBits = 21;
/// New cliques that are linked at a time: fewer spread the work of columns more evenly, more need fewer look-ups
/// (benchmarks/suite.sh latency).
constexpr std::size_t kCliquesOfPart = 4;
/// Work of finding the bricks around one, in comparisons of cliques.
constexpr std::size_t kWorkOfFinding = 10;

/// Finds the bricks around one that are in use and wanted.
/// \param wanted callable as bool (const Brick&)
template <typename Wanted>
std::size_t findNear(const VoxelGrid& grid, const VoxelGrid::Key& key, NearBrick* near, Wanted&& wanted) {
  std::size_t count = 0;
  grid.forEachBrickAround(key, [&](std::size_t mask, std::uint32_t number) {
    const Brick& brick = grid.bricks[number];
    if (wanted(brick)) near[count++] = {mask, brick.voxels};
  });
  return count;
}

/// Calls visit for each clique in the voxels around one.
/// \param in_own_brick which voxels of its own brick are visited
template <typename Visit>
void forEachAround(const VoxelGrid& grid, std::size_t voxel, const NearBrick* near, std::size_t count,
                   std::uint64_t in_own_brick, Visit&& visit) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t around = near[i].voxels.used & kNeighbourhood.of[voxel][near[i].mask];
    if (near[i].mask == kOwnBrick) around &= in_own_brick;
    for (; around != 0; around &= around - 1) {
      const auto place = static_cast<std::uint32_t>(__builtin_ctzll(around));
      for (std::uint32_t other = grid.first_cliques[near[i].voxels.indexOf(place)]; other != kNone;
           other = grid.cliques[other].next_in_voxel)
        visit(other);
    }
  }
}

/// Whether any return of one clique is a neighbour of any return of another: boxes first, points last.
bool haveNeighbours(VoxelGrid& own_grid, Clique& own, VoxelGrid& other_grid, Clique& other) {
  const float squared_tolerance = own_grid.tolerance.squared();
  if (!(Box::squaredGap(own.box, other.box) < squared_tolerance)) return false;
  if (Box::squaredSpan(own.box, other.box) < squared_tolerance) return true;
  own_grid.compactFragments(own);
  other_grid.compactFragments(other);
  const auto pointsOf = [](const VoxelGrid& grid, const Fragment& fragment) {
    const std::size_t first = fragment.first_point;
    return PointSpan{&grid.x[first], &grid.y[first], &grid.z[first], fragment.count};
  };
  for (std::uint32_t i = own.first_fragment; i != kNone; i = own_grid.fragments[i].next_in_clique)
    for (std::uint32_t k = other.first_fragment; k != kNone; k = other_grid.fragments[k].next_in_clique)
      if (haveNeighbours(pointsOf(own_grid, own_grid.fragments[i]), own.box,
                         pointsOf(other_grid, other_grid.fragments[k]), other.box, squared_tolerance))
        return true;
  return false;
}

void linkIfNeighbours(VoxelGrid& grid, std::uint32_t a_number, std::uint32_t b_number, DisjointSets& subclusters) {
  Clique& a = grid.cliques[a_number];
  Clique& b = grid.cliques[b_number];
  if (a.root == b.root) return;
  a.root = subclusters.find(a.root);
  b.root = subclusters.find(b.root);
  if (a.root != b.root && haveNeighbours(grid, a, grid, b)) a.root = b.root = subclusters.merge(a.root, b.root);
}

/// The root of all cliques of a brick, kNone if they have several.
std::uint32_t commonRoot(VoxelGrid& grid, const Brick& brick, DisjointSets& subclusters) {
  std::uint32_t root = kNone;
  bool common = true;
  grid.forEachClique(brick, [&](std::size_t, std::uint32_t number) {
    Clique& clique = grid.cliques[number];
    if (clique.root == root || !common) return;
    clique.root = subclusters.find(clique.root);
    common = root == kNone || clique.root == root;
    root = clique.root;
  });
  return common ? root : kNone;
}

/// Links new cliques of a brick with all around them that are linked already, so that each pair is compared once.
/// Bricks of one common root, which most are, are skipped as a whole. The brick is new until all its cliques are
/// linked.
/// \param most number of cliques, at most
/// \return its work: comparisons, and bricks looked for
std::size_t linkSome(VoxelGrid& grid, Brick& brick, std::size_t most, DisjointSets& subclusters) {
  const std::uint32_t root = commonRoot(grid, brick, subclusters);
  NearBrick near[kNearBricks];
  const std::size_t count = findNear(grid, brick.key, near, [&](const Brick& other) {
    if (&other == &brick) return root == kNone;
    if (!other.is_linked) return false;
    return root == kNone || other.root == kNone || subclusters.find(root) != subclusters.find(other.root);
  });
  std::size_t work = kWorkOfFinding;
  brick.is_new = false;
  grid.forEachClique(brick, [&](std::size_t voxel, std::uint32_t clique) {
    if (grid.cliques[clique].state != State::kNew) return;
    if (most == 0) {
      brick.is_new = true;
      return;
    }
    --most;
    forEachAround(grid, voxel, near, count, ~std::uint64_t{0}, [&](std::uint32_t other) {
      if (grid.cliques[other].state == State::kNew) return;
      linkIfNeighbours(grid, clique, other, subclusters);
      ++work;
    });
    grid.cliques[clique].state = State::kLinked;
  });
  brick.is_linked = true;
  brick.root = brick.is_new ? kNone : root != kNone ? root : commonRoot(grid, brick, subclusters);
  return work;
}

/// Links all cliques of a brick with those that come after them, there and in the bricks given.
void linkAll(VoxelGrid& grid, const Brick& brick, const NearBrick* near, std::size_t count, DisjointSets& subclusters) {
  std::uint32_t rank = 0;
  for (std::uint64_t left = brick.voxels.used; left != 0; left &= left - 1, ++rank) {
    const auto voxel = static_cast<std::size_t>(__builtin_ctzll(left));
    for (std::uint32_t clique = grid.first_cliques[brick.voxels.begin + rank]; clique != kNone;
         clique = grid.cliques[clique].next_in_voxel) {
      for (std::uint32_t other = grid.cliques[clique].next_in_voxel; other != kNone;
           other = grid.cliques[other].next_in_voxel)
        linkIfNeighbours(grid, clique, other, subclusters);
      forEachAround(grid, voxel, near, count, left & (left - 1),
                    [&](std::uint32_t other) { linkIfNeighbours(grid, clique, other, subclusters); });
    }
  }
}

void linkBrickTo(VoxelGrid& grid, const Brick& brick, VoxelGrid& other, VoxelLinker::Part part, PairVisitor& visitor) {
  NearBrick near[kNearBricks];
  std::size_t count = 0;
  bool searched = false;
  grid.forEachClique(brick, [&](std::size_t voxel, std::uint32_t number) {
    Clique& own = grid.cliques[number];
    if ((part == VoxelLinker::Part::kNew && own.state == State::kOld) || !visitor.reaches(own.box)) return;
    if (!searched)
      count = findNear(other, brick.key, near, [&](const Brick& others) {
        return brick.root == kNone || others.root == kNone || visitor.inDifferentSets(brick.root, others.root);
      });
    searched = true;
    forEachAround(other, voxel, near, count, ~std::uint64_t{0}, [&](std::uint32_t j) {
      Clique& others = other.cliques[j];
      if (Box::squaredGap(own.box, others.box) < grid.tolerance.squared() &&
          visitor.inDifferentSets(own.root, others.root) && haveNeighbours(grid, own, other, others))
        visitor.join(own.root, others.root);
    });
  });
}

/// Links new cliques of the first brick that has any.
std::size_t linkNext(VoxelGrid& grid, std::size_t most, DisjointSets& subclusters) {
  Brick& brick = grid.bricks[grid.new_bricks[grid.linked_bricks]];
  const std::size_t work = linkSome(grid, brick, most, subclusters);
  if (!brick.is_new) ++grid.linked_bricks;
  return work;
}

}  // namespace

void VoxelLinker::link(VoxelGrid& grid, DisjointSets& subclusters) {
  // The first brick is the first to be linked.
  const bool all_new = !grid.bricks.empty() && !grid.bricks.front().is_linked;
  if (all_new && grid.all_in_float_range) linkInOrder(grid, subclusters);
  while (bricksLeft(grid) > 0) linkNext(grid, ~std::size_t{0}, subclusters);
}

std::size_t VoxelLinker::linkPart(VoxelGrid& grid, DisjointSets& subclusters) {
  return linkNext(grid, kCliquesOfPart, subclusters);
}

void VoxelLinker::markLinked(VoxelGrid& grid) {
  for (const std::uint32_t number : grid.new_bricks) {
    Brick& brick = grid.bricks[number];
    if (brick.is_new) brick.root = kNone;
    brick.is_new = false;
    brick.is_linked = true;
    grid.forEachClique(brick, [&](std::size_t, std::uint32_t clique) { grid.cliques[clique].state = State::kOld; });
  }
  grid.new_bricks.clear();
  grid.linked_bricks = 0;
}

/// Links all with all. Bricks are sorted by z, y and x: the bricks around one are found by cursors in its own and four
/// following rows, without the hash table.
void VoxelLinker::linkInOrder(VoxelGrid& grid, DisjointSets& subclusters) {
  constexpr std::uint32_t kMiddle = std::uint32_t{1} << (kOrderBits - 1);
  const auto number = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return (std::uint64_t{z} << kOrderBits | y) << kOrderBits | x;
  };
  ordered_.clear();
  for (std::uint32_t brick = 0; brick < grid.bricks.size(); ++brick) {
    const auto along = [&](std::size_t axis) {
      return (grid.bricks[brick].key[axis] + kMiddle) & VoxelGrid::kBrickMask;
    };
    ordered_.push_back({number(along(0), along(1), along(2)), brick});
  }
  std::sort(ordered_.begin(), ordered_.end(),
            [](const OrderedBrick& a, const OrderedBrick& b) { return a.number < b.number; });

  constexpr std::size_t kRows = 4;
  const std::uint64_t row_at[kRows] = {number(0, 1, 0), number(0, 0, 1) - number(0, 1, 0), number(0, 0, 1),
                                       number(0, 1, 1)};
  constexpr std::size_t kFirstMask[kRows] = {15, 18, 21, 24};
  std::size_t cursors[kRows] = {};
  NearBrick near[kNearBricks];
  for (std::size_t i = 0; i < ordered_.size(); ++i) {
    const OrderedBrick& own = ordered_[i];
    std::size_t count = 0;
    const auto add = [&](std::size_t mask, const OrderedBrick& other) {
      const Brick& brick = grid.bricks[other.brick];
      near[count++] = {mask, brick.voxels};
    };
    add(kOwnBrick, own);
    if (i + 1 < ordered_.size() && ordered_[i + 1].number == own.number + 1) add(kOwnBrick + 1, ordered_[i + 1]);
    for (std::size_t row = 0; row < kRows; ++row) {
      const std::uint64_t first = own.number + row_at[row] - 1;
      std::size_t& at = cursors[row];
      while (at < ordered_.size() && ordered_[at].number < first) ++at;
      for (std::size_t k = at; k < ordered_.size() && ordered_[k].number <= first + 2; ++k)
        add(kFirstMask[row] + static_cast<std::size_t>(ordered_[k].number - first), ordered_[k]);
    }
    linkAll(grid, grid.bricks[own.brick], near, count, subclusters);
  }
  for (Clique& clique : grid.cliques) clique.state = State::kLinked;
  for (Brick& brick : grid.bricks) {
    brick.is_new = false;
    brick.is_linked = true;
  }
  grid.linked_bricks = grid.new_bricks.size();
}

void VoxelLinker::linkTo(VoxelGrid& grid, VoxelGrid& other, Part part, PairVisitor& visitor) {
  const auto link = [&](const Brick& brick) {
    if (other.filter.mayHaveNear(brick.key)) linkBrickTo(grid, brick, other, part, visitor);
  };
  if (part == Part::kAll)
    std::for_each(grid.bricks.begin(), grid.bricks.end(), link);
  else
    for (const std::uint32_t brick : grid.new_bricks) link(grid.bricks[brick]);
}

}  // namespace lisco
