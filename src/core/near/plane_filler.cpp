// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>

#include "core/near/constants.h"
#include "core/near/voxel_plane.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/near/plane_filler.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/near/returns_box-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Puts sorted fragments into a plane, in place of what was there.
/// \tparam ReturnOf callable as const NearReturn* (std::size_t number): the first of a fragment
template <typename ReturnOf>
class PlaneFiller {
 public:
  PlaneFiller(VoxelPlane& plane, const std::uint64_t* items, std::size_t count, const PlaneLayout& layout,
              ReturnOf return_of)
      : plane_(plane),
        items_(items),
        count_(count),
        number_bits_(layout.number_bits),
        number_mask_(layout.numberMask()),
        key_mask_((std::uint64_t{1} << layout.brick_bits) - 1),
        return_of_(return_of) {
    plane.map.clear(count, layout.brick_bits);
    plane.items = items;
  }

  /// Fragments of runs, which are elements: those of a voxel are joined.
  std::size_t fillFromRuns(const FragmentList& fragments, DisjointSets& subclusters) {
    for (std::size_t i = 0; i < count_;) {
      const std::uint64_t brick = brickOf(i);
      beginBrick(brick);
      do {
        const std::uint64_t voxel = keyOf(i);
        beginVoxel(voxel, VoxelPlane::kInItems | i);
        std::uint32_t root = subclusters.find(returnOf(i)->element);
        std::size_t returns = 0;
        ReturnsBox box;
        do {
          // In the order of voxels, returns and their sets are scattered in memory.
          __builtin_prefetch(returnOf(i + kPrefetch));
          subclusters.prefetch(returnOf(i + kPrefetch / 2)->element);
          const NearReturn* const near = returnOf(i);
          root = subclusters.add(root, near->element);
          const std::size_t size = fragments.sizeOf(numberOf(i));
          box.add(near, size);
          returns += size;
          ++i;
        } while (i < count_ && keyOf(i) == voxel);
        plane_.root[voxels_] = root;
        endVoxel(box.box(), returns);
      } while (i < count_ && brickOf(i) == brick);
    }
    return finish();
  }

  /// Single returns.
  std::size_t fillFromSingle() {
    plane_.begins_voxel.growInSteps(count_);
    std::uint8_t* const begins_voxel = plane_.begins_voxel.data();
    for (std::size_t i = 0; i < count_;) {
      const std::uint64_t brick = brickOf(i);
      const std::size_t most = std::min(count_, i + kFewReturns + 1);
      std::size_t end = i + 1;
      while (end < most && brickOf(end) == brick) ++end;
      beginBrick(brick);
      if (end - i <= kFewReturns) {
        addFew(i, end, begins_voxel);
        i = end;
        continue;
      }
      do {
        const std::uint64_t voxel = keyOf(i);
        const std::size_t first_point = points_;
        begins_voxel[i] = 1;
        beginVoxel(voxel, first_point);
        BoxLanes box(addPoint(i));
        while (++i < count_ && keyOf(i) == voxel) {
          begins_voxel[i] = 0;
          box.add(addPoint(i));
        }
        endVoxel(box, points_ - first_point);
      } while (i < count_ && brickOf(i) == brick);
    }
    return finish();
  }

 private:
  std::uint64_t keyOf(std::size_t i) const { return items_[i] >> number_bits_; }
  std::uint64_t brickOf(std::size_t i) const { return keyOf(i) >> 6; }
  std::size_t numberOf(std::size_t i) const { return static_cast<std::size_t>(items_[i] & number_mask_); }
  const NearReturn* returnOf(std::size_t i) const { return return_of_(numberOf(i)); }

  void beginBrick(std::uint64_t brick) {
    const std::uint64_t key = brick & key_mask_;
    plane_.reserveBricks(bricks_ + 1);
    plane_.bricks[bricks_] = {key, 0, voxels_, VoxelPlane::kSeveral, BoxLanes(NearReturn{})};
    plane_.map.add(key, bricks_);
    ++bricks_;
  }

  /// \param place see VoxelPlane
  void beginVoxel(std::uint64_t key, std::size_t place) {
    plane_.reserveVoxels(voxels_ + 1);
    plane_.place[voxels_] = static_cast<std::uint32_t>(place);
    plane_.bricks[bricks_ - 1].occupied |= std::uint64_t{1} << (key & 63U);
  }

  void endVoxel(const BoxLanes& box, std::size_t returns) {
    plane_.return_count[voxels_] = static_cast<std::uint32_t>(returns);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      plane_.lo[axis][voxels_] = box.lo(axis);
      plane_.hi[axis][voxels_] = box.hi(axis);
    }
    VoxelPlane::Brick& brick = plane_.bricks[bricks_ - 1];
    if (brick.first_voxel == voxels_)
      brick.box = box;
    else
      brick.box.add(box);
    ++voxels_;
  }

  /// Single return i, which is used next.
  const NearReturn& nextReturn(std::size_t i) const {
    __builtin_prefetch(returnOf(i + kPrefetch));
    return *returnOf(i);
  }

  const NearReturn& addPoint(std::size_t i) {
    const NearReturn& near = nextReturn(i);
    plane_.reservePoints(points_ + 1);
    plane_.points[points_++] = near;
    return near;
  }

  /// Adds the returns of a brick as voxels of their own.
  void addFew(std::size_t begin, std::size_t end, std::uint8_t* begins_voxel) {
    plane_.reserveVoxels(voxels_ + kFewReturns);
    BoxLanes box(*returnOf(begin));
    for (std::size_t i = begin; i < end; ++i, ++voxels_) {
      plane_.return_count[voxels_] = 1;
      begins_voxel[i] = 1;
      const NearReturn& near = nextReturn(i);
      plane_.lo[0][voxels_] = plane_.hi[0][voxels_] = near.x;
      plane_.lo[1][voxels_] = plane_.hi[1][voxels_] = near.y;
      plane_.lo[2][voxels_] = plane_.hi[2][voxels_] = near.z;
      box.add(near);
    }
    plane_.bricks[bricks_ - 1].box = box;
  }

  std::size_t finish() {
    plane_.brick_count = bricks_;
    plane_.points_in_use = points_;
    plane_.reserveBricks(bricks_ + 1);
    plane_.bricks[bricks_] = {~std::uint64_t{0}, 0, voxels_, VoxelPlane::kSeveral, BoxLanes(NearReturn{})};
    return voxels_;
  }

  VoxelPlane& plane_;
  const std::uint64_t* const items_;
  const std::size_t count_;
  const unsigned number_bits_;
  const std::uint64_t number_mask_, key_mask_;
  const ReturnOf return_of_;
  std::uint32_t bricks_ = 0;
  std::uint32_t voxels_ = 0;
  std::size_t points_ = 0;
};

/// Calls fill(filler) with a filler of a plane. \return what it returns
template <typename Fill>
std::size_t fillWith(VoxelPlane& plane, const std::uint64_t* items, std::size_t count, const PlaneLayout& layout,
                     const FragmentList& fragments, Fill&& fill) {
  plane.fragments = &fragments;
  const auto fillFrom = [&](auto return_of) {
    PlaneFiller<decltype(return_of)> filler(plane, items, count, layout, return_of);
    return fill(filler);
  };
  if (fragments.parts.size() > 1)
    return fillFrom([&fragments](std::size_t number) { return fragments.returnsOf(number); });
  return fillFrom(
      [returns = fragments.parts.front().near->returns.data()](std::size_t number) { return returns + number; });
}

std::size_t fillFromRuns(VoxelPlane& plane, const std::uint64_t* items, std::size_t count, const PlaneLayout& layout,
                         const FragmentList& fragments, DisjointSets& subclusters) {
  return fillWith(plane, items, count, layout, fragments,
                  [&](auto& filler) { return filler.fillFromRuns(fragments, subclusters); });
}

std::size_t fillFromSingle(VoxelPlane& plane, const std::uint64_t* items, std::size_t count, const PlaneLayout& layout,
                           const FragmentList& fragments) {
  return fillWith(plane, items, count, layout, fragments, [](auto& filler) { return filler.fillFromSingle(); });
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(fillFromRuns);
HWY_EXPORT(fillFromSingle);

}  // namespace

std::size_t fillPlaneFromRuns(VoxelPlane& plane, const std::uint64_t* items, std::size_t count,
                              const PlaneLayout& layout, const FragmentList& fragments, DisjointSets& subclusters) {
  return HWY_DYNAMIC_DISPATCH(fillFromRuns)(plane, items, count, layout, fragments, subclusters);
}

std::size_t fillPlaneFromSingle(VoxelPlane& plane, const std::uint64_t* items, std::size_t count,
                                const PlaneLayout& layout, const FragmentList& fragments) {
  return HWY_DYNAMIC_DISPATCH(fillFromSingle)(plane, items, count, layout, fragments);
}

}  // namespace lisco
#endif
