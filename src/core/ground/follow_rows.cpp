// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/follow_rows.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/follow_rows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using ground::Block;
using ground::FollowResult;
using ground::FollowSetting;
using ground::Found;
using ground::GroundMap;
using ground::Passed;
using ground::RowOrder;

using LaneFloats = hn::CappedTag<float, Block::kColumns>;
using LaneInts = hn::RebindToSigned<LaneFloats>;
using Floats = hn::Vec<LaneFloats>;
using Mask = hn::Mask<LaneFloats>;
constexpr LaneFloats kLanes{};
constexpr LaneInts kLaneInts{};

// Distances and heights are metres, slopes metres per metre.

// What is above a return.
constexpr float kWallWidth = 0.05F, kWallGrowth = 0.003F;  // by which returns of an upright surface differ in distance
constexpr float kMostAbove = 3.0F;                         // what is higher hangs over
constexpr float kSteep = 0.6F;                             // slope of a surface that is no ground
constexpr float kSurfaceStep = 0.2F, kSurfaceGrowth = 0.04F;  // returns of one surface are nearer to each other
constexpr float kLineStep = 0.3F, kLineSpan = 2.0F;           // least lengths of a line of three returns
constexpr float kStraight = 0.04F;                            // by which the slopes along a line differ

// The ground known from the blocks before.
constexpr float kKnown = 1.5F;        // most slack of what may contradict
constexpr float kWellKnown = 0.15F;   // most slack of what decides
constexpr float kNearlyKnown = 0.5F;  // most slack of what decides where the ground seems to go on
constexpr float kAtMap = 0.08F, kMostSlack = 0.03F, kLevelAtMap = 0.05F;
constexpr float kSure = 0.05F;         // slack and height, even where a surface rises
constexpr float kFoot = 0.03F;         // height, even at the foot of a wall
constexpr float kAboveMap = 0.25F;     // contradicts
constexpr float kKnownHeight = 0.06F;  // even among returns of which most are higher

// The ground of the same column.
constexpr float kAtColumn = 0.07F, kAtColumnGrowth = 0.03F, kAtColumnMost = 0.15F;
constexpr float kLevel = 0.15F, kLevelGrowth = 0.06F, kLevelMost = 0.8F, kSameSlope = 0.15F;
constexpr float kFirst = 0.1F, kFirstGrowth = 0.04F, kFirstLevelGrowth = 0.12F, kFirstMost = 10.0F;
constexpr float kFirstHighest = 0.2F, kFirstHighestGrowth = 0.3F;
constexpr float kBend = 0.1F, kBendGrowth = 0.1F, kLineBend = 0.2F, kLineKnown = 0.3F;
constexpr float kStepDown = 0.15F, kStepUp = 0.15F;
constexpr float kAgrees = 0.1F, kAgreesGrowth = 0.03F;
constexpr float kObstacle = 0.3F;
constexpr float kHigher = 0.1F;
constexpr float kReflection = 0.5F;     // below the ground
constexpr float kReflectedFrom = 1.0F;  // below the highest possible ground
constexpr float kNearBelow = 0.1F;
constexpr float kRough = 0.15F, kRoughGrowth = 0.04F;  // of the distances of columns beside each other
constexpr float kSameRay = 0.003F;                     // difference of the slopes of rays
constexpr float kAdvance = 0.02F;
constexpr float kBaseline = 1.5F, kBaselineGrowth = 0.1F, kLeastBaseline = 0.3F;

HWY_INLINE Floats set(float value) {
  return hn::Set(kLanes, value);
}

HWY_INLINE Floats select(Mask mask, Floats yes, Floats no) {
  return hn::IfThenElse(mask, yes, no);
}

/// A row, and those around it.
struct FollowedRow {
  const float* rho;
  const float* height;
  const float* up_rho;  ///< of the row above; zeros if there is none
  const float* up_height;
  const float* above_rho;  ///< of a row clearly above
  const float* above_height;
  const GroundMap::Sector* sector;
  const Passed* before;  ///< of the rows below
  Passed* passed;
  ground::Followed* followed;
};

/// base + growth * distance
HWY_INLINE Floats grown(float base, float growth, Floats distance) {
  return hn::Add(set(base), hn::Mul(set(growth), distance));
}

/// The values of the columns before: the one after, for the first column of the block.
HWY_INLINE Floats leftOf(const float* row, std::size_t k, Floats values) {
  if (k != 0) return hn::LoadU(kLanes, row + k - 1);
  if (hn::MaxLanes(kLanes) == 1) return hn::LoadU(kLanes, row + 1);
  const auto left = hn::Sub(hn::Iota(kLaneInts, 0), hn::Set(kLaneInts, 1));
  return hn::TableLookupLanes(values, hn::IndicesFromVec(kLanes, hn::Abs(left)));
}

/// The values of the columns after: the one before, for the last column of the block.
HWY_INLINE Floats rightOf(const float* row, std::size_t k, Floats values) {
  constexpr auto kStep = hn::MaxLanes(kLanes);
  if (k + kStep != Block::kColumns) return hn::LoadU(kLanes, row + k + 1);
  if (kStep == 1) return hn::LoadU(kLanes, row + k - 1);
  const auto last = hn::Set(kLaneInts, static_cast<std::int32_t>(kStep) - 1);
  const auto right = hn::Add(hn::Iota(kLaneInts, 0), hn::Set(kLaneInts, 1));
  const auto inside = hn::Sub(last, hn::Abs(hn::Sub(right, last)));
  return hn::TableLookupLanes(values, hn::IndicesFromVec(kLanes, inside));
}

/// What the rows above show about the returns of a row.
struct Above {
  Mask wall;           ///< upright above the return
  Mask steep;          ///< too steep for ground
  Mask surface;        ///< a rising surface that begins at the return
  Mask seen;           ///< there is a return beyond
  Mask nearer;         ///< there is a return that is nearer
  Floats slope, step;  ///< to it
  Mask line;           ///< two returns beyond, on a line with this one
  Floats line_slope;
};

HWY_INLINE Above lookUp(const FollowedRow& row, std::size_t k, Floats rho, Floats height, Floats max_slope) {
  const auto least = set(Block::kMinRho);
  const auto wall_width = grown(kWallWidth, kWallGrowth, rho);
  const auto up_rho = hn::LoadU(kLanes, row.up_rho + k);
  const auto up_height = hn::LoadU(kLanes, row.up_height + k);
  const auto above_rho = hn::LoadU(kLanes, row.above_rho + k);
  const auto above_height = hn::LoadU(kLanes, row.above_height + k);
  const auto is_up = hn::Gt(up_rho, least), is_above = hn::Gt(above_rho, least);
  const auto up_step = hn::Sub(up_rho, rho), above_step = hn::Sub(above_rho, rho);
  const auto up_rise = hn::Sub(up_height, height), above_rise = hn::Sub(above_height, height);
  const auto isWall = [&](Mask is, Floats step, Floats rise) {
    return hn::And(hn::And(is, hn::And(hn::Gt(rise, set(0.05F)), hn::Lt(rise, set(kMostAbove)))),
                   hn::Lt(hn::Abs(step), wall_width));
  };
  const auto isSteep = [&](Mask is, Floats step, Floats rise) {
    return hn::And(hn::And(is, hn::And(hn::Gt(rise, set(0.1F)), hn::Lt(rise, set(kMostAbove)))),
                   hn::And(hn::Gt(step, set(-0.2F)), hn::Gt(rise, hn::Mul(set(kSteep), step))));
  };
  Above above;
  above.wall = hn::Or(isWall(is_up, up_step, up_rise), isWall(is_above, above_step, above_rise));
  above.steep = hn::Or(isSteep(is_up, up_step, up_rise), isSteep(is_above, above_step, above_rise));

  const auto up_slope = hn::Div(up_rise, hn::Max(up_step, set(0.05F)));
  const auto above_slope = hn::Div(above_rise, hn::Max(above_step, set(0.05F)));
  const auto sees_up = hn::And(is_up, hn::Gt(up_step, set(0.1F)));
  const auto sees_above = hn::And(is_above, hn::Gt(above_step, set(-0.1F)));
  above.seen = hn::Or(sees_up, sees_above);
  above.nearer = hn::Or(hn::And(is_up, hn::Lt(up_step, set(-0.1F))), hn::And(is_above, hn::Lt(above_step, set(-0.1F))));
  above.slope = select(sees_above, above_slope, up_slope);
  above.step = select(sees_above, above_step, up_step);

  const auto nearest = hn::Min(select(hn::And(is_up, hn::Gt(up_step, set(-0.2F))), up_step, set(1e9F)),
                               select(hn::And(is_above, hn::Gt(above_step, set(-0.2F))), above_step, set(1e9F)));
  const auto rises = hn::Or(above.steep, hn::And(above.seen, hn::Gt(above.slope, max_slope)));
  above.surface = hn::And(rises, hn::Lt(nearest, grown(kSurfaceStep, kSurfaceGrowth, rho)));

  const auto further = hn::Sub(above_rho, up_rho);
  const auto further_slope = hn::Div(hn::Sub(above_height, up_height), hn::Max(further, set(kLineStep)));
  above.line_slope = up_slope;
  above.line = hn::And(
      hn::And(hn::And(is_up, is_above), hn::And(hn::Gt(up_step, set(kLineStep)), hn::Gt(further, set(kLineStep)))),
      hn::And(hn::And(hn::Lt(hn::Abs(up_slope), max_slope), hn::Gt(above_step, set(kLineSpan))),
              hn::Lt(hn::Abs(hn::Sub(further_slope, up_slope)), set(kStraight))));
  return above;
}

/// Whether the same laser's returns in the columns beside are at other distances, as those of leaves are.
HWY_INLINE Mask isRough(const FollowedRow& row, std::size_t k, Floats rho, Floats height) {
  const auto most = grown(kRough, kRoughGrowth, rho);
  Mask seen = hn::Lt(rho, hn::Zero(kLanes)), near = seen;  // none
  const auto look = [&](Floats beside_rho, Floats beside_height) {
    const auto turned = hn::Abs(hn::Sub(hn::Mul(beside_height, rho), hn::Mul(height, beside_rho)));
    const auto same_ray = hn::Lt(turned, hn::Mul(set(kSameRay), hn::Mul(rho, beside_rho)));
    seen = hn::Or(seen, same_ray);
    near = hn::Or(near, hn::And(same_ray, hn::Lt(hn::Abs(hn::Sub(beside_rho, rho)), most)));
  };
  look(leftOf(row.rho, k, rho), leftOf(row.height, k, height));
  look(rightOf(row.rho, k, rho), rightOf(row.height, k, height));
  return hn::AndNot(near, seen);
}

/// The ground that the map has where a return is.
struct Mapped {
  Floats slope, slack;
  Floats above;  ///< height of the return above it
};

HWY_INLINE Mapped lookDown(const GroundMap::Sector& sector, Floats rho, Floats height, Mask valid) {
  const auto exponent = hn::ShiftRight<GroundMap::kBinShift>(hn::BitCast(kLaneInts, hn::Mul(rho, rho)));
  auto bin = hn::Sub(exponent, hn::Set(kLaneInts, GroundMap::kFirstBin));
  bin = hn::Min(hn::Max(bin, hn::Zero(kLaneInts)), hn::Set(kLaneInts, static_cast<std::int32_t>(GroundMap::kBins) - 1));
  // Mostly all returns are in one bin.
  const auto farthest = hn::MaxOfLanes(kLaneInts, hn::IfThenElseZero(hn::RebindMask(kLaneInts, valid), bin));
  Floats offset;
  Mapped mapped;
  if (hn::AllFalse(kLanes, hn::And(valid, hn::RebindMask(kLanes, hn::Ne(bin, farthest))))) {
    const auto at = static_cast<std::size_t>(hn::GetLane(farthest));
    offset = set(sector.offset[at]);
    mapped.slope = set(sector.slope[at]);
    mapped.slack = set(sector.slack[at]);
  } else {
    offset = hn::GatherIndex(kLanes, sector.offset.data(), bin);
    mapped.slope = hn::GatherIndex(kLanes, sector.slope.data(), bin);
    mapped.slack = hn::GatherIndex(kLanes, sector.slack.data(), bin);
  }
  mapped.above = hn::Sub(hn::Sub(height, offset), hn::Mul(mapped.slope, rho));
  return mapped;
}

/// Returns of a row, as seen from the ground that the rows below have shown in their columns.
struct Column {
  Floats rho, height;
  Mask valid;
  Mask first;            ///< no ground has been reached yet
  Floats slope;          ///< of the ground reached
  Floats way, distance;  ///< from the ground reached to the return, and not less than 0
  Floats from_ground;    ///< height of the return above the ground reached
  Floats above;          ///< and above its straight continuation
  Floats climb, limit;   ///< height by which the steepest ground rises up to there, and its highest height there
};

HWY_INLINE Column columnOf(const FollowedRow& row, std::size_t k, Floats steepest) {
  const ground::Followed& before = *row.before->followed;
  const auto load = [k](const ground::Lanes& lanes) { return hn::LoadU(kLanes, lanes.data() + k); };
  Column column;
  column.rho = hn::LoadU(kLanes, row.rho + k);
  column.height = hn::LoadU(kLanes, row.height + k);
  column.valid = hn::Gt(column.rho, set(Block::kMinRho));
  const auto ground_rho = load(before.rho);
  column.first = hn::Eq(ground_rho, hn::Zero(kLanes));
  column.slope = load(before.slope);
  column.way = hn::Sub(column.rho, ground_rho);
  column.distance = hn::Max(column.way, hn::Zero(kLanes));
  const auto baseline = select(column.first, column.rho, hn::Sub(ground_rho, load(before.back_rho)));
  const auto straight_on = hn::Min(column.distance, hn::Add(baseline, baseline));
  column.from_ground = hn::Sub(column.height, load(before.height));
  column.above = hn::Sub(column.from_ground, hn::Mul(column.slope, straight_on));
  column.climb = hn::Mul(steepest, column.rho);
  column.limit = hn::Add(load(row.before->limit), column.climb);
  return column;
}

/// Returns that are too high for ground, whatever the rows above show: it cannot rise so steeply from lower and nearer
/// returns.
HWY_INLINE Mask areTooHigh(const Column& column) {
  return hn::AndNot(hn::Lt(column.above, set(-kNearBelow)), hn::Gt(column.height, hn::Add(column.limit, set(kStepUp))));
}

/// Likewise: the map has the ground clearly lower.
HWY_INLINE Mask areAboveMap(const Mapped& map) {
  return hn::And(hn::Le(map.slack, set(kLineKnown)), hn::Ge(map.above, hn::Add(set(kAboveMap), map.slack)));
}

/// Returns on the ground, whatever the rows above show: both the map and the column have it there.
HWY_INLINE Mask areWhereExpected(const Column& column, const Mapped& map) {
  const auto on_map = hn::And(hn::Lt(map.slack, set(kSure)), hn::Lt(hn::Abs(map.above), set(kFoot)));
  return hn::And(on_map, hn::Lt(hn::Abs(column.above), set(kSure)));
}

/// Lowers the highest possible ground to that of the steepest slope from these returns on, but for reflections.
HWY_INLINE void lowerLimit(const FollowedRow& row, std::size_t k, const Column& column, Mask found) {
  const auto is_reflection = hn::And(hn::Lt(column.height, hn::Sub(column.limit, set(kReflectedFrom))),
                                     hn::Lt(column.above, set(-kReflection)));
  const auto limits = hn::And(column.valid, hn::Or(found, hn::Not(is_reflection)));
  const auto limit = hn::LoadU(kLanes, row.before->limit.data() + k);
  const auto lower = hn::Min(limit, hn::Sub(column.height, column.climb));
  hn::StoreU(select(limits, lower, limit), kLanes, row.passed->limit.data() + k);
}

/// Whether the rows above show an object, or the ground further inwards does.
HWY_INLINE Mask rises(const Column& column, const Above& above) {
  return hn::Or(hn::Or(above.wall, above.steep), hn::AndNot(column.first, hn::Gt(column.above, set(kObstacle))));
}

/// Moves the ground reached to the returns of `reached`.
HWY_INLINE void advance(const FollowedRow& row, std::size_t k, Mask reached, Floats rho, Floats height,
                        Floats max_slope) {
  const ground::Followed& before = *row.before->followed;
  ground::Followed& now = *row.followed;
  const auto load = [k](const ground::Lanes& lanes) { return hn::LoadU(kLanes, lanes.data() + k); };
  const auto store = [k](Floats value, ground::Lanes& lanes) { hn::StoreU(value, kLanes, lanes.data() + k); };
  auto back_rho = load(before.back_rho), back_height = load(before.back_height);
  auto next_rho = load(before.next_rho), next_height = load(before.next_height);
  const auto far = hn::And(reached, hn::Ge(hn::Sub(rho, next_rho), grown(kBaseline, kBaselineGrowth, rho)));
  back_rho = select(far, next_rho, back_rho);
  back_height = select(far, next_height, back_height);
  next_rho = select(far, rho, next_rho);
  next_height = select(far, height, next_height);
  const auto way = hn::Sub(rho, back_rho);
  auto slope = hn::Div(hn::Sub(height, back_height), hn::Max(way, set(kLeastBaseline)));
  slope = hn::Min(hn::Max(slope, hn::Neg(max_slope)), max_slope);
  slope = select(hn::And(reached, hn::Gt(way, set(kLeastBaseline))), slope, load(before.slope));
  store(select(reached, rho, load(before.rho)), now.rho);
  store(select(reached, height, load(before.height)), now.height);
  store(slope, now.slope);
  store(back_rho, now.back_rho);
  store(back_height, now.back_height);
  store(next_rho, now.next_rho);
  store(next_height, now.next_height);
}

HWY_INLINE std::uint8_t bitsOf(Mask mask, std::size_t k) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(kLanes, mask, bits);
  return static_cast<std::uint8_t>(bits[0] << k);
}

HWY_INLINE Mask lanesOf(std::uint8_t bits, std::size_t k) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits >> k)};
  return hn::LoadMaskBits(kLanes, bytes);
}

/// What is found of a part of a row without ground.
HWY_INLINE Found passObjects(const FollowedRow& row, std::size_t k, const Column& column, Floats steepest) {
  const auto over = hn::AndNot(column.first, hn::Gt(column.above, set(kObstacle)));
  auto object = over;
  if (!hn::AllTrue(kLanes, hn::Or(over, hn::Not(column.valid))))
    object = rises(column, lookUp(row, k, column.rho, column.height, steepest));
  row.passed->obstacles |= bitsOf(hn::And(object, column.valid), k);
  lowerLimit(row, k, column, hn::Lt(column.rho, hn::Zero(kLanes)));
  const auto higher = hn::And(column.valid, hn::Gt(column.above, set(kHigher)));
  return {0, 0, 0, 0, bitsOf(higher, k), false};
}

/// What is found of a part of a row, all of whose returns are on the ground.
HWY_INLINE Found passGround(const FollowedRow& row, std::size_t k, const Column& column, Floats steepest) {
  const auto reached = hn::And(column.valid, hn::Ge(column.way, set(kAdvance)));
  lowerLimit(row, k, column, column.valid);
  advance(row, k, reached, column.rho, column.height, steepest);
  const std::uint8_t ground = bitsOf(column.valid, k), reached_bits = bitsOf(reached, k);
  row.passed->obstacles = static_cast<std::uint8_t>(row.passed->obstacles & ~reached_bits);
  return {ground, reached_bits, ground, ground, 0, false};
}

HWY_INLINE Found followPart(const FollowedRow& row, std::size_t k, const Column& column, const Mapped& map,
                            Floats steepest) {
  const auto zero = hn::Zero(kLanes);
  const auto rho = column.rho, height = column.height, slope = column.slope, distance = column.distance;
  const auto valid = column.valid, first = column.first;
  const Above above = lookUp(row, k, rho, height, steepest);
  const auto off_map = hn::Abs(map.above), slack = map.slack;
  const auto fits_map = hn::Lt(map.above, hn::Add(set(kAboveMap), slack));
  const auto allowed = hn::Or(hn::Ge(slack, set(kKnown)), fits_map);
  const auto obstacle = lanesOf(row.before->obstacles, k);
  const auto off_column = hn::Abs(column.above);
  const auto near = hn::Min(distance, set(kFirstMost));

  // Does the ground seem to go on beyond?
  const auto unseen = hn::Not(above.seen);
  const auto goesOn = [&](Floats along) {
    return hn::Or(unseen, hn::Lt(hn::Abs(hn::Sub(above.slope, along)), set(kSameSlope)));
  };
  const auto flat = hn::AndNot(above.steep, hn::Or(unseen, hn::Lt(hn::Abs(above.slope), steepest)));

  // At the height of the map.
  const auto agrees = hn::Lt(off_column, grown(kAgrees, kAgreesGrowth, distance));
  const auto sure = hn::And(hn::Lt(slack, set(kSure)), hn::Lt(off_map, set(kSure)));
  const auto clear = hn::Or(hn::Or(hn::Not(above.surface), agrees), sure);
  auto found = hn::And(hn::And(hn::Lt(slack, set(kWellKnown)), clear),
                       hn::Lt(off_map, hn::Add(set(kAtMap), hn::Min(slack, set(kMostSlack)))));
  found = hn::Or(found, hn::And(hn::And(hn::Lt(slack, set(kNearlyKnown)), hn::And(flat, goesOn(map.slope))),
                                hn::Lt(off_map, hn::Add(set(kLevelAtMap), slack))));

  // At the height of the column's ground.
  const auto at_column =
      select(first, grown(kFirst, kFirstGrowth, near),
             hn::Add(set(kAtColumn), hn::Min(hn::Mul(set(kAtColumnGrowth), distance), set(kAtColumnMost))));
  auto continued = hn::Lt(off_column, at_column);
  const auto level = select(first, grown(kFirst, kFirstLevelGrowth, near),
                            hn::Add(set(kLevel), hn::Min(hn::Mul(set(kLevelGrowth), distance), set(kLevelMost))));
  const auto flat_free = hn::AndNot(obstacle, flat);
  continued = hn::Or(continued, hn::And(hn::And(flat_free, goesOn(slope)), hn::Lt(off_column, level)));
  // Where the ground changes its slope: beyond, it has that slope.
  const auto here = hn::Div(column.from_ground, hn::Max(column.way, set(0.5F)));
  const auto possible = hn::AndNot(first, hn::Lt(hn::Abs(here), steepest));
  const auto bend = hn::Add(set(kBend), hn::Div(set(kBendGrowth), hn::Max(above.step, set(0.5F))));
  continued = hn::Or(continued, hn::And(hn::And(hn::And(flat_free, above.seen), possible),
                                        hn::Lt(hn::Abs(hn::Sub(above.slope, here)), bend)));
  // Downwards, where no object can be.
  const auto lowest = hn::Sub(set(-kStepDown), hn::Mul(steepest, distance));
  continued = hn::Or(continued, hn::And(hn::And(hn::AndNot(above.nearer, flat), hn::Lt(column.above, zero)),
                                        hn::Gt(column.from_ground, lowest)));
  found = hn::Or(found, hn::And(continued, allowed));
  // Beyond objects.
  const auto on_line =
      hn::And(hn::And(above.line, possible), hn::Lt(hn::Abs(hn::Sub(above.line_slope, here)), set(kLineBend)));
  found = hn::Or(found, hn::And(on_line, hn::Or(hn::Gt(slack, set(kLineKnown)), fits_map)));

  // No ground is above what is lower and nearer by more than the steepest slope allows.
  found = hn::And(found, hn::And(valid, hn::Le(height, hn::Add(column.limit, set(kStepUp)))));
  lowerLimit(row, k, column, found);
  found = hn::AndNot(hn::And(first, hn::Gt(column.above, grown(kFirstHighest, kFirstHighestGrowth, distance))), found);
  const auto foot =
      hn::And(hn::And(hn::Lt(slack, set(kSure)), hn::Lt(off_map, set(kFoot))), hn::Lt(off_column, set(kSure)));
  found = hn::AndNot(hn::AndNot(foot, above.wall), found);
  found = hn::AndNot(hn::And(isRough(row, k, rho, height), hn::Not(hn::And(sure, agrees))), found);
  const auto reached = hn::And(found, hn::Ge(column.way, set(kAdvance)));
  const auto confirmed = hn::Lt(off_column, grown(kLevel, kLevelGrowth, distance));

  const auto object = hn::And(hn::AndNot(found, rises(column, above)), valid);
  const auto below = hn::And(
      hn::And(hn::Lt(column.above, set(-kNearBelow)), hn::Gt(column.above, set(-kReflection))),
      hn::And(hn::AndNot(hn::Or(found, object), valid), hn::Or(hn::Ge(slack, set(kKnown)), hn::Lt(map.above, zero))));
  advance(row, k, reached, rho, height, steepest);
  const auto known = hn::And(hn::Lt(slack, set(kWellKnown)), hn::Lt(off_map, set(kKnownHeight)));
  const auto higher = hn::And(hn::AndNot(found, valid), hn::Gt(column.above, set(kHigher)));
  const std::uint8_t reached_bits = bitsOf(reached, k);
  row.passed->obstacles = static_cast<std::uint8_t>((row.passed->obstacles & ~reached_bits) | bitsOf(object, k));
  return {bitsOf(hn::Or(found, below), k), reached_bits, bitsOf(confirmed, k), bitsOf(known, k), bitsOf(higher, k),
          false};
}

HWY_INLINE void add(const Found& part, Found& found) {
  found.ground = static_cast<std::uint8_t>(found.ground | part.ground);
  found.reached = static_cast<std::uint8_t>(found.reached | part.reached);
  found.confirmed = static_cast<std::uint8_t>(found.confirmed | part.confirmed);
  found.known = static_cast<std::uint8_t>(found.known | part.known);
  found.higher = static_cast<std::uint8_t>(found.higher | part.higher);
}

HWY_INLINE Found followRow(const FollowedRow& row, Floats steepest) {
  constexpr std::size_t kStep = hn::MaxLanes(kLanes), kParts = Block::kColumns / kStep;
  Found found{};
  const Passed& before = *row.before;
  Passed& passed = *row.passed;
  passed.followed = before.followed;
  passed.obstacles = before.obstacles;
  Column columns[kParts];
  Mapped maps[kParts];
  bool are_objects = true;
  for (std::size_t i = 0; i < kParts; ++i) {
    const Column column = columns[i] = columnOf(row, i * kStep, steepest);
    hn::StoreU(hn::Max(hn::LoadU(kLanes, before.reach.data() + i * kStep), column.rho), kLanes,
               passed.reach.data() + i * kStep);
    are_objects = are_objects && hn::AllFalse(kLanes, hn::AndNot(areTooHigh(column), column.valid));
  }
  bool are_ground = false;
  if (!are_objects) {
    are_objects = are_ground = true;
    for (std::size_t i = 0; i < kParts; ++i) {
      const Column& column = columns[i];
      const Mapped map = maps[i] = lookDown(*row.sector, column.rho, column.height, column.valid);
      const auto too_high = areTooHigh(column);
      are_objects = are_objects && hn::AllFalse(kLanes, hn::AndNot(hn::Or(too_high, areAboveMap(map)), column.valid));
      are_ground = are_ground &&
                   hn::AllFalse(kLanes, hn::AndNot(hn::AndNot(too_high, areWhereExpected(column, map)), column.valid));
    }
  }
  if (!are_objects) passed.followed = row.followed;
  for (std::size_t i = 0; i < kParts; ++i) {
    const std::size_t k = i * kStep;
    add(are_objects  ? passObjects(row, k, columns[i], steepest)
        : are_ground ? passGround(row, k, columns[i], steepest)
                     : followPart(row, k, columns[i], maps[i], steepest),
        found);
  }
  return found;
}

void followRows(const FollowSetting& setting, const FollowResult& result) {
  const auto steepest = set(setting.max_slope);
  const Block& block = *setting.block;
  const auto cellsOf = [&](const std::vector<float>& values, std::int32_t at) {
    const std::size_t row = at == RowOrder::kNone ? block.noRow() : static_cast<std::size_t>(setting.rows[at].row);
    return values.data() + row * Block::kColumns;
  };
  for (std::size_t i = 0; i < setting.size; ++i) {
    const RowOrder::Row& row = setting.rows[i];
    const auto at = static_cast<std::int32_t>(i);
    const Passed& before = row.down == RowOrder::kNone ? setting.starts[i] : result.passed[row.down];
    if (block.returns[static_cast<std::size_t>(row.row)] == 0) {
      result.passed[i] = before;
      result.found[i] = {};
      continue;
    }
    const FollowedRow followed{cellsOf(block.rho, at),        cellsOf(block.height, at),
                               cellsOf(block.rho, row.up),    cellsOf(block.height, row.up),
                               cellsOf(block.rho, row.above), cellsOf(block.height, row.above),
                               setting.map[i],                &before,
                               &result.passed[i],             &result.followed[i]};
    result.found[i] = followRow(followed, steepest);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(followRows);

void ground::followRows(const FollowSetting& setting, const FollowResult& result) {
  HWY_DYNAMIC_DISPATCH(followRows)(setting, result);
}

}  // namespace lisco
#endif
