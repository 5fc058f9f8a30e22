// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/disjoint_sets.h"
#include "core/growing_array.h"
#include "core/near/brick_map.h"
#include "core/near/constants.h"
#include "core/near/fragments.h"
#include "core/near/near_returns.h"
#include "core/near/neighbourhood.h"
#include "core/neighbour.h"
#include "core/parallel.h"

namespace lisco {

/// A box whose coordinates lie in the lanes of two vectors; the last lane, of elements, has no meaning.
class BoxLanes {
 public:
  explicit BoxLanes(const NearReturn& near) : lo_(lanesOf(near)), hi_(lo_) {}
  /// \param lo four floats, which are lanes; hi likewise
  BoxLanes(const float* lo, const float* hi) {
    std::memcpy(&lo_, lo, sizeof lo_);
    std::memcpy(&hi_, hi, sizeof hi_);
  }
  /// A box around nothing.
  static BoxLanes empty() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    BoxLanes box{NearReturn{}};
    box.lo_ = Lanes{kInfinity, kInfinity, kInfinity, kInfinity};
    box.hi_ = -box.lo_;
    return box;
  }
  void add(const NearReturn& near) {
    const Lanes point = lanesOf(near);
    lo_ = point < lo_ ? point : lo_;
    hi_ = point > hi_ ? point : hi_;
  }
  void add(const BoxLanes& other) {
    lo_ = other.lo_ < lo_ ? other.lo_ : lo_;
    hi_ = other.hi_ > hi_ ? other.hi_ : hi_;
  }
  float lo(std::size_t axis) const { return lo_[axis]; }
  float hi(std::size_t axis) const { return hi_[axis]; }

  /// Box::squaredGap for boxes whose six coordinates are in two registers already.
  static float squaredGap(const BoxLanes& a, const BoxLanes& b) {
    const Lanes above = a.lo_ - b.hi_;
    const Lanes below = b.lo_ - a.hi_;
    const Lanes none{};
    Lanes gap = above > below ? above : below;
    gap = gap > none ? gap : none;
    return squaredDistance(gap[0], gap[1], gap[2]);
  }

 private:
  using Lanes = float __attribute__((vector_size(16)));
  static Lanes lanesOf(const NearReturn& near) {
    Lanes lanes;
    static_assert(sizeof lanes == sizeof near);
    std::memcpy(&lanes, &near, sizeof lanes);
    return lanes;
  }
  Lanes lo_, hi_;
};

/// The voxels of a plane of bricks, ordered by brick and voxel, each with the box around its returns.
struct alignas(kSeparate) VoxelPlane {
  static constexpr std::uint32_t kSeveral = ~std::uint32_t{0};
  static constexpr std::uint32_t kInItems = std::uint32_t{1} << 31;  ///< bit of `place`

  struct Brick {
    std::uint64_t key;       ///< its numbers along the middle and minor axis
    std::uint64_t occupied;  ///< bit i: voxel i; 0: holdsFewReturns ()
    std::uint32_t first_voxel;
    std::uint32_t root;  ///< common to all its voxels, perhaps outdated; kSeveral if they had several
    BoxLanes box{NearReturn{}};

    /// At most kFewReturns, each of which counts as a voxel.
    bool holdsFewReturns() const { return occupied == 0; }
  };

  /// Ordered by key, with an end mark behind the last. These arrays are longer than what is in use.
  GrowingArray<Brick> bricks;
  std::size_t brick_count = 0;
  BrickMap map;                      ///< of the bricks' keys
  GrowingArray<float> lo[3], hi[3];  ///< of each voxel's box
  GrowingArray<std::uint32_t> root;  ///< of its subcluster, perhaps outdated
  GrowingArray<std::uint32_t> return_count;
  /// Where a voxel's returns begin in `points`, or, with kInItems, its fragments in `items`. Fragments are put into
  /// `points` when they are first compared: most voxels are joined or kept apart by their boxes. Single returns of
  /// bricks of few have no place.
  GrowingArray<std::uint32_t> place;
  GrowingArray<NearReturn> points;
  std::size_t points_in_use = 0;
  const std::uint64_t* items = nullptr;  ///< sorted
  const FragmentList* fragments = nullptr;
  GrowingArray<std::uint8_t> begins_voxel;  ///< of single returns: whether each begins a voxel, 1 or 0

  // The arrays grow by these, to what is in use and some more, with the elements that are there.

  void reserveBricks(std::size_t count) { bricks.growInSteps(count); }
  void reserveVoxels(std::size_t count) {
    const std::size_t size = count + kReadBehind;
    if (place.size() >= size) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis].growInSteps(size);
      hi[axis].growInSteps(size);
    }
    root.growInSteps(size);
    return_count.growInSteps(size);
    place.growInSteps(size);
  }
  void reservePoints(std::size_t count) { points.growInSteps(count + kReadBehind); }
  /// Makes room for as much as there is room for in another plane.
  void reserveAs(const VoxelPlane& other) {
    bricks.grow(other.bricks.size());
    map.reserveAs(other.map);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis].grow(other.lo[axis].size());
      hi[axis].grow(other.hi[axis].size());
    }
    root.grow(other.root.size());
    return_count.grow(other.return_count.size());
    place.grow(other.place.size());
    points.grow(other.points.size());
    begins_voxel.grow(other.begins_voxel.size());
  }
};

/// The parts of an item, which is a key and a fragment's number, and the tolerance.
struct PlaneLayout {
  unsigned number_bits;  ///< of an item, below its key
  unsigned minor_bits;   ///< of a brick's key
  unsigned brick_bits;   ///< the same, middle and minor
  float squared_tolerance;
  const std::uint64_t (*around)[kNearBricks];  ///< Neighbourhood::of, of the voxels of a brick

  std::uint64_t nextRow() const { return std::uint64_t{1} << minor_bits; }  ///< in a brick's key
  std::uint64_t numberMask() const { return (std::uint64_t{1} << number_bits) - 1; }
};

/// Fills a plane with sorted fragments of runs, and joins those of each voxel.
/// \param items may be read up to kPrefetch behind the last
/// \return number of voxels
std::size_t fillPlaneFromRuns(VoxelPlane& plane, const std::uint64_t* items, std::size_t count,
                              const PlaneLayout& layout, const FragmentList& fragments, DisjointSets& subclusters);

/// Fills a plane with sorted single returns. Voxels, which are elements, receive their roots from the caller. In a
/// brick of at most kFewReturns, each return counts as a voxel: comparing them with each other takes less than telling
/// their voxels apart.
/// \param items as above
/// \return number of voxels
std::size_t fillPlaneFromSingle(VoxelPlane& plane, const std::uint64_t* items, std::size_t count,
                                const PlaneLayout& layout, const FragmentList& fragments);

/// Joins neighbours within a plane.
void linkPlane(VoxelPlane& plane, const PlaneLayout& layout, DisjointSets& subclusters);

/// Joins neighbours of a plane and the next one. Both are linked within, or will be.
void linkPlanes(VoxelPlane& plane, VoxelPlane& next, const PlaneLayout& layout, DisjointSets& subclusters);

}  // namespace lisco
