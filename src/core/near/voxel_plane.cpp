// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_plane.h"

#include <algorithm>
#include <utility>

#include "core/near/constants.h"

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
    if (plane.map.isInOrder())
      linkToRows<true>(plane);
    else
      linkToRows<false>(plane);
  }

  void linkAcross(VoxelPlane& plane, VoxelPlane& next) {
    if (next.map.isInOrder())
      linkToRows<true>(plane, next);
    else
      linkToRows<false>(plane, next);
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

  /// Links each brick with the next one in its row, and with three of the next row.
  template <bool kInOrder>
  void linkToRows(VoxelPlane& plane) {
    const std::uint64_t next_row = layout_.nextRow();
    for (VoxelPlane::Brick& brick : bricksOf(plane)) {
      const std::uint32_t near =
          (plane.map.near<kInOrder>(brick.key + 1) >> 1 & 1U) | plane.map.near<kInOrder>(brick.key + next_row) << 1;
      forEachBit(near, [&](std::size_t i) {
        const std::uint64_t key = i == 0 ? brick.key + 1 : brick.key + next_row + i - 2;
        linkBricks(plane, brick, plane, plane.bricks[plane.map.numberOf<kInOrder>(key)], kOwnBrick + 1 + i);
      });
    }
  }

  /// Links each brick with three of each of three rows of the next plane.
  template <bool kInOrder>
  void linkToRows(VoxelPlane& plane, VoxelPlane& next) {
    const std::uint64_t next_row = layout_.nextRow();
    for (VoxelPlane::Brick& brick : bricksOf(plane)) {
      const std::uint64_t first = brick.key - next_row;
      const std::uint32_t near = next.map.near<kInOrder>(first) | next.map.near<kInOrder>(brick.key) << 3 |
                                 next.map.near<kInOrder>(brick.key + next_row) << 6;
      forEachBit(near, [&](std::size_t i) {
        const std::uint64_t key = first + i / 3 * next_row + i % 3 - 1;
        linkBricks(plane, brick, next, next.bricks[next.map.numberOf<kInOrder>(key)], kOwnBrick + 5 + i);
      });
    }
  }

  /// Links the voxels of a brick with each other.
  void linkBrick(VoxelPlane& plane, VoxelPlane::Brick& brick) {
    const std::uint32_t first = brick.first_voxel;
    if (isSingle(brick))
      brick.root = plane.root[first];
    else if (brick.holdsFewReturns())
      spread(plane, brick, [&](std::uint32_t voxel, std::uint64_t left, std::uint32_t& root) {
        const std::uint64_t joined = neighboursOf(plane, voxel, plane, first) & left;
        forEachBit(joined, [&](std::size_t i) { root = subclusters_.add(root, plane.root[first + i]); });
        return joined;
      });
    else
      spread(plane, brick, [&](std::uint32_t voxel, std::uint64_t left, std::uint32_t& root) {
        return linkVoxel(plane, voxel, plane, first, left, root);
      });
  }

  /// Links a voxel that joins a set with those that are in none yet.
  /// \param link callable as std::uint64_t (std::uint32_t voxel, std::uint64_t left, std::uint32_t& root): links a
  ///        voxel with some of the brick, and returns those that join its set
  template <typename Link>
  void spread(VoxelPlane& plane, VoxelPlane::Brick& brick, Link&& link) {
    const std::uint32_t first = brick.first_voxel;
    std::uint64_t left = allOf(brick);
    std::uint32_t root = 0;
    std::uint32_t parts = 0;
    for (; left != 0; ++parts) {
      std::uint64_t joined = left & (~left + 1);
      left -= joined;
      root = subclusters_.find(plane.root[first + static_cast<std::uint32_t>(__builtin_ctzll(joined))]);
      while (joined != 0 && left != 0) {
        const std::uint64_t more = link(first + static_cast<std::uint32_t>(__builtin_ctzll(joined)), left, root);
        joined = (joined & (joined - 1)) | more;
        left &= ~more;
      }
    }
    brick.root = parts == 1 ? root : VoxelPlane::kSeveral;
    if (parts == 1) std::fill_n(&plane.root[first], endOf(brick) - first, root);
  }

  /// Whether a brick has one voxel.
  bool isSingle(const VoxelPlane::Brick& brick) const { return endOf(brick) - brick.first_voxel == 1; }

  /// Bit i: voxel first_voxel + i of a brick.
  std::uint64_t allOf(const VoxelPlane::Brick& brick) const {
    return ~std::uint64_t{0} >> (64 - (endOf(brick) - brick.first_voxel));
  }

  bool haveOneRoot(const VoxelPlane::Brick& a, const VoxelPlane::Brick& b) {
    return a.root != VoxelPlane::kSeveral && b.root != VoxelPlane::kSeveral &&
           subclusters_.find(a.root) == subclusters_.find(b.root);
  }

  /// Links the voxels of two bricks: each voxel of the one that has fewer with all of the other.
  /// \param number of the other brick among those near the first
  void linkBricks(VoxelPlane& plane, VoxelPlane::Brick& brick, VoxelPlane& other, VoxelPlane::Brick& near,
                  std::size_t number) {
    if (!(BoxLanes::squaredGap(brick.box, near.box) < layout_.squared_tolerance) || haveOneRoot(brick, near)) return;
    if (isSingle(brick) && isSingle(near)) {  // their boxes are those of the bricks
      std::uint32_t& root = plane.root[brick.first_voxel];
      std::uint32_t& near_root = other.root[near.first_voxel];
      if (haveNeighbours(plane, brick.first_voxel, other, near.first_voxel))
        root = near_root = subclusters_.merge(root, near_root);
      return;
    }
    const bool has_fewer = endOf(brick) - brick.first_voxel <= endOf(near) - near.first_voxel;
    if (brick.holdsFewReturns() && near.holdsFewReturns()) {
      if (has_fewer)
        linkReturns(plane, brick, other, near);
      else
        linkReturns(other, near, plane, brick);
    } else {
      if (has_fewer)
        linkVoxels(plane, brick, other, near, number);
      else
        linkVoxels(other, near, plane, brick, kNearBricks - 1 - number);
    }
  }

  /// The same for two bricks of few returns.
  void linkReturns(VoxelPlane& plane, VoxelPlane::Brick& brick, VoxelPlane& other, VoxelPlane::Brick& near) {
    const std::uint32_t first = near.first_voxel;
    for (std::uint32_t voxel = brick.first_voxel; voxel < endOf(brick); ++voxel) {
      const std::uint64_t joined = neighboursOf(plane, voxel, other, first) & allOf(near);
      if (joined == 0) continue;
      std::uint32_t root = plane.root[voxel];
      forEachBit(joined, [&](std::size_t i) {
        root = other.root[first + i] = subclusters_.merge(root, other.root[first + i]);
      });
      plane.root[voxel] = root;
      if (haveOneRoot(brick, near)) return;
    }
  }

  /// Bit i, up to kFewReturns: single return first + i is a neighbour of another one.
  std::uint64_t neighboursOf(const VoxelPlane& plane, std::uint32_t one, const VoxelPlane& other,
                             std::uint32_t first) const {
    std::uint64_t near = 0;
    for (std::uint32_t k = 0; k < kFewReturns; k += std::uint32_t{kLanes}) {
      const auto apart = [&](std::size_t axis) {
        return hn::Sub(hn::Set(kFloats, plane.lo[axis][one]), hn::LoadU(kFloats, &other.lo[axis][first + k]));
      };
      near |= std::uint64_t{bitsOf(areNeighbours(apart(0), apart(1), apart(2), squared_tolerance_))} << k;
    }
    return near;
  }

  void linkVoxels(VoxelPlane& plane, VoxelPlane::Brick& brick, VoxelPlane& other, VoxelPlane::Brick& near,
                  std::size_t number) {
    const bool are_numbered = !brick.holdsFewReturns() && !near.holdsFewReturns();
    std::uint64_t numbers = brick.occupied;
    for (std::uint32_t voxel = brick.first_voxel; voxel < endOf(brick); ++voxel, numbers &= numbers - 1) {
      if (are_numbered && (near.occupied & layout_.around[__builtin_ctzll(numbers)][number]) == 0) continue;
      std::uint32_t root = subclusters_.find(plane.root[voxel]);
      const std::uint64_t joined = linkVoxel(plane, voxel, other, near.first_voxel, allOf(near), root);
      plane.root[voxel] = root;
      if (joined != 0 && haveOneRoot(brick, near)) return;
    }
  }

  /// Links a voxel with some of a brick. \return those of them found to be in its set
  /// \param others bit i: voxel first + i
  /// \param root of the voxel
  std::uint64_t linkVoxel(VoxelPlane& plane, std::uint32_t voxel, VoxelPlane& other, std::uint32_t first,
                          std::uint64_t others, std::uint32_t& root) {
    std::uint64_t joined = 0;
    for (std::uint32_t k = 0; k < 64 && others >> k != 0; k += std::uint32_t{kLanes}) {
      const std::uint64_t unlike = bitsOf(differ(&other.root[first + k], hn::Set(kWords, root)));
      joined |= (bitsAt(others, k) & ~unlike) << k;
      std::uint64_t left = bitsAt(others, k) & unlike & nearBoxes(plane, voxel, other, first + k);
      for (; left != 0; left &= left - 1) {
        const std::uint32_t i = k + static_cast<std::uint32_t>(__builtin_ctzll(left));
        const std::uint32_t other_root = other.root[first + i] = subclusters_.find(other.root[first + i]);
        if (other_root != root) {
          if (!haveNeighbours(plane, voxel, other, first + i)) continue;
          other.root[first + i] = root = subclusters_.merge(root, other_root);
        }
        joined |= std::uint64_t{1} << i;
      }
    }
    return joined;
  }

  /// Box::squaredGap of a voxel and some consecutive ones. \return bit i: that of voxel k + i is below the tolerance's
  std::uint32_t nearBoxes(const VoxelPlane& plane, std::size_t voxel, const VoxelPlane& other, std::size_t k) const {
    const auto gap = [&](std::size_t axis) {
      const FloatVector above =
          hn::Sub(hn::Set(kFloats, plane.lo[axis][voxel]), hn::LoadU(kFloats, &other.hi[axis][k]));
      const FloatVector below =
          hn::Sub(hn::LoadU(kFloats, &other.lo[axis][k]), hn::Set(kFloats, plane.hi[axis][voxel]));
      return hn::Max(hn::Max(above, below), hn::Zero(kFloats));
    };
    return bitsOf(areNeighbours(gap(0), gap(1), gap(2), squared_tolerance_));
  }

  static BoxLanes boxOf(const VoxelPlane& plane, std::uint32_t voxel) {
    BoxLanes box({plane.lo[0][voxel], plane.lo[1][voxel], plane.lo[2][voxel], 0});
    box.add({plane.hi[0][voxel], plane.hi[1][voxel], plane.hi[2][voxel], 0});
    return box;
  }

  static bool isGathered(const VoxelPlane& plane, std::uint32_t voxel) {
    return (plane.place[voxel] & VoxelPlane::kInItems) == 0;
  }

  /// Copies the returns of a voxel of several to plane.points.
  HWY_NOINLINE void gather(VoxelPlane& plane, std::uint32_t voxel) {
    std::size_t item = plane.place[voxel] & ~VoxelPlane::kInItems;
    const std::size_t begin = plane.points_in_use;
    const std::size_t end = begin + plane.return_count[voxel];
    const std::uint64_t number_mask = layout_.numberMask();
    plane.reservePoints(end);
    for (std::size_t to = begin; to < end; ++item) {
      const auto number = static_cast<std::size_t>(plane.items[item] & number_mask);
      const NearReturn* const from = plane.fragments->returnsOf(number);
      const std::size_t size = plane.fragments->sizeOf(number);
      for (std::size_t i = 0; i < size; i += kNearStep) std::copy_n(from + i, kNearStep, &plane.points[to + i]);
      to += size;
    }
    plane.place[voxel] = static_cast<std::uint32_t>(begin);
    plane.points_in_use = end;
  }

  /// Whether any return of one voxel is a neighbour of any return of another, whose boxes are near enough.
  bool haveNeighbours(VoxelPlane& a_plane, std::uint32_t a, VoxelPlane& b_plane, std::uint32_t b) {
    VoxelPlane* few = &a_plane;
    VoxelPlane* many = &b_plane;
    if (few->return_count[a] > many->return_count[b]) {
      std::swap(few, many);
      std::swap(a, b);
    }
    const std::size_t other_count = many->return_count[b];
    if (other_count == 1) return true;  // the boxes are the returns
    const std::size_t own_count = few->return_count[a];
    if (own_count > 1 && !isGathered(*few, a)) gather(*few, a);
    if (!isGathered(*many, b)) gather(*many, b);
    const NearReturn single{few->lo[0][a], few->lo[1][a], few->lo[2][a], 0};
    const NearReturn* const own = own_count > 1 ? few->points.data() + few->place[a] : &single;
    const NearReturn* const others = many->points.data() + many->place[b];
    if (other_count <= kLanes) {
      const Coordinates other = load(others);
      const std::uint32_t lanes = lanesBelow(other_count);
      for (std::size_t i = 0; i < own_count; ++i)
        if ((neighboursOf(own[i], other) & lanes) != 0) return true;
      return false;
    }
    const BoxLanes box = boxOf(*many, b);
    for (std::size_t i = 0; i < own_count; ++i) {
      if (!(BoxLanes::squaredGap(BoxLanes(own[i]), box) < layout_.squared_tolerance)) continue;
      for (std::size_t k = 0; k < other_count; k += kLanes)
        if ((neighboursOf(own[i], load(others + k)) & lanesBelow(other_count - k)) != 0) return true;
    }
    return false;
  }

  struct Coordinates {
    FloatVector x, y, z;
  };
  static Coordinates load(const NearReturn* returns) {
    Coordinates loaded;
    FloatVector elements;
    hn::LoadInterleaved4(kFloats, &returns->x, loaded.x, loaded.y, loaded.z, elements);
    return loaded;
  }

  /// Bit i: return i of the others is a neighbour.
  std::uint32_t neighboursOf(const NearReturn& one, const Coordinates& others) const {
    return bitsOf(areNeighbours(hn::Sub(hn::Set(kFloats, one.x), others.x), hn::Sub(hn::Set(kFloats, one.y), others.y),
                                hn::Sub(hn::Set(kFloats, one.z), others.z), squared_tolerance_));
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

}  // namespace

void linkPlane(VoxelPlane& plane, const PlaneLayout& layout, DisjointSets& subclusters) {
  HWY_DYNAMIC_DISPATCH(linkWithin)(plane, layout, subclusters);
}

void linkPlanes(VoxelPlane& plane, VoxelPlane& next, const PlaneLayout& layout, DisjointSets& subclusters) {
  HWY_DYNAMIC_DISPATCH(linkAcross)(plane, next, layout, subclusters);
}

}  // namespace lisco
#endif
