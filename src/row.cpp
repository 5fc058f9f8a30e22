// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/row.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "row.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

void measureRow(Row& row, float squared_tolerance, const FarRange& range, MeasuredRow& measured) {
  const FloatVector largest = hn::Set(kFloats, std::numeric_limits<float>::max());
  const FloatVector zero = hn::Zero(kFloats);
  const FloatVector nan = hn::Set(kFloats, std::numeric_limits<float>::quiet_NaN());
  const FloatVector infinity = hn::Set(kFloats, std::numeric_limits<float>::infinity());
  const FloatVector r2 = hn::Set(kFloats, squared_tolerance);
  measured.returns = measured.far = measured.only_far = 0;
  std::uint64_t linked = 0;
  FloatVector lowest = infinity;
  FloatVector highest = hn::Neg(infinity);
  row.x[Row::kMargin - 1] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t k = 0; k < Row::kColumns; k += kLanes) {
    float* const px = row.x + Row::kMargin + k;
    const float* const py = row.y + Row::kMargin + k;
    const float* const pz = row.z + Row::kMargin + k;
    FloatVector x = hn::LoadU(kFloats, px);
    const FloatVector y = hn::LoadU(kFloats, py);
    const FloatVector z = hn::LoadU(kFloats, pz);
    // isReturn, lane by lane
    const FloatMask finite =
        hn::And(hn::Le(hn::Abs(x), largest), hn::And(hn::Le(hn::Abs(y), largest), hn::Le(hn::Abs(z), largest)));
    const FloatMask origin = hn::And(hn::Eq(x, zero), hn::And(hn::Eq(y, zero), hn::Eq(z, zero)));
    const FloatMask returned = hn::AndNot(origin, finite);
    const std::uint64_t returns = bitsOf(returned);
    x = hn::IfThenElse(returned, x, nan);
    hn::StoreU(x, kFloats, px);
    if (returns == 0) continue;
    measured.returns |= returns << k;
    const FloatVector east = hn::Sub(x, hn::Set(kFloats, range.origin[0]));
    const FloatVector north = hn::Sub(y, hn::Set(kFloats, range.origin[1]));
    const FloatVector rho = hn::Sqrt(hn::Add(hn::Mul(east, east), hn::Mul(north, north)));
    hn::StoreU(rho, kFloats, measured.rho + k);
    const FloatMask far =
        hn::And(hn::Ge(rho, hn::Set(kFloats, range.near_end)), hn::Lt(rho, hn::Set(kFloats, range.far_end)));
    const FloatMask only_far =
        hn::And(hn::Ge(rho, hn::Set(kFloats, range.far_enough)), hn::Lt(rho, hn::Set(kFloats, range.not_too_far)));
    measured.far |= std::uint64_t{bitsOf(far)} << k;
    measured.only_far |= std::uint64_t{bitsOf(only_far)} << k;
    const FloatVector slope = hn::Div(hn::Sub(z, hn::Set(kFloats, range.origin[2])), rho);
    lowest = hn::Min(lowest, hn::IfThenElse(far, slope, infinity));
    highest = hn::Max(highest, hn::IfThenElse(far, slope, hn::Neg(infinity)));
  }
  // Not at once: what has just been stored is slow to be read at another offset.
  for (std::size_t k = 0; k < Row::kColumns; k += kLanes) {
    if ((measured.returns >> k & ((std::uint64_t{1} << kLanes) - 1)) == 0) continue;
    const auto step = [k](const float* coordinate) {
      const float* const here = coordinate + Row::kMargin + k;
      return hn::Sub(hn::LoadU(kFloats, here), hn::LoadU(kFloats, here - 1));
    };
    linked |= std::uint64_t{bitsOf(areNeighbours(step(row.x), step(row.y), step(row.z), r2))} << k;
  }
  measured.starts = measured.returns & ~linked;
  measured.lowest = hn::GetLane(hn::MinOfLanes(kFloats, lowest));
  measured.highest = hn::GetLane(hn::MaxOfLanes(kFloats, highest));
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(measureRow);

void measureRow(Row& row, std::size_t columns, float squared_tolerance, const FarRange& range, MeasuredRow& measured) {
  std::fill(row.x + Row::kMargin + columns, row.x + Row::kMargin + Row::kColumns,
            std::numeric_limits<float>::quiet_NaN());
  HWY_DYNAMIC_DISPATCH(measureRow)(row, squared_tolerance, range, measured);
}

}  // namespace lisco
#endif
