// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/kernels.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/near/kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Points of a span that may have neighbours in a box.
struct GatheredPoints {
  static constexpr std::size_t kMax = 64;
  float x[kMax], y[kMax], z[kMax];
  std::size_t count = 0;
};

/// Zero where a number is NaN or too large to be converted to an integer: vector instructions convert any number, C++
/// defines only those in range.
HWY_INLINE FloatVector convertible(FloatVector number) {
#if HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SCALAR
  return hn::IfThenElseZero(hn::Le(hn::Abs(number), hn::Set(kFloats, kMaxFloatNumber)), number);
#else
  return number;
#endif
}

bool numberReturns(const RingBlock& block, std::uint64_t which, float per_metre, VoxelNumbers& numbers,
                   std::uint64_t& changes) {
  const hn::RebindToSigned<Floats> signed_words;
  const FloatVector scale = hn::Set(kFloats, per_metre);
  FloatVector farthest = hn::Zero(kFloats);
  const float* const coordinates[3] = {block.x + RingBlock::kMargin, block.y + RingBlock::kMargin,
                                       block.z + RingBlock::kMargin};
  changes = 0;
  for (std::size_t k = 0; k < RingBlock::kColumns; k += kLanes) {
    if (bitsAt(which, k) == 0) continue;
    const FloatMask chosen = lanesOf(which >> k);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const FloatVector number = hn::Mul(hn::LoadU(kFloats, coordinates[axis] + k), scale);
      farthest = hn::Max(farthest, hn::IfThenElseZero(chosen, hn::Abs(number)));
      hn::StoreU(hn::BitCast(kWords, hn::ConvertTo(signed_words, convertible(hn::Floor(number)))), kWords,
                 numbers.of[axis] + 1 + k);
    }
  }
  // A loop of its own: a load that straddles recent stores stalls.
  for (std::size_t k = 0; k < RingBlock::kColumns; k += kLanes) {
    if (bitsAt(which, k) == 0) continue;
    const auto changed = [&](std::size_t axis) {
      return differ(numbers.of[axis] + k, hn::LoadU(kWords, numbers.of[axis] + k + 1));
    };
    changes |= std::uint64_t{bitsOf(hn::Or(changed(0), hn::Or(changed(1), changed(2))))} << k;
  }
  return hn::GetLane(hn::MaxOfLanes(kFloats, farthest)) <= kMaxFloatNumber;
}

/// Gathers the points of a clique, from one on, that may have neighbours in a box.
/// \return the first point that is left
std::size_t gather(const PointSpan& clique, std::size_t from, const Box& box, float squared_tolerance,
                   GatheredPoints& points) {
  const FloatVector r2 = hn::Set(kFloats, squared_tolerance);
  const auto gap = [](FloatVector coordinate, float lo, float hi) {
    const FloatVector outside =
        hn::Max(hn::Sub(coordinate, hn::Set(kFloats, hi)), hn::Sub(hn::Set(kFloats, lo), coordinate));
    return hn::Max(outside, hn::Zero(kFloats));
  };
  points.count = 0;
  for (; from < clique.count && points.count <= GatheredPoints::kMax - kLanes; from += kLanes) {
    const FloatVector x = hn::LoadU(kFloats, clique.x + from);
    const FloatVector y = hn::LoadU(kFloats, clique.y + from);
    const FloatVector z = hn::LoadU(kFloats, clique.z + from);
    // Box::squaredGap, lane by lane
    const FloatMask near =
        areNeighbours(gap(x, box.lo[0], box.hi[0]), gap(y, box.lo[1], box.hi[1]), gap(z, box.lo[2], box.hi[2]), r2);
    const FloatMask chosen = hn::And(near, hn::FirstN(kFloats, clique.count - from));
    // Whole vectors are stored, into room that is left: a store of chosen lanes takes far longer on a Zen 4.
    hn::StoreU(hn::Compress(x, chosen), kFloats, points.x + points.count);
    hn::StoreU(hn::Compress(y, chosen), kFloats, points.y + points.count);
    hn::StoreU(hn::Compress(z, chosen), kFloats, points.z + points.count);
    points.count += hn::CountTrue(kFloats, chosen);
  }
  return from;
}

/// Whether any two points of two lists are neighbours.
bool anyOfGathered(const GatheredPoints& a, GatheredPoints& b, FloatVector r2) {
  for (std::size_t i = b.count; i % kLanes != 0; ++i) b.x[i] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < a.count; ++i) {
    const FloatVector x = hn::Set(kFloats, a.x[i]);
    const FloatVector y = hn::Set(kFloats, a.y[i]);
    const FloatVector z = hn::Set(kFloats, a.z[i]);
    FloatMask any = hn::Lt(r2, hn::Zero(kFloats));
    for (std::size_t k = 0; k < b.count; k += kLanes)
      any = hn::Or(any, areNeighbours(hn::Sub(x, hn::LoadU(kFloats, b.x + k)), hn::Sub(y, hn::LoadU(kFloats, b.y + k)),
                                      hn::Sub(z, hn::LoadU(kFloats, b.z + k)), r2));
    if (!hn::AllFalse(kFloats, any)) return true;
  }
  return false;
}

bool compareSpans(const PointSpan& a, const Box& a_box, const PointSpan& b, const Box& b_box, float squared_tolerance) {
  GatheredPoints some_of_a;
  GatheredPoints some_of_b;
  for (std::size_t at_a = 0; at_a < a.count;) {
    at_a = gather(a, at_a, b_box, squared_tolerance, some_of_a);
    if (some_of_a.count == 0) continue;
    for (std::size_t at_b = 0; at_b < b.count;) {
      at_b = gather(b, at_b, a_box, squared_tolerance, some_of_b);
      if (anyOfGathered(some_of_a, some_of_b, hn::Set(kFloats, squared_tolerance))) return true;
    }
  }
  return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(numberReturns);
HWY_EXPORT(compareSpans);

bool numberVoxels(const RingBlock& block, std::uint64_t which, float voxels_per_metre, VoxelNumbers& numbers,
                  std::uint64_t& changes) {
  return HWY_DYNAMIC_DISPATCH(numberReturns)(block, which, voxels_per_metre, numbers, changes);
}

bool haveNeighbours(const PointSpan& a, const Box& a_box, const PointSpan& b, const Box& b_box,
                    float squared_tolerance) {
  return HWY_DYNAMIC_DISPATCH(compareSpans)(a, a_box, b, b_box, squared_tolerance);
}

}  // namespace lisco
#endif
