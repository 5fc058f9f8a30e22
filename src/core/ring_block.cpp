// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ring_block.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ring_block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/bits.h"
#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

HWY_INLINE FloatVector loadColumns(const float* coordinates, std::size_t k) {
  return hn::LoadU(kFloats, coordinates + RingBlock::kMargin + k);
}

/// The returns of a ring block, and which of them are linked to the return in the column before.
class RunFinder {
 public:
  RunFinder(const RingBlock& block, std::size_t columns, float squared_tolerance)
      : block_(block), columns_(columns), squared_tolerance_(hn::Set(kFloats, squared_tolerance)) {}

  /// \return the returns of the kLanes columns from k on, bit 0 for column k
  std::uint64_t find(std::size_t k) {
    const FloatVector x = loadColumns(block_.x, k);
    const FloatVector y = loadColumns(block_.y, k);
    const FloatVector z = loadColumns(block_.z, k);
    const std::uint64_t returns = bitsOf(areReturns(x, y, z)) & ~bitsFrom(columns_ - std::min(columns_, k));
    if (returns == 0) return 0;
    returns_ |= returns << k;
    const auto step = [k](FloatVector here, const float* coordinates) {
      return hn::Sub(here, hn::LoadU(kFloats, coordinates + RingBlock::kMargin + k - 1));
    };
    const FloatMask near = areNeighbours(step(x, block_.x), step(y, block_.y), step(z, block_.z), squared_tolerance_);
    near_before_ |= std::uint64_t{bitsOf(near)} << k;
    return returns;
  }

  ColumnBits returns() const { return returns_; }
  ColumnBits starts() const { return returns_ & ~(near_before_ & returns_ << 1); }

 private:
  const RingBlock& block_;
  const std::size_t columns_;
  const FloatVector squared_tolerance_;
  ColumnBits returns_ = 0;
  ColumnBits near_before_ = 0;  ///< columns within the tolerance of the one before, whether that is a return or not
};

ColumnBits findReturnsOf(const RingBlock& block, std::size_t columns) {
  ColumnBits returns = 0;
  for (std::size_t k = 0; k < columns; k += kLanes) {
    const FloatMask returned = areReturns(loadColumns(block.x, k), loadColumns(block.y, k), loadColumns(block.z, k));
    returns |= ColumnBits{bitsOf(returned)} << k;
  }
  return returns & ~bitsFrom(columns);
}

void findRunsOf(const RingBlock& block, std::size_t columns, float squared_tolerance, RingBlockInfo& info) {
  RunFinder finder(block, columns, squared_tolerance);
  for (std::size_t k = 0; k < columns; k += kLanes) finder.find(k);
  info.returns = finder.returns();
  info.starts = finder.starts();
  info.far = info.interior = 0;
}

void measureBlock(const RingBlock& block, std::size_t columns, float squared_tolerance, const FarRange& range,
                  RingBlockInfo& info) {
  const FloatVector infinity = hn::Set(kFloats, std::numeric_limits<float>::infinity());
  RunFinder finder(block, columns, squared_tolerance);
  info.far = info.interior = 0;
  FloatVector lowest = infinity;
  FloatVector highest = hn::Neg(infinity);
  for (std::size_t k = 0; k < columns; k += kLanes) {
    const std::uint64_t returns = finder.find(k);
    if (returns == 0) continue;
    const FloatVector east = hn::Sub(loadColumns(block.x, k), hn::Set(kFloats, range.origin[0]));
    const FloatVector north = hn::Sub(loadColumns(block.y, k), hn::Set(kFloats, range.origin[1]));
    const FloatVector rho = hn::Sqrt(hn::Add(hn::Mul(east, east), hn::Mul(north, north)));
    hn::StoreU(rho, kFloats, info.rho + k);
    const FloatMask returned = lanesOf(returns);
    const auto within = [&](float lo, float hi) {
      return hn::And(returned, hn::And(hn::Ge(rho, hn::Set(kFloats, lo)), hn::Lt(rho, hn::Set(kFloats, hi))));
    };
    const FloatMask far = within(range.min_range, range.max_range);
    info.far |= std::uint64_t{bitsOf(far)} << k;
    info.interior |= std::uint64_t{bitsOf(within(range.interior_min, range.interior_max))} << k;
    const FloatVector horizon =
        hn::Add(hn::Mul(east, hn::Set(kFloats, range.tilt[0])), hn::Mul(north, hn::Set(kFloats, range.tilt[1])));
    const FloatVector up = hn::Sub(loadColumns(block.z, k), hn::Set(kFloats, range.origin[2]));
    const FloatVector slope = hn::Div(hn::Sub(up, horizon), rho);
    lowest = hn::Min(lowest, hn::IfThenElse(far, slope, infinity));
    highest = hn::Max(highest, hn::IfThenElse(far, slope, hn::Neg(infinity)));
  }
  info.returns = finder.returns();
  info.starts = finder.starts();
  info.lowest = hn::GetLane(hn::MinOfLanes(kFloats, lowest));
  info.highest = hn::GetLane(hn::MaxOfLanes(kFloats, highest));
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(findReturnsOf);
HWY_EXPORT(findRunsOf);
HWY_EXPORT(measureBlock);

ColumnBits findReturns(const RingBlock& block, std::size_t columns) {
  return HWY_DYNAMIC_DISPATCH(findReturnsOf)(block, columns);
}

void findRuns(const RingBlock& block, std::size_t columns, float squared_tolerance, RingBlockInfo& info) {
  HWY_DYNAMIC_DISPATCH(findRunsOf)(block, columns, squared_tolerance, info);
}

void measure(const RingBlock& block, std::size_t columns, float squared_tolerance, const FarRange& range,
             RingBlockInfo& info) {
  HWY_DYNAMIC_DISPATCH(measureBlock)(block, columns, squared_tolerance, range, info);
}

}  // namespace lisco
#endif
