// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_plane.h"

#include <cstring>
#include <utility>

#include "core/near/constants.h"
#include "core/near/neighbourhood.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/near/voxel_plane.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Links the voxels of planes.
class PlaneLinker {
 public:
  PlaneLinker(const PlaneLayout& layout, DisjointSets& subclusters)
      : layout_(layout), squared_tolerance_(hn::Set(kFloats, layout.squared_tolerance)), subclusters_(subclusters) {}

  void linkWithin(VoxelPlane& plane) {
    for (VoxelPlane::Brick& brick : bricksOf(plane)) linkBrick(plane, brick);
    const std::uint64_t next_row = std::uint64_t{1} << layout_.minor_bits;
    VoxelPlane::Brick* const end = plane.bricks.data() + plane.brick_count;
    VoxelPlane::Brick* cursor = plane.bricks.data();
    for (VoxelPlane::Brick& brick : bricksOf(plane)) {
      if ((&brick + 1)->key == brick.key + 1) linkBricks(plane, brick, plane, *(&brick + 1), kOwnBrick + 1);
      linkRow(plane, brick, plane, cursor, end, brick.key + next_row, kOwnBrick + 3);
    }
  }

  void linkAcross(VoxelPlane& plane, VoxelPlane& next) {
    const std::uint64_t next_row = std::uint64_t{1} << layout_.minor_bits;
    VoxelPlane::Brick* const end = next.bricks.data() + next.brick_count;
    VoxelPlane::Brick* cursors[3] = {next.bricks.data(), next.bricks.data(), next.bricks.data()};
    for (VoxelPlane::Brick& brick : bricksOf(plane))
      for (std::size_t row = 0; row < 3; ++row)
        linkRow(plane, brick, next, cursors[row], end, brick.key + row * next_row - next_row, kOwnBrick + 6 + 3 * row);
  }

 private:
  struct Range {
    VoxelPlane::Brick *first, *last;
    VoxelPlane::Brick* begin() const { return first; }
    VoxelPlane::Brick* end() const { return last; }
  };
  /// All but the end mark.
  static Range bricksOf(VoxelPlane& plane) { return {plane.bricks.data(), plane.bricks.data() + plane.brick_count}; }

  std::uint32_t endOf(const VoxelPlane::Brick& brick) const { return (&brick + 1)->first_voxel; }

  /// Links a brick with those of another row whose number along the minor axis differs by 1 at most.
  /// \param cursor moves on from brick to brick
  /// \param key of the brick in the middle
  /// \param number of that among the near bricks
  void linkRow(VoxelPlane& plane, VoxelPlane::Brick& brick, VoxelPlane& other, VoxelPlane::Brick*& cursor,
               const VoxelPlane::Brick* end, std::uint64_t key, std::size_t number) {
    while (cursor != end && cursor->key < key - 1) ++cursor;
    for (VoxelPlane::Brick* near = cursor; near != end && near->key <= key + 1; ++near)
      linkBricks(plane, brick, other, *near, number + static_cast<std::size_t>(near->key - key));
  }

  /// Links the voxels of a brick with each other.
  void linkBrick(VoxelPlane& plane, VoxelPlane::Brick& brick) {
    const std::uint32_t end = endOf(brick);
    std::uint32_t voxel = brick.first_voxel;
    for (; voxel + 1 < end; ++voxel) linkVoxel(plane, voxel, plane, voxel + 1, end);
    brick.root = subclusters_.find(plane.root[brick.first_voxel]);
    for (voxel = brick.first_voxel + 1; voxel < end; ++voxel)
      if ((plane.root[voxel] = subclusters_.find(plane.root[voxel])) != brick.root) {
        brick.root = VoxelPlane::kSeveral;
        return;
      }
  }

  bool haveOneRoot(const VoxelPlane::Brick& a, const VoxelPlane::Brick& b) {
    return a.root != VoxelPlane::kSeveral && b.root != VoxelPlane::kSeveral &&
           subclusters_.find(a.root) == subclusters_.find(b.root);
  }

  /// \param number of the other brick among the near ones
  void linkBricks(VoxelPlane& plane, VoxelPlane::Brick& brick, VoxelPlane& other, VoxelPlane::Brick& near,
                  std::size_t number) {
    if (!(Box::squaredGap(brick.box, near.box) < layout_.squared_tolerance) || haveOneRoot(brick, near)) return;
    std::uint32_t voxel = brick.first_voxel;
    for (std::uint64_t left = brick.occupied; left != 0; left &= left - 1, ++voxel) {
      if ((near.occupied & kNeighbourhood.of[__builtin_ctzll(left)][number]) == 0) continue;
      if (linkVoxel(plane, voxel, other, near.first_voxel, endOf(near)) && haveOneRoot(brick, near)) return;
    }
  }

  /// Links a voxel with some consecutive ones. \return whether anything was joined
  bool linkVoxel(VoxelPlane& plane, std::uint32_t voxel, VoxelPlane& other, std::uint32_t begin, std::uint32_t end) {
    std::uint32_t root = subclusters_.find(plane.root[voxel]);
    bool is_joined = false;
    for (std::uint32_t k = begin; k < end; k += std::uint32_t{kLanes}) {
      const auto gap = [&](std::size_t axis) {
        const FloatVector above =
            hn::Sub(hn::Set(kFloats, plane.lo[axis][voxel]), hn::LoadU(kFloats, &other.hi[axis][k]));
        const FloatVector below =
            hn::Sub(hn::LoadU(kFloats, &other.lo[axis][k]), hn::Set(kFloats, plane.hi[axis][voxel]));
        return hn::Max(hn::Max(above, below), hn::Zero(kFloats));
      };
      // Box::squaredGap, lane by lane
      const FloatMask near = areNeighbours(gap(0), gap(1), gap(2), squared_tolerance_);
      std::uint32_t left = bitsOf(hn::And(near, differ(&other.root[k], hn::Set(kWords, root)))) & lanesBelow(end - k);
      for (; left != 0; left &= left - 1) {
        const std::uint32_t candidate = k + static_cast<std::uint32_t>(__builtin_ctz(left));
        const std::uint32_t other_root = other.root[candidate] = subclusters_.find(other.root[candidate]);
        if (other_root == root || !haveNeighbours(plane, voxel, other, candidate)) continue;
        other.root[candidate] = root = subclusters_.merge(root, other_root);
        is_joined = true;
      }
    }
    plane.root[voxel] = root;
    return is_joined;
  }

  static Box boxOf(const VoxelPlane& plane, std::uint32_t voxel) {
    return {{plane.lo[0][voxel], plane.lo[1][voxel], plane.lo[2][voxel]},
            {plane.hi[0][voxel], plane.hi[1][voxel], plane.hi[2][voxel]}};
  }

  /// Whether any return of one voxel is a neighbour of any return of another, whose boxes are near enough.
  bool haveNeighbours(const VoxelPlane& a_plane, std::uint32_t a, const VoxelPlane& b_plane, std::uint32_t b) const {
    const VoxelPlane* few = &a_plane;
    const VoxelPlane* many = &b_plane;
    if (few->first_point[a + 1] - few->first_point[a] > many->first_point[b + 1] - many->first_point[b]) {
      std::swap(few, many);
      std::swap(a, b);
    }
    const std::uint32_t begin = many->first_point[b];
    const std::uint32_t end = many->first_point[b + 1];
    if (end - begin == 1) return true;  // the boxes are the returns
    const Box box = boxOf(*many, b);
    for (std::uint32_t i = few->first_point[a]; i < few->first_point[a + 1]; ++i) {
      const NearReturn& point = few->points[i];
      if (!(Box::squaredGap(Box::around(point.x, point.y, point.z), box) < layout_.squared_tolerance)) continue;
      const FloatVector own_x = hn::Set(kFloats, point.x);
      const FloatVector own_y = hn::Set(kFloats, point.y);
      const FloatVector own_z = hn::Set(kFloats, point.z);
      for (std::uint32_t k = begin; k < end; k += std::uint32_t{kLanes}) {
        FloatVector x;
        FloatVector y;
        FloatVector z;
        FloatVector elements;
        hn::LoadInterleaved4(kFloats, &many->points[k].x, x, y, z, elements);
        const FloatMask near =
            areNeighbours(hn::Sub(own_x, x), hn::Sub(own_y, y), hn::Sub(own_z, z), squared_tolerance_);
        if ((bitsOf(near) & lanesBelow(end - k)) != 0) return true;
      }
    }
    return false;
  }

  const PlaneLayout& layout_;
  FloatVector squared_tolerance_;
  DisjointSets& subclusters_;
};

void linkWithin(VoxelPlane& plane, const PlaneLayout& layout, DisjointSets& subclusters) {
  PlaneLinker(layout, subclusters).linkWithin(plane);
}

void linkAcross(VoxelPlane& plane, VoxelPlane& next, const PlaneLayout& layout, DisjointSets& subclusters) {
  PlaneLinker(layout, subclusters).linkAcross(plane, next);
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(linkWithin);
HWY_EXPORT(linkAcross);

/// The box around some returns: four lanes, of which the last, of their elements, has no meaning.
class PointBounds {
 public:
  explicit PointBounds(const NearReturn& near) : lo_(lanesOf(near)), hi_(lo_) {}
  void add(const NearReturn& near) {
    const Lanes point = lanesOf(near);
    lo_ = point < lo_ ? point : lo_;
    hi_ = point > hi_ ? point : hi_;
  }
  Box box() const { return {{lo_[0], lo_[1], lo_[2]}, {hi_[0], hi_[1], hi_[2]}}; }

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

}  // namespace

void fillPlane(VoxelPlane& plane, const std::uint64_t* items, std::size_t count, std::size_t following,
               const PlaneLayout& layout, const FragmentList& fragments, DisjointSets& subclusters) {
  const std::uint64_t number_mask = (std::uint64_t{1} << layout.number_bits) - 1;
  const std::uint64_t brick_mask = (std::uint64_t{1} << layout.brick_bits) - 1;
  const auto numberOf = [&](std::uint64_t item) { return static_cast<std::size_t>(item & number_mask); };
  const bool is_one_part = fragments.parts.size() == 1;
  const NearReturn* const first_part = fragments.parts.front().near->returns.data();
  const auto returnOf = [&](std::uint64_t item) {
    if (is_one_part) return first_part + numberOf(item);
    const FragmentList::Part& part = fragments.partOf(numberOf(item));
    return part.near->returns.data() + (numberOf(item) - part.first);
  };
  plane.reserveVoxels(count);
  VoxelPlane::Brick* brick = plane.bricks.data() - 1;
  std::uint64_t brick_key = ~std::uint64_t{0};
  std::uint32_t voxel = 0;
  std::size_t points = 0;
  for (std::size_t i = 0; i < count; ++voxel) {
    const std::uint64_t key = items[i] >> layout.number_bits;
    const NearReturn* near = returnOf(items[i]);
    PointBounds bounds(*near);
    std::uint32_t root = subclusters.find(near->element);
    plane.first_point[voxel] = static_cast<std::uint32_t>(points);
    do {
      // In unordered clouds, returns and their sets are scattered in memory.
      const std::size_t left = count + following - i;
      if (left > kPrefetch) __builtin_prefetch(returnOf(items[i + kPrefetch]));
      if (left > kPrefetch / 2) subclusters.prefetch(returnOf(items[i + kPrefetch / 2])->element);
      near = returnOf(items[i]);
      root = subclusters.add(root, near->element);
      const std::size_t size = fragments.endOf(numberOf(items[i])) - numberOf(items[i]);
      plane.reservePoints(points + size);
      for (std::size_t k = 0; k < size; ++k, ++near, ++points) {
        plane.points[points] = *near;
        bounds.add(*near);
      }
      ++i;
    } while (i < count && items[i] >> layout.number_bits == key);
    const Box box = bounds.box();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      plane.lo[axis][voxel] = box.lo[axis];
      plane.hi[axis][voxel] = box.hi[axis];
    }
    plane.root[voxel] = root;
    if ((key >> 6 & brick_mask) != brick_key) {
      brick_key = key >> 6 & brick_mask;
      *++brick = {brick_key, 0, voxel, VoxelPlane::kSeveral, box};
    }
    brick->occupied |= std::uint64_t{1} << (key & 63U);
    brick->box.add(box);
  }
  plane.first_point[voxel] = static_cast<std::uint32_t>(points);
  *++brick = {~std::uint64_t{0}, 0, voxel, VoxelPlane::kSeveral, {}};
  plane.brick_count = static_cast<std::size_t>(brick - plane.bricks.data());
}

void linkPlane(VoxelPlane& plane, const PlaneLayout& layout, DisjointSets& subclusters) {
  HWY_DYNAMIC_DISPATCH(linkWithin)(plane, layout, subclusters);
}

void linkPlanes(VoxelPlane& plane, VoxelPlane& next, const PlaneLayout& layout, DisjointSets& subclusters) {
  HWY_DYNAMIC_DISPATCH(linkAcross)(plane, next, layout, subclusters);
}

}  // namespace lisco
#endif
