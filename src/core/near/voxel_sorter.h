// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/growing_array.h"
#include "core/near/constants.h"
#include "core/near/near_returns.h"
#include "core/near/voxel_plane.h"
#include "core/neighbour.h"
#include "core/parallel.h"
#include "core/work_shares.h"

namespace lisco {

/// How voxels are numbered: from a corner of the box around all returns, in double, so that returns of the same number
/// are neighbours and neighbours differ by 2 at most along each axis. The longest side of the box is the major axis, or
/// one along which threads have read returns beside each other.
///
/// Far from the origin, as in map coordinates, floats are so coarse that unlike coordinates along an axis may be eps
/// apart. The returns of one coordinate are a *slice* then: neighbours lie in the same one, and differ along two axes
/// only, so that voxels are larger. That axis is the major one, and a plane of bricks is a slice.
struct VoxelNumbering {
  std::size_t axis[3];     ///< minor, middle and major: 0 for x, 1 for y, 2 for z
  double corner[3];        ///< of the box, metres, by x, y and z
  double per_metre[3];     ///< voxels, by x, y and z
  unsigned voxel_bits[3];  ///< of a voxel's number in its brick, along the minor, middle and major axis
  bool has_slices;
  /// Of a key: from the highest bit on, a brick's number along the major, middle and minor axis, and the voxel's in it.
  unsigned minor_bits, middle_bits, bits;
};

/// Algorithm 4 on near returns that are read at once: sorts them by voxel and joins neighbours plane by plane.
///
/// The returns of a run in a voxel are a *fragment*. Fragments are sorted by key (radix sort), so that the returns of a
/// voxel, of a brick of 4 x 4 x 4 voxels (8 x 4 in a slice), and of a plane of bricks across the major axis lie side by
/// side. Each plane is linked within and, unless it is a slice, with the plane before. Each thread links a slab of
/// consecutive planes, where possible of the returns that it has read itself.
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
  /// Fragments of consecutive planes, the work of one thread.
  struct alignas(kSeparate) Slab {
    std::size_t begin, end;  ///< among the sorted fragments
    std::size_t voxels = 0;  ///< of single returns: number of them; voxel i is element begin + i
  };

  /// The sets of single returns and their voxels, by element and by number: in scratch_, which is free once the
  /// fragments are sorted.
  struct Sets {
    std::uint32_t of_voxel;  ///< before all are linked: number of its returns
    std::uint32_t of_return;
  };
  static_assert(sizeof(Sets) == sizeof(std::uint64_t));
  Sets* sets() { return reinterpret_cast<Sets*>(scratch_.data()); }
  const Sets* sets() const { return reinterpret_cast<const Sets*>(scratch_.data()); }

  bool sortFragments(const Tolerance& tolerance);
  bool chooseNumbering(const Tolerance& tolerance);
  Box boxOfAll();
  void orderAxes(const Box& all, const double (&sides)[3], std::size_t sliced);
  void assignSlabs();
  void joinParts();
  void cutFragments();
  void divide();
  void sort(const Slab& slab);
  template <typename Work>
  void forEachPart(Work&& work);
  template <typename Work>
  void forEachSlab(Work&& work);
  void linkSlabs(const Tolerance& tolerance, DisjointSets& subclusters);
  void numberSets(std::vector<std::uint32_t>& sizes);
  void numberReturns(const Slab& slab);
  void linkSlab(std::size_t slab, const Tolerance& tolerance, DisjointSets& subclusters);
  void addVoxels(std::size_t slab, const VoxelPlane& plane, std::size_t voxels, std::size_t begin, std::size_t end);
  std::uint64_t planeOf(std::uint64_t item) const { return item >> plane_shift_; }
  std::size_t endOfPlane(std::size_t begin, std::size_t end) const;

  std::size_t min_shared_;
  bool is_shared_ = false;  ///< the work, by several threads
  VoxelNumbering numbering_{};
  unsigned number_bits_ = 0;  ///< of an item: the lowest
  unsigned plane_shift_ = 0;
  FragmentList fragments_;
  GrowingArray<std::uint64_t> items_;    ///< a fragment's key and number
  GrowingArray<std::uint64_t> scratch_;  ///< the same while sorting; then sets ()
  std::vector<Box> part_boxes_;
  std::vector<std::size_t> part_sizes_;  ///< in fragments
  struct Planes {
    std::uint32_t fragments;  ///< number of them; then where the next one goes
    std::uint32_t work;       ///< of linking them, about in returns
  };
  std::vector<Planes> histogram_;  ///< of groups of planes, of each part
  std::vector<Slab> slabs_;
  std::vector<std::size_t> thread_of_;  ///< by slab, if the work is shared
  std::vector<std::size_t> slab_of_;    ///< by thread
  WorkShares shares_;                   ///< of threads
  std::vector<VoxelPlane> planes_;      ///< two for each slab
  // Of single returns, whose voxels are elements:
  DisjointSets voxels_;
  GrowingArray<std::uint8_t> begins_voxel_;  ///< whether each return, as sorted, begins a voxel; and behind the last
};

}  // namespace lisco
