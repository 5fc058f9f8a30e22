// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/follower.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/follower.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using ground::Block;
using ground::Follower;
using ground::Found;
using ground::GroundMap;

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

inline Floats set(float value) {
  return hn::Set(kLanes, value);
}

inline Floats select(Mask mask, Floats yes, Floats no) {
  return hn::IfThenElse(mask, yes, no);
}

/// base + growth * distance
inline Floats grown(float base, float growth, Floats distance) {
  return hn::Add(set(base), hn::Mul(set(growth), distance));
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

inline Above lookUp(const Follower::Row& row, std::size_t k, Floats rho, Floats height, Floats max_slope) {
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
inline Mask isRough(const Follower::Row& row, std::size_t k, Floats rho, Floats height) {
  const auto position = hn::Add(hn::Iota(kLaneInts, 0), hn::Set(kLaneInts, static_cast<std::int32_t>(k)));
  const auto left = hn::Sub(position, hn::Set(kLaneInts, 1)), right = hn::Add(position, hn::Set(kLaneInts, 1));
  const auto last = hn::Set(kLaneInts, static_cast<std::int32_t>(Block::kColumns) - 1);
  const auto most = grown(kRough, kRoughGrowth, rho);
  Mask seen = hn::Lt(rho, hn::Zero(kLanes)), near = seen;  // none
  for (const auto beside : {hn::IfThenElse(hn::Lt(left, hn::Zero(kLaneInts)), right, left),
                            hn::IfThenElse(hn::Gt(right, last), left, right)}) {
    const auto beside_rho = hn::GatherIndex(kLanes, row.rho, beside);
    const auto beside_height = hn::GatherIndex(kLanes, row.height, beside);
    const auto turned = hn::Abs(hn::Sub(hn::Mul(beside_height, rho), hn::Mul(height, beside_rho)));
    const auto same_ray = hn::Lt(turned, hn::Mul(set(kSameRay), hn::Mul(rho, beside_rho)));
    seen = hn::Or(seen, same_ray);
    near = hn::Or(near, hn::And(same_ray, hn::Lt(hn::Abs(hn::Sub(beside_rho, rho)), most)));
  }
  return hn::AndNot(near, seen);
}

/// Moves the ground reached to the returns of `reached`.
inline void advance(const Follower::Row& row, std::size_t k, Mask reached, Floats rho, Floats height,
                    Floats max_slope) {
  const ground::Followed& before = *row.before;
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

inline unsigned bitsOf(Mask mask, std::size_t k) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(kLanes, mask, bits);
  return static_cast<unsigned>(bits[0]) << k;
}

Found followLanes(const Follower::Row& row, std::size_t k, Floats steepest) {
  const auto rho = hn::LoadU(kLanes, row.rho + k);
  const auto height = hn::LoadU(kLanes, row.height + k);
  const auto valid = hn::Gt(rho, set(Block::kMinRho));
  const auto zero = hn::Zero(kLanes);
  const Above above = lookUp(row, k, rho, height, steepest);

  // The ground that the map has here.
  const auto exponent = hn::ShiftRight<GroundMap::kBinShift>(hn::BitCast(kLaneInts, hn::Mul(rho, rho)));
  auto bin = hn::Sub(exponent, hn::Set(kLaneInts, GroundMap::kFirstBin));
  bin = hn::Min(hn::Max(bin, hn::Zero(kLaneInts)), hn::Set(kLaneInts, static_cast<std::int32_t>(GroundMap::kBins) - 1));
  const auto offset = hn::GatherIndex(kLanes, row.sector->offset.data(), bin);
  const auto map_slope = hn::GatherIndex(kLanes, row.sector->slope.data(), bin);
  const auto slack = hn::GatherIndex(kLanes, row.sector->slack.data(), bin);
  const auto above_map = hn::Sub(hn::Sub(height, offset), hn::Mul(map_slope, rho));
  const auto off_map = hn::Abs(above_map);
  const auto fits_map = hn::Lt(above_map, hn::Add(set(kAboveMap), slack));
  const auto allowed = hn::Or(hn::Ge(slack, set(kKnown)), fits_map);

  // The ground of the rows below in this column.
  const ground::Followed& before = *row.before;
  const auto load = [k](const ground::Lanes& lanes) { return hn::LoadU(kLanes, lanes.data() + k); };
  const auto ground_rho = load(before.rho), ground_height = load(before.height), slope = load(before.slope);
  const auto obstacle = hn::Gt(load(before.obstacle), zero);
  const auto first = hn::Eq(ground_rho, zero);
  const auto way = hn::Sub(rho, ground_rho);
  const auto distance = hn::Max(way, zero);
  const auto baseline = select(first, rho, hn::Sub(ground_rho, load(before.back_rho)));
  const auto straight_on = hn::Min(distance, hn::Add(baseline, baseline));
  const auto from_ground = hn::Sub(height, ground_height);
  const auto above_column = hn::Sub(from_ground, hn::Mul(slope, straight_on));
  const auto off_column = hn::Abs(above_column);
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
  found = hn::Or(found, hn::And(hn::And(hn::Lt(slack, set(kNearlyKnown)), hn::And(flat, goesOn(map_slope))),
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
  const auto here = hn::Div(from_ground, hn::Max(way, set(0.5F)));
  const auto possible = hn::AndNot(first, hn::Lt(hn::Abs(here), steepest));
  const auto bend = hn::Add(set(kBend), hn::Div(set(kBendGrowth), hn::Max(above.step, set(0.5F))));
  continued = hn::Or(continued, hn::And(hn::And(hn::And(flat_free, above.seen), possible),
                                        hn::Lt(hn::Abs(hn::Sub(above.slope, here)), bend)));
  // Downwards, where no object can be.
  const auto lowest = hn::Sub(set(-kStepDown), hn::Mul(steepest, distance));
  continued = hn::Or(continued, hn::And(hn::And(hn::AndNot(above.nearer, flat), hn::Lt(above_column, zero)),
                                        hn::Gt(from_ground, lowest)));
  found = hn::Or(found, hn::And(continued, allowed));
  // Beyond objects.
  const auto on_line =
      hn::And(hn::And(above.line, possible), hn::Lt(hn::Abs(hn::Sub(above.line_slope, here)), set(kLineBend)));
  found = hn::Or(found, hn::And(on_line, hn::Or(hn::Gt(slack, set(kLineKnown)), fits_map)));

  // No ground is above what is lower and nearer by more than the steepest slope allows.
  const auto climb = hn::Mul(steepest, rho);
  const auto limit = hn::Add(load(before.limit), climb);
  found = hn::And(found, hn::And(valid, hn::Le(height, hn::Add(limit, set(kStepUp)))));
  const auto is_reflection =
      hn::And(hn::Lt(height, hn::Sub(limit, set(kReflectedFrom))), hn::Lt(above_column, set(-kReflection)));
  const auto limits = hn::And(valid, hn::Or(found, hn::Not(is_reflection)));
  ground::Followed& now = *row.followed;
  const auto store = [k](Floats value, ground::Lanes& lanes) { hn::StoreU(value, kLanes, lanes.data() + k); };
  const auto before_limit = load(before.limit);
  store(select(limits, hn::Min(before_limit, hn::Sub(height, climb)), before_limit), now.limit);

  found = hn::AndNot(hn::And(first, hn::Gt(above_column, grown(kFirstHighest, kFirstHighestGrowth, distance))), found);
  const auto foot =
      hn::And(hn::And(hn::Lt(slack, set(kSure)), hn::Lt(off_map, set(kFoot))), hn::Lt(off_column, set(kSure)));
  found = hn::AndNot(hn::AndNot(foot, above.wall), found);
  found = hn::AndNot(hn::And(isRough(row, k, rho, height), hn::Not(hn::And(sure, agrees))), found);
  const auto reached = hn::And(found, hn::Ge(way, set(kAdvance)));
  const auto confirmed = hn::Lt(off_column, grown(kLevel, kLevelGrowth, distance));

  const auto rises = hn::Or(hn::Or(above.wall, above.steep), hn::AndNot(first, hn::Gt(above_column, set(kObstacle))));
  const auto object = hn::And(hn::AndNot(found, rises), valid);
  const auto below = hn::And(
      hn::And(hn::Lt(above_column, set(-kNearBelow)), hn::Gt(above_column, set(-kReflection))),
      hn::And(hn::AndNot(hn::Or(found, object), valid), hn::Or(hn::Ge(slack, set(kKnown)), hn::Lt(above_map, zero))));
  const auto hides = select(reached, zero, select(object, set(1.0F), load(before.obstacle)));
  store(hides, now.obstacle);
  store(hn::Max(load(before.reach), rho), now.reach);
  advance(row, k, reached, rho, height, steepest);
  const auto known = hn::And(hn::Lt(slack, set(kWellKnown)), hn::Lt(off_map, set(kKnownHeight)));
  const auto higher = hn::And(hn::AndNot(found, valid), hn::Gt(above_column, set(kHigher)));
  const auto bits = [k](Mask mask) { return static_cast<std::uint8_t>(bitsOf(mask, k)); };
  return {bits(hn::Or(found, below)), bits(reached), bits(confirmed), bits(known), bits(higher), false};
}

void followRows(const Follower::Row* rows, std::size_t count, float max_slope, Found* found) {
  const auto steepest = set(max_slope);
  for (std::size_t i = 0; i < count; ++i) {
    found[i] = {};
    for (std::size_t k = 0; k < Block::kColumns; k += hn::Lanes(kLanes)) {
      const Found part = followLanes(rows[i], k, steepest);
      found[i].ground = static_cast<std::uint8_t>(found[i].ground | part.ground);
      found[i].reached = static_cast<std::uint8_t>(found[i].reached | part.reached);
      found[i].confirmed = static_cast<std::uint8_t>(found[i].confirmed | part.confirmed);
      found[i].known = static_cast<std::uint8_t>(found[i].known | part.known);
      found[i].higher = static_cast<std::uint8_t>(found[i].higher | part.higher);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(followRows);

namespace ground {
namespace {

constexpr float kStartLimit = 0.2F;  // metres above the ground beneath the sensor

/// The highest of the bits that are set, of at least one.
std::size_t lastOf(unsigned bits) {
  std::size_t last = 0;
  while ((bits >>= 1) != 0) ++last;
  return last;
}

}  // namespace

void Follower::begin(std::size_t lasers, float max_slope) {
  followed_.resize(std::max(followed_.size(), lasers));
  starts_.resize(std::max(starts_.size(), lasers));
  found_.resize(std::max(found_.size(), lasers));
  rows_.resize(std::max(rows_.size(), lasers));
  last_ground_.resize(std::max(last_ground_.size(), lasers));
  goes_on_.resize(std::max(goes_on_.size(), lasers));
  max_slope_ = max_slope;
}

void Follower::follow(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map,
                      std::uint32_t number, std::uint8_t* ground) {
  static constexpr Lanes kNothing{};
  const auto& rows = order.rows();
  const auto at = [&](const std::vector<float>& values, std::int32_t position) {
    return position == RowOrder::kNone
               ? kNothing.data()
               : values.data() +
                     static_cast<std::size_t>(rows[static_cast<std::size_t>(position)].row) * Block::kColumns;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowOrder::Row& row = rows[i];
    const Followed* before = &starts_[i];
    if (row.down == RowOrder::kNone) {
      Followed& start = starts_[i];
      for (Lanes* lanes : {&start.rho, &start.back_rho, &start.next_rho, &start.obstacle, &start.reach})
        lanes->fill(0.0F);
      for (Lanes* lanes : {&start.height, &start.back_height, &start.next_height}) lanes->fill(plane.height);
      start.slope.fill(plane.slopeTowards(order.directionOf(row.row)));
      start.limit.fill(plane.height + kStartLimit);
    } else {
      before = &followed_[static_cast<std::size_t>(row.down)];
    }
    const auto position = static_cast<std::int32_t>(i);
    rows_[i] = {at(block.rho, position),
                at(block.height, position),
                at(block.rho, row.up),
                at(block.height, row.up),
                at(block.rho, row.above),
                at(block.height, row.above),
                before,
                &followed_[i],
                &map.sectorAt(order.azimuthOf(row.row), number, plane)};
  }
  HWY_DYNAMIC_DISPATCH(followRows)(rows_.data(), rows.size(), max_slope_, found_.data());
  dropScattered(rows, found_);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < Block::kColumns; ++k)
      ground[static_cast<std::size_t>(rows[i].row) * Block::kColumns + k] = found_[i].ground >> k & 1;
  tellMap(block, order, plane, map, number);
}

/// Enters what the latest column of each row has shown.
void Follower::tellMap(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map,
                       std::uint32_t number) {
  const auto& rows = order.rows();
  const auto isReturn = [&](std::size_t i, std::size_t k) {
    return block.rho[static_cast<std::size_t>(rows[i].row) * Block::kColumns + k] > Block::kMinRho;
  };
  const auto stretchOf = [&](std::size_t i) {
    const std::size_t k = lastOf(found_[i].reached);
    const Followed& now = followed_[i];
    const Followed& before = *rows_[i].before;
    const bool is_first = rows[i].down == RowOrder::kNone;
    return GroundMap::Stretch{is_first ? 0.0F : before.rho[k],
                              is_first ? plane.height : before.height[k],
                              now.rho[k],
                              now.height[k],
                              now.slope[k],
                              (found_[i].confirmed >> k & 1) == 0};
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::int32_t down = rows[i].down;
    last_ground_[i] = down == RowOrder::kNone ? RowOrder::kNone : last_ground_[static_cast<std::size_t>(down)];
    goes_on_[i] = 0;
    GroundMap::Sector& sector = map.sectorAt(order.azimuthOf(rows[i].row), number, plane);
    std::size_t k = Block::kColumns;
    while (k > 0 && !isReturn(i, k - 1)) --k;
    if (k == 0) continue;
    --k;
    const float rho = rows_[i].rho[k];
    const float reach = rows_[i].before->reach[k];
    if (rho > reach) GroundMap::seeThrough(sector, reach, rho, rows_[i].height[k] / rho);
    if (found_[i].reached == 0) continue;
    map.add(sector, stretchOf(i), order.turnsLeft());
    if (last_ground_[i] != RowOrder::kNone) goes_on_[static_cast<std::size_t>(last_ground_[i])] = 1;
    last_ground_[i] = static_cast<std::int32_t>(i);
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (found_[i].reached != 0 && goes_on_[i] == 0)
      GroundMap::extend(map.sectorAt(order.azimuthOf(rows[i].row), number, plane), stretchOf(i));
}

}  // namespace ground
}  // namespace lisco
#endif
