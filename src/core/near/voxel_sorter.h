// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/growing_array.h"
#include "core/near/constants.h"
#include "core/near/fragments.h"
#include "core/near/near_returns.h"
#include "core/near/slab_division.h"
#include "core/near/voxel_numbering.h"
#include "core/near/voxel_plane.h"
#include "core/neighbour.h"

namespace lisco {

/// Algorithm 4 on near returns that are read at once: sorts them by voxel and joins neighbours plane by plane.
///
/// The returns of a run in a voxel are a *fragment*. Fragments are sorted by key (radix sort), so that the returns of a
/// voxel, of a brick of 4 x 4 x 4 voxels (8 x 4 in a slice), and of a plane of bricks across the major axis lie side by
/// side. Each plane is linked within and, unless it is a slice, with the plane before. Each thread sorts what it has
/// read, and merges what all have of a slab of consecutive planes, where possible of the returns that it has read
/// itself. It links planes from one end of the slab on, until it meets the thread that began at the other end of the
/// slab beside.
class VoxelSorter {
 public:
  /// \param min_shared returns from which on the threads that have read them share the work
  explicit VoxelSorter(std::size_t min_shared = kMinSharedReturns) : min_shared_(min_shared) {}

  /// Joins all neighbours among some returns.
  /// \param parts the returns; each part is numbered by a thread of its own
  /// \return false, with nothing joined, if the voxels cannot be numbered: a tolerance beyond [1e-18, 1e18] m, or a box
  ///         of too many voxels
  bool link(const std::vector<const NearReturns*>& parts, const Tolerance& tolerance, DisjointSets& subclusters);

  /// Returns that are each a run of its own; their elements do not matter.
  struct SingleReturns {
    const NearReturns* near;
    std::size_t first;  ///< receives the number of the first one; the others' follow
  };
  /// Numbers the sets of neighbours of such returns, in the order of their voxels.
  /// \param tolerance joins something
  /// \param sizes receives the number of returns of each set
  /// \return as link ()
  bool number(std::vector<SingleReturns>& parts, const Tolerance& tolerance, std::vector<std::uint32_t>& sizes);
  /// The number of a return's set, after number (). \param number of the return
  std::uint32_t setOf(std::size_t number) const { return sets()[number].of_return; }

 private:
  /// The sets of single returns and their voxels, by element and by number: in the scratch memory, which is free once
  /// the fragments are sorted.
  struct Sets {
    std::uint32_t of_voxel;  ///< before all are linked: number of its returns
    std::uint32_t of_return;
  };
  static_assert(sizeof(Sets) == sizeof(std::uint64_t));
  Sets* sets() { return reinterpret_cast<Sets*>(items_.scratch.data()); }
  const Sets* sets() const { return reinterpret_cast<const Sets*>(items_.scratch.data()); }

  /// The two planes that a thread has in memory.
  struct alignas(kSeparate) TwoPlanes {
    VoxelPlane planes[2];
    std::size_t latest = 0;    ///< which of them was linked last
    std::uint64_t number = 0;  ///< of that one, among all planes

    VoxelPlane& latestPlane() { return planes[latest]; }
    VoxelPlane& otherPlane() { return planes[1 - latest]; }
  };

  bool sortFragments(const Tolerance& tolerance);
  bool chooseNumbering(const Tolerance& tolerance);
  void cutFragments();
  void sort(std::size_t begin, std::size_t count);
  template <typename Work>
  void forEachPart(Work&& work);
  void linkSlabs(const Tolerance& tolerance, DisjointSets& subclusters);
  void numberSets(std::vector<std::uint32_t>& sizes);
  void numberReturns(std::size_t slab);
  std::size_t firstVoxel(std::size_t slab) const;
  void linkSlab(std::size_t slab, const PlaneLayout& layout, DisjointSets& subclusters);
  void fillPlaneBefore(std::size_t slab, const PlaneLayout& layout, DisjointSets& subclusters);
  void linkPlanesOf(std::size_t slab, Planes planes, const PlaneLayout& layout, DisjointSets& subclusters);
  std::size_t fillPlane(VoxelPlane& plane, const Planes& one, const PlaneLayout& layout, DisjointSets& subclusters);
  void addVoxels(std::size_t slab, VoxelPlane& plane, std::size_t voxels, const Planes& one);
  bool linksPlanes() const { return !numbering_.has_slices; }

  std::size_t min_shared_;
  bool is_shared_ = false;  ///< the work, by several threads
  FragmentList fragments_;
  std::vector<Box> boxes_;  ///< of its parts
  VoxelNumbering numbering_{};
  FragmentItems items_;  ///< the scratch memory: once they are sorted, sets ()
  SlabDivision division_;
  std::vector<TwoPlanes> planes_;  ///< by slab
  // Of single returns, whose voxels are elements:
  DisjointSets voxels_;
  GrowingArray<std::uint8_t> begins_voxel_;  ///< whether each return, as sorted, begins a voxel; and behind the last
};

}  // namespace lisco
