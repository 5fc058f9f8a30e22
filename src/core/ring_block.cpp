// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ring_block.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ring_block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

void measureBlock(RingBlock& block, float squared_tolerance, const FarRange& range, RingBlockInfo& info) {
  const FloatVector nan = hn::Set(kFloats, std::numeric_limits<float>::quiet_NaN());
  const FloatVector infinity = hn::Set(kFloats, std::numeric_limits<float>::infinity());
  const FloatVector r2 = hn::Set(kFloats, squared_tolerance);
  info.returns = info.far = info.interior = 0;
  std::uint64_t linked = 0;
  FloatVector lowest = infinity;
  FloatVector highest = hn::Neg(infinity);
  block.x[RingBlock::kMargin - 1] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t k = 0; k < RingBlock::kColumns; k += kLanes) {
    float* const px = block.x + RingBlock::kMargin + k;
    const float* const py = block.y + RingBlock::kMargin + k;
    const float* const pz = block.z + RingBlock::kMargin + k;
    FloatVector x = hn::LoadU(kFloats, px);
    const FloatVector y = hn::LoadU(kFloats, py);
    const FloatVector z = hn::LoadU(kFloats, pz);
    const FloatMask returned = areReturns(x, y, z);
    const std::uint64_t returns = bitsOf(returned);
    x = hn::IfThenElse(returned, x, nan);
    hn::StoreU(x, kFloats, px);
    if (returns == 0) continue;
    info.returns |= returns << k;
    const FloatVector east = hn::Sub(x, hn::Set(kFloats, range.origin[0]));
    const FloatVector north = hn::Sub(y, hn::Set(kFloats, range.origin[1]));
    const FloatVector rho = hn::Sqrt(hn::Add(hn::Mul(east, east), hn::Mul(north, north)));
    hn::StoreU(rho, kFloats, info.rho + k);
    const FloatMask far =
        hn::And(hn::Ge(rho, hn::Set(kFloats, range.min_range)), hn::Lt(rho, hn::Set(kFloats, range.max_range)));
    const FloatMask interior =
        hn::And(hn::Ge(rho, hn::Set(kFloats, range.interior_min)), hn::Lt(rho, hn::Set(kFloats, range.interior_max)));
    info.far |= std::uint64_t{bitsOf(far)} << k;
    info.interior |= std::uint64_t{bitsOf(interior)} << k;
    const FloatVector horizon =
        hn::Add(hn::Mul(east, hn::Set(kFloats, range.tilt[0])), hn::Mul(north, hn::Set(kFloats, range.tilt[1])));
    const FloatVector slope = hn::Div(hn::Sub(hn::Sub(z, hn::Set(kFloats, range.origin[2])), horizon), rho);
    lowest = hn::Min(lowest, hn::IfThenElse(far, slope, infinity));
    highest = hn::Max(highest, hn::IfThenElse(far, slope, hn::Neg(infinity)));
  }
  // A loop of its own: a load that straddles recent stores stalls.
  for (std::size_t k = 0; k < RingBlock::kColumns; k += kLanes) {
    if (bitsAt(info.returns, k) == 0) continue;
    const auto step = [k](const float* coordinate) {
      const float* const here = coordinate + RingBlock::kMargin + k;
      return hn::Sub(hn::LoadU(kFloats, here), hn::LoadU(kFloats, here - 1));
    };
    linked |= std::uint64_t{bitsOf(areNeighbours(step(block.x), step(block.y), step(block.z), r2))} << k;
  }
  info.starts = info.returns & ~linked;
  info.lowest = hn::GetLane(hn::MinOfLanes(kFloats, lowest));
  info.highest = hn::GetLane(hn::MaxOfLanes(kFloats, highest));
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(measureBlock);

void measure(RingBlock& block, std::size_t columns, float squared_tolerance, const FarRange& range,
             RingBlockInfo& info) {
  std::fill(block.x + RingBlock::kMargin + columns, block.x + RingBlock::kMargin + RingBlock::kColumns,
            std::numeric_limits<float>::quiet_NaN());
  HWY_DYNAMIC_DISPATCH(measureBlock)(block, squared_tolerance, range, info);
}

}  // namespace lisco
#endif
