// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/follow_rows.h"

#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/follow_rows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/ground/above-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

// Distances and heights are metres, slopes metres per metre.
// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.

// The map, which is the ground known from the blocks before. Slack is what the map's height may be off by.
constexpr float kKnown = 1.5F;        // most slack of what may contradict
constexpr float kWellKnown = 0.15F;   // most slack of what decides
constexpr float kNearlyKnown = 0.5F;  // most slack of what decides where the ground seems to go on
constexpr float kAtMap = 0.09F, kMaxSlack = 0.03F, kLevelAtMap = 0.05F;
constexpr float kSure = 0.05F;                                  // slack and height, even where a surface rises
constexpr float kFoot = 0.03F;                                  // height, even at the foot of a wall
constexpr float kAboveMap = 0.08F;                              // contradicts
constexpr float kSmoothAboveMap = 0.13F, kSmoothRange = 40.0F;  // contradicts a smooth surface up to this distance
constexpr float kUnevenAboveMap = 0.18F;                        // and more beyond, times the unevenness
constexpr float kKnownHeight = 0.06F;                           // even among returns of which most are higher

// Heights off the straight continuation of the column's ground, growing with the distance from the ground reached:
// k + min (kGrowth * distance, kMax).
constexpr float kAtColumn = 0.16F, kAtColumnGrowth = 0.03F, kAtColumnMax = 0.15F;  // is ground
constexpr float kLevel = 0.15F, kLevelGrowth = 0.11F, kLevelMax = 0.8F;            // is, where it seems to go on
constexpr float kFirst = 0.1F, kFirstGrowth = 0.04F, kFirstLevelGrowth = 0.12F;    // before any ground is reached
constexpr float kFirstMaxDistance = 10.0F;                                         // distance up to which these grow
constexpr float kAgrees = 0.1F, kAgreesGrowth = 0.03F;  // with kSure: may be as rough as leaves
constexpr float kObstacle = 0.25F;                      // hides the ground beyond
constexpr float kHigher = 0.1F;                         // counts as Found::higher
constexpr float kNearBelow = 0.1F, kReflection = 0.5F;  // in between, returns below are ground that is not followed
// Differences of slopes.
constexpr float kSameSlope = 0.2F;                      // the ground seems to go on
constexpr float kBend = 0.13F, kBendGrowth = 0.1F;      // at a bend, where the growth is by 1 / step
constexpr float kLineBend = 0.2F;                       // of a line beyond an object
constexpr float kFirstSurface = 0.2F, kSurface = 0.1F;  // of a surface where nothing is known, times the unevenness
// Others.
constexpr float kUnevenBelowMap = 1.0F;                    // below the map, where no object is, times the unevenness
constexpr float kSurfaceLength = 2.0F;                     // least length of a surface where nothing is known
constexpr float kLineKnown = 0.3F;                         // slack up to which the map decides against returns above it
constexpr float kStepDown = 0.15F, kStepUp = 0.13F;        // below the steepest descent, above the steepest rise
constexpr float kReflectedFrom = 1.0F;                     // below the highest possible ground
constexpr float kAdvance = 0.02F;                          // least way of the ground reached
constexpr float kBaseline = 1.5F, kBaselineGrowth = 0.1F;  // way over which the slope of the ground is measured
constexpr float kMinBaseline = 0.3F;                       // a shorter way keeps the slope from before
constexpr float kMinWay = 0.5F;                            // a shorter way counts as this one where slopes are compared

/// The ground that the map has where a return is.
struct Mapped {
  Floats slope, slack;
  Floats above;  ///< height of the return above it
};

HWY_INLINE Mapped lookDown(const GroundMap::Sector& sector, Floats rho, Floats height, Mask valid) {
  const auto bin = distanceBins(rho, static_cast<std::int32_t>(GroundMap::kBins));
  Floats offset;
  Mapped mapped;
  // Mostly all returns are within as many bins as a vector has lanes.
  constexpr std::size_t kStep = hn::MaxLanes(kLanes);
  const auto most = hn::Set(kLaneInts, static_cast<std::int32_t>(GroundMap::kBins - kStep));
  const auto nearest =
      hn::MinOfLanes(kLaneInts, hn::IfThenElse(hn::RebindMask(kLaneInts, valid), hn::Min(bin, most), most));
  const auto from_nearest = hn::Sub(bin, nearest);
  const auto is_far = hn::Gt(from_nearest, hn::Set(kLaneInts, static_cast<std::int32_t>(kStep) - 1));
  if (kStep > 1 && hn::AllFalse(kLanes, hn::And(valid, hn::RebindMask(kLanes, is_far)))) {
    const auto first = static_cast<std::size_t>(hn::GetLane(nearest));
    // Lanes without a return look up any of these bins.
    const auto lanes =
        hn::IndicesFromVec(kLanes, hn::And(from_nearest, hn::Set(kLaneInts, static_cast<std::int32_t>(kStep) - 1)));
    const auto look = [&](const GroundMap::Values& values)
                          HWY_ATTR { return hn::TableLookupLanes(hn::LoadU(kLanes, &values[first]), lanes); };
    offset = look(sector.offset);
    mapped.slope = look(sector.slope);
    mapped.slack = look(sector.slack);
  } else {
    offset = hn::GatherIndex(kLanes, sector.offset.data(), bin);
    mapped.slope = hn::GatherIndex(kLanes, sector.slope.data(), bin);
    mapped.slack = hn::GatherIndex(kLanes, sector.slack.data(), bin);
  }
  mapped.above = hn::Sub(hn::Sub(height, offset), hn::Mul(mapped.slope, rho));
  return mapped;
}

/// Returns of a row, as many as a vector has lanes, as seen from the ground that the rows below show in their columns.
struct RowPart {
  Floats rho, height;
  Mask valid;
  Mask first;            ///< no ground has been reached yet
  Floats slope;          ///< of the ground reached
  Floats way, distance;  ///< from the ground reached to the return, and not less than 0
  Floats from_ground;    ///< height of the return above the ground reached
  Floats above;          ///< and above its straight continuation
  Floats climb, limit;   ///< height by which the steepest ground rises up to there, and its highest height there
};

HWY_INLINE RowPart partOf(const FollowedRow& row, std::size_t k, Floats steepest) {
  const GroundReached& before = *row.inwards;
  const auto load = [k](const Lanes& lanes) { return hn::LoadU(kLanes, lanes.data() + k); };
  RowPart part;
  part.rho = hn::LoadU(kLanes, row.rho + k);
  part.height = hn::LoadU(kLanes, row.height + k);
  part.valid = hn::Gt(part.rho, set(Block::kMinRho));
  const auto ground_rho = load(before.rho);
  part.first = hn::Eq(ground_rho, hn::Zero(kLanes));
  part.slope = load(before.slope);
  part.way = hn::Sub(part.rho, ground_rho);
  part.distance = hn::Max(part.way, hn::Zero(kLanes));
  const auto baseline = select(part.first, part.rho, hn::Sub(ground_rho, load(before.back_rho)));
  const auto straight_on = hn::Min(part.distance, hn::Add(baseline, baseline));
  part.from_ground = hn::Sub(part.height, load(before.height));
  part.above = hn::Sub(part.from_ground, hn::Mul(part.slope, straight_on));
  part.climb = hn::Mul(steepest, part.rho);
  part.limit = hn::Add(load(row.before->limit), part.climb);
  return part;
}

/// The slope from the ground reached to the return.
HWY_INLINE Floats slopeUpTo(const RowPart& part) {
  return hn::Div(part.from_ground, hn::Max(part.way, set(kMinWay)));
}

/// The most height of ground above the map's. \param smooth whether the surface is smooth, or may be
HWY_INLINE Floats mostAboveMap(const Mapped& map, Floats rho, Mask smooth, float unevenness) {
  const auto far = set(kAboveMap + unevenness * kUnevenAboveMap);
  const auto most = select(hn::Lt(rho, set(kSmoothRange)), set(kSmoothAboveMap), far);
  return hn::Add(select(smooth, most, set(kAboveMap)), map.slack);
}

/// Returns that are too high for ground, whatever the rows above show: it cannot rise so steeply from lower and nearer
/// returns.
HWY_INLINE Mask areTooHigh(const RowPart& part) {
  return hn::AndNot(hn::Lt(part.above, set(-kNearBelow)), hn::Gt(part.height, hn::Add(part.limit, set(kStepUp))));
}

/// Likewise: the map has the ground clearly lower.
HWY_INLINE Mask areAboveMap(const RowPart& part, const Mapped& map, float unevenness) {
  const auto most = mostAboveMap(map, part.rho, part.valid, unevenness);
  return hn::And(hn::Le(map.slack, set(kLineKnown)), hn::Ge(map.above, most));
}

/// Returns on the ground, whatever the rows above show: both the map and the column have it there.
HWY_INLINE Mask areWhereExpected(const RowPart& part, const Mapped& map) {
  const auto on_map = hn::And(hn::Lt(map.slack, set(kSure)), hn::Lt(hn::Abs(map.above), set(kFoot)));
  return hn::And(on_map, hn::Lt(hn::Abs(part.above), set(kSure)));
}

/// Lowers the highest possible ground to that of the steepest slope from these returns on, but for reflections.
HWY_INLINE void lowerLimit(const FollowedRow& row, std::size_t k, const RowPart& part, Mask found) {
  const auto is_reflection =
      hn::And(hn::Lt(part.height, hn::Sub(part.limit, set(kReflectedFrom))), hn::Lt(part.above, set(-kReflection)));
  const auto limits = hn::And(part.valid, hn::Or(found, hn::Not(is_reflection)));
  const auto limit = hn::LoadU(kLanes, row.before->limit.data() + k);
  const auto lower = hn::Min(limit, hn::Sub(part.height, part.climb));
  hn::StoreU(select(limits, lower, limit), kLanes, row.passed->limit.data() + k);
}

/// Returns that hide the ground beyond: the rows above show an object, or the ground further inwards does.
HWY_INLINE Mask areObstacles(const RowPart& part, const Above& above) {
  const auto over = hn::AndNot(part.first, hn::Gt(part.above, set(kObstacle)));
  return hn::Or(hn::Or(above.wall, above.steep), over);
}

/// Moves the ground reached to the returns of `reached`.
HWY_INLINE void advance(const FollowedRow& row, std::size_t k, Mask reached, Floats rho, Floats height,
                        Floats max_slope) {
  const GroundReached& before = *row.inwards;
  GroundReached& now = *row.followed;
  const auto load = [k](const Lanes& lanes) { return hn::LoadU(kLanes, lanes.data() + k); };
  const auto store = [k](Floats value, Lanes& lanes) { hn::StoreU(value, kLanes, lanes.data() + k); };
  auto back_rho = load(before.back_rho), back_height = load(before.back_height);
  auto next_rho = load(before.next_rho), next_height = load(before.next_height);
  const auto far = hn::And(reached, hn::Ge(hn::Sub(rho, next_rho), grown(kBaseline, kBaselineGrowth, rho)));
  back_rho = select(far, next_rho, back_rho);
  back_height = select(far, next_height, back_height);
  next_rho = select(far, rho, next_rho);
  next_height = select(far, height, next_height);
  const auto way = hn::Sub(rho, back_rho);
  auto slope = hn::Div(hn::Sub(height, back_height), hn::Max(way, set(kMinBaseline)));
  slope = hn::Min(hn::Max(slope, hn::Neg(max_slope)), max_slope);
  slope = select(hn::And(reached, hn::Gt(way, set(kMinBaseline))), slope, load(before.slope));
  store(select(reached, rho, load(before.rho)), now.rho);
  store(select(reached, height, load(before.height)), now.height);
  store(slope, now.slope);
  store(back_rho, now.back_rho);
  store(back_height, now.back_height);
  store(next_rho, now.next_rho);
  store(next_height, now.next_height);
}

/// What is found of a part of a row, all of whose returns are objects.
HWY_INLINE Found passObjects(const FollowedRow& row, std::size_t k, const RowPart& part) {
  row.passed->obstacles = static_cast<std::uint8_t>(row.passed->obstacles | bitsOf(part.valid, k));
  lowerLimit(row, k, part, hn::Lt(part.rho, hn::Zero(kLanes)));  // none is found
  const auto higher = hn::And(part.valid, hn::Gt(part.above, set(kHigher)));
  return {0, 0, 0, 0, bitsOf(higher, k)};
}

/// What is found of a part of a row, all of whose returns are on the ground.
HWY_INLINE Found passGround(const FollowedRow& row, std::size_t k, const RowPart& part, Mask& reached) {
  reached = hn::And(part.valid, hn::Ge(part.way, set(kAdvance)));
  lowerLimit(row, k, part, part.valid);
  const std::uint8_t ground = bitsOf(part.valid, k), reached_bits = bitsOf(reached, k);
  row.passed->obstacles = static_cast<std::uint8_t>(row.passed->obstacles & ~reached_bits);
  return {ground, reached_bits, ground, ground, 0};
}

/// The ground seems to go on along a slope beyond a return.
HWY_INLINE Mask goesOn(const Above& above, Floats slope) {
  return hn::Or(hn::Not(above.seen), hn::Lt(hn::Abs(hn::Sub(above.slope, slope)), set(kSameSlope)));
}

/// Ground at the height of the map.
HWY_INLINE Mask foundByMap(const Mapped& map, const Above& above, Mask flat, Mask expected) {
  const auto off = hn::Abs(map.above);
  const auto well_known = hn::And(hn::And(hn::Lt(map.slack, set(kWellKnown)), hn::Or(hn::Not(above.surface), expected)),
                                  hn::Lt(off, hn::Add(set(kAtMap), hn::Min(map.slack, set(kMaxSlack)))));
  const auto known = hn::And(hn::And(hn::Lt(map.slack, set(kNearlyKnown)), hn::And(flat, goesOn(above, map.slope))),
                             hn::Lt(off, hn::Add(set(kLevelAtMap), map.slack)));
  return hn::Or(well_known, known);
}

/// Ground that continues the column's.
HWY_INLINE Mask foundByColumn(const RowPart& part, const Mapped& map, const Above& above, Mask flat, Mask obstacle,
                              Floats steepest, float unevenness) {
  const Mask first = part.first;
  Mask smooth = hn::AndNot(above.surface, hn::And(hn::And(flat, above.seen), goesOn(above, part.slope)));
  if (unevenness > 0.0F) {
    // Far away, a return on a crest has none above it.
    const Mask far = hn::AndNot(first, hn::Ge(part.rho, set(kSmoothRange)));
    const Mask highest = hn::AndNot(hn::Or(above.seen, above.nearer), hn::AndNot(above.surface, flat));
    smooth = hn::Or(smooth, hn::And(far, highest));
  }
  const Mask fits_map = hn::Lt(map.above, mostAboveMap(map, part.rho, smooth, unevenness));
  const auto distance = part.distance, near = hn::Min(distance, set(kFirstMaxDistance)), off = hn::Abs(part.above);
  // At its height.
  const auto at_column =
      select(first, grown(kFirst, kFirstGrowth, near),
             hn::Add(set(kAtColumn), hn::Min(hn::Mul(set(kAtColumnGrowth), distance), set(kAtColumnMax))));
  auto continued = hn::Lt(off, at_column);
  const auto level = select(first, grown(kFirst, kFirstLevelGrowth, near),
                            hn::Add(set(kLevel), hn::Min(hn::Mul(set(kLevelGrowth), distance), set(kLevelMax))));
  const auto flat_free = hn::AndNot(obstacle, flat);
  continued = hn::Or(continued, hn::And(hn::And(flat_free, goesOn(above, part.slope)), hn::Lt(off, level)));
  // Where the ground changes its slope: beyond, it has that slope.
  const auto here = slopeUpTo(part);
  const auto possible = hn::AndNot(first, hn::Lt(hn::Abs(here), steepest));
  const auto bend = hn::Add(set(kBend), hn::Div(set(kBendGrowth), hn::Max(above.step, set(kMinWay))));
  continued = hn::Or(continued, hn::And(hn::And(hn::And(flat_free, above.seen), possible),
                                        hn::Lt(hn::Abs(hn::Sub(above.slope, here)), bend)));
  // Downwards, where no object can be.
  const auto lowest = hn::Sub(set(-kStepDown), hn::Mul(steepest, distance));
  continued = hn::Or(continued, hn::And(hn::And(hn::AndNot(above.nearer, flat), hn::Lt(part.above, hn::Zero(kLanes))),
                                        hn::Gt(part.from_ground, lowest)));
  const auto found = hn::And(continued, hn::Or(hn::Ge(map.slack, set(kKnown)), fits_map));
  // Beyond objects.
  const auto on_line =
      hn::And(hn::And(above.line, possible), hn::Lt(hn::Abs(hn::Sub(above.line_slope, here)), set(kLineBend)));
  return hn::Or(found, hn::And(on_line, hn::Or(hn::Gt(map.slack, set(kLineKnown)), fits_map)));
}

/// Ground that is found only where it is uneven: what is lower than the map's, and surfaces where nothing is known,
/// behind crests and on slopes that face the sensor.
HWY_INLINE Mask foundOnUneven(const RowPart& part, const Mapped& map, const Above& above, Mask flat, Floats steepest,
                              float unevenness) {
  const auto level = hn::AndNot(above.surface, flat);
  const auto below =
      hn::And(hn::Lt(map.above, hn::Zero(kLanes)), hn::Gt(map.above, set(-unevenness * kUnevenBelowMap)));
  const auto below_map = hn::And(hn::And(below, hn::Lt(map.slack, set(kKnown))), hn::AndNot(above.wall, level));

  const auto here = slopeUpTo(part);
  const auto bend = hn::Abs(hn::Sub(above.slope, here));
  const auto most = set(unevenness * kSurface);
  const auto goes_on = hn::And(hn::Lt(hn::Abs(above.slope), most), hn::Lt(bend, most));
  const auto continues =
      hn::Or(hn::AndNot(part.first, goes_on), hn::And(part.first, hn::Lt(bend, set(unevenness * kFirstSurface))));
  const auto surface = hn::And(hn::And(above.seen, hn::Gt(above.step, set(kSurfaceLength))),
                               hn::And(continues, hn::Lt(hn::Abs(here), steepest)));
  return hn::Or(below_map, hn::And(hn::And(level, surface), hn::Ge(map.slack, set(kKnown))));
}

/// What is found of any part of a row.
HWY_INLINE Found followPart(const FollowedRow& row, std::size_t k, const RowPart& part, const Mapped& map,
                            Floats steepest, Mask& reached) {
  const Floats rho = part.rho, height = part.height, distance = part.distance;
  const Mask valid = part.valid;
  const Above above = lookUp(row, k, rho, height, steepest);
  const auto off_map = hn::Abs(map.above), off_column = hn::Abs(part.above);
  const auto flat = hn::AndNot(above.steep, hn::Or(hn::Not(above.seen), hn::Lt(hn::Abs(above.slope), steepest)));
  const auto agrees = hn::Lt(off_column, grown(kAgrees, kAgreesGrowth, distance));
  const auto sure = hn::And(hn::Lt(map.slack, set(kSure)), hn::Lt(off_map, set(kSure)));

  // Without branches on what is found, which cannot be predicted.
  const Mask obstacles = lanesOf(row.before->obstacles, k);
  auto found = hn::Or(foundByMap(map, above, flat, hn::Or(agrees, sure)),
                      foundByColumn(part, map, above, flat, obstacles, steepest, row.unevenness));
  if (row.unevenness > 0.0F) found = hn::Or(found, foundOnUneven(part, map, above, flat, steepest, row.unevenness));
  found = hn::And(found, hn::And(valid, hn::Le(height, hn::Add(part.limit, set(kStepUp)))));
  lowerLimit(row, k, part, found);

  // But no ground: walls above their feet, rough surfaces where ground is unsure.
  const auto foot = areWhereExpected(part, map);
  found = hn::AndNot(hn::AndNot(foot, above.wall), found);
  const auto unsure = hn::AndNot(hn::And(sure, agrees), found);
  found = hn::AndNot(hn::And(unsure, isRough(row, k, rho, height)), found);

  reached = hn::And(found, hn::Ge(part.way, set(kAdvance)));
  const auto object = hn::And(hn::AndNot(found, areObstacles(part, above)), valid);
  const auto below = hn::And(hn::And(hn::Lt(part.above, set(-kNearBelow)), hn::Gt(part.above, set(-kReflection))),
                             hn::And(hn::AndNot(hn::Or(found, object), valid),
                                     hn::Or(hn::Ge(map.slack, set(kKnown)), hn::Lt(map.above, hn::Zero(kLanes)))));
  const auto confirmed = hn::Lt(off_column, grown(kLevel, kLevelGrowth, distance));
  const auto known = hn::And(hn::Lt(map.slack, set(kWellKnown)), hn::Lt(off_map, set(kKnownHeight)));
  const auto higher = hn::And(hn::AndNot(found, valid), hn::Gt(part.above, set(kHigher)));
  const std::uint8_t reached_bits = bitsOf(reached, k);
  row.passed->obstacles = static_cast<std::uint8_t>((row.passed->obstacles & ~reached_bits) | bitsOf(object, k));
  return {bitsOf(hn::Or(found, below), k), reached_bits, bitsOf(confirmed, k), bitsOf(known, k), bitsOf(higher, k)};
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
  RowPart parts[kParts];
  Mapped maps[kParts];
  Mask reached[kParts];  // unless all are objects
  bool are_objects = true;
  for (std::size_t i = 0; i < kParts; ++i) {
    const RowPart part = parts[i] = partOf(row, i * kStep, steepest);
    are_objects = are_objects && hn::AllFalse(kLanes, hn::AndNot(areTooHigh(part), part.valid));
  }
  bool are_ground = false;
  if (!are_objects) {
    are_objects = are_ground = true;
    for (std::size_t i = 0; i < kParts; ++i) {
      const RowPart& part = parts[i];
      const Mapped map = maps[i] = lookDown(*row.sector, part.rho, part.height, part.valid);
      const auto too_high = areTooHigh(part);
      are_objects =
          are_objects &&
          hn::AllFalse(kLanes, hn::AndNot(hn::Or(too_high, areAboveMap(part, map, row.unevenness)), part.valid));
      are_ground =
          are_ground && hn::AllFalse(kLanes, hn::AndNot(hn::AndNot(too_high, areWhereExpected(part, map)), part.valid));
    }
  }
  for (std::size_t i = 0; i < kParts; ++i) {
    const std::size_t k = i * kStep;
    add(are_objects  ? passObjects(row, k, parts[i])
        : are_ground ? passGround(row, k, parts[i], reached[i])
                     : followPart(row, k, parts[i], maps[i], steepest, reached[i]),
        found);
  }
  if (found.reached != 0) {
    passed.followed = row.number;
    for (std::size_t i = 0; i < kParts; ++i)
      advance(row, i * kStep, reached[i], parts[i].rho, parts[i].height, steepest);
  }
  return found;
}

void followRows(const FollowSetting& setting, std::size_t first, std::size_t end, const FollowResult& result) {
  const auto steepest = set(setting.max_slope);
  // Copies: the compiler must assume that storing bytes changes any other array.
  const float* const rho = setting.block->rho.data();
  const float* const height = setting.block->height.data();
  const std::uint8_t* const returns = setting.block->returns.data();
  const RowOrder::Row* const rows = setting.rows;
  const GroundMap::Sector* const map = setting.map;
  const std::uint32_t* const sectors = setting.sectors;
  const Passed* const starts = setting.starts;
  Passed* const passed = result.passed;
  GroundReached* const reached = result.followed;
  Found* const found = result.found;
  for (std::size_t i = first; i < end; ++i) {
    const RowOrder::Row& row = rows[i];
    const Passed& before = row.down == RowOrder::kNone ? starts[i] : passed[row.down];
    if (returns[row.row] == 0) {
      passed[i] = before;
      found[i] = {};
      continue;
    }
    const std::ptrdiff_t at = row.row * static_cast<std::ptrdiff_t>(Block::kColumns);
    const FollowedRow followed{rho + at,    height + at, rho,
                               height,      &row,        map + sectors[i],
                               &before,     &passed[i],  &reached[before.followed],
                               &reached[i], i,           setting.unevenness};
    found[i] = followRow(followed, steepest);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(followRows);

void followRows(const FollowSetting& setting, std::size_t first, std::size_t end, const FollowResult& result) {
  HWY_DYNAMIC_DISPATCH(followRows)(setting, first, end, result);
}

}  // namespace lisco::ground
#endif
