// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/near/voxel_grid.h"

namespace lisco {

/// Receives pairs of neighbours from different grids. Elements are those of VoxelGrid::add or others of their sets.
class PairVisitor {
 public:
  virtual ~PairVisitor() = default;
  /// False if nothing in a box of the own grid has neighbours in the other one.
  virtual bool reaches(const Box& /*own*/) const { return true; }
  /// False if the pair need not be tested.
  virtual bool inDifferentSets(std::uint32_t own, std::uint32_t others) = 0;
  /// Joins two neighbours.
  virtual void join(std::uint32_t own, std::uint32_t others) = 0;
};

/// Algorithm 4 on voxels: joins near returns that are neighbours. Serves one grid.
class VoxelLinker {
 public:
  /// Links what is new in the grid with all of it.
  void link(VoxelGrid& grid, DisjointSets& subclusters);

  /// The same part by part, which takes longer: number of bricks with new cliques, of one part or more each.
  static std::size_t bricksLeft(const VoxelGrid& grid) { return grid.new_bricks.size() - grid.linked_bricks; }
  /// Links a few new cliques of the first such brick; there must be one. \return its work
  static std::size_t linkPart(VoxelGrid& grid, DisjointSets& subclusters);

  /// Marks all that is in the grid as linked, with other grids, too: no longer new.
  static void markLinked(VoxelGrid& grid);

  enum class Part { kAll, kNew };  ///< kNew: cliques of any VoxelGrid::State but kOld
  /// Links a part of a grid with all of another one of the same tolerance. Both are linked within.
  static void linkTo(VoxelGrid& grid, VoxelGrid& other, Part part, PairVisitor& visitor);

 private:
  /// A brick by its number along z, y and x.
  struct OrderedBrick {
    std::uint64_t number;
    std::uint32_t brick;
  };

  void linkInOrder(VoxelGrid& grid, DisjointSets& subclusters);

  std::vector<OrderedBrick> ordered_;
};

}  // namespace lisco
