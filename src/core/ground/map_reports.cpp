// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/map_reports.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/map_reports.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/ground/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr float kAlong = 0.05F;        // metres per metre, by which the ground may rise unseen between two returns
constexpr float kBeyond = 0.1F;        // metres per metre, the same beyond the last one
constexpr float kBeyondStart = 0.02F;  // metres, the same
constexpr float kMaxBeyond = 1.5F;     // metres
constexpr float kStep = 0.25F;         // metres; higher ones are no ground, even if they were found to be
/// A block uses every fifth row's ray: odd, so that all rows of staggered lasers have their turns. More: faster, but
/// ground that rays disprove stays longer.
constexpr std::size_t kRowsPerRay = 5;
constexpr float kTrendGain = 0.3F;
constexpr float kMaxTrend = 0.005F;     // metres per metre of distance
constexpr float kMarginSame = 0.01F;    // metres
constexpr float kMarginRay = 0.1F;      // metres
constexpr float kMarginHidden = 0.05F;  // metres
constexpr float kDoubt = 0.01F;         // metres
// Stretches whose change of slope shows how uneven the ground is: nearer, kerbs and feet of walls change it.
constexpr float kMinLength = 1.0F;                       // metres
constexpr float kUnevenFrom = 10.0F, kUnevenTo = 60.0F;  // metres
constexpr float kMaxChange = 0.3F;                       // metres per metre; greater changes count as much
constexpr float kNoSlope = 1e9F;

/// The highest of the bits that are set; the lowest if none is.
HWY_INLINE std::size_t lastOf(std::uint8_t bits) {
  return 31 - static_cast<std::size_t>(__builtin_clz(bits | 1U));
}

/// Calls visit(bin, mask, is_last) for the bins from first to last, some at a time: those of the mask, from `bin` on.
template <typename Visit>
HWY_INLINE void forBins(std::int32_t first, std::int32_t last, Visit&& visit) {
  constexpr auto kTogether = static_cast<std::int32_t>(hn::MaxLanes(kLanes));
  const auto step = hn::Set(kLaneInts, kTogether);
  const auto before = hn::Set(kLaneInts, first - 1), after = hn::Set(kLaneInts, last + 1);
  const auto end = hn::Set(kLaneInts, last);
  std::int32_t bin = first & -kTogether;
  auto bins = hn::Add(hn::Iota(kLaneInts, 0), hn::Set(kLaneInts, bin));
  for (; bin <= last; bin += kTogether, bins = hn::Add(bins, step))
    visit(static_cast<std::size_t>(bin), hn::RebindMask(kLanes, hn::And(hn::Gt(bins, before), hn::Gt(after, bins))),
          hn::RebindMask(kLanes, hn::Eq(bins, end)));
}

/// The values of a sector's cells from a bin on.
struct Cells {
  HWY_INLINE Floats load(const GroundMap::Values& values) const { return hn::LoadU(kLanes, &values[bin]); }
  HWY_INLINE void store(Floats value, GroundMap::Values& values) const { hn::StoreU(value, kLanes, &values[bin]); }
  HWY_INLINE void store(Mask mask, Floats value, GroundMap::Values& values) const {
    hn::StoreU(hn::IfThenElse(mask, value, load(values)), kLanes, &values[bin]);
  }
  HWY_INLINE Floats heightAt(Floats rho) const {
    return hn::Add(load(sector.offset), hn::Mul(load(sector.slope), rho));
  }

  const GroundMap::Sector& sector;
  std::size_t bin;
};

using Middles = const GroundMap::Values&;
constexpr auto kMapBins = static_cast<std::int32_t>(GroundMap::kBins);

/// Collects the ground that the rows have shown. \return number of stretches
std::size_t collectStretches(const Shown& shown, MapReports& reports) {
  const FollowSetting setting = shown.setting;
  const FollowResult result = shown.result;
  MapReports::Stretches& stretches = reports.stretches;
  std::uint32_t* const latest = reports.latest.data();
  stretches.is_last[0] = 0;
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < shown.with_ground_count; ++k) {
    const auto i = static_cast<std::size_t>(shown.with_ground[k]);
    if (result.passed[i].followed != i) continue;  // nothing was reached
    const RowOrder::Row& row = setting.rows[i];
    const bool is_first = row.down == RowOrder::kNone;
    const Passed& before = is_first ? setting.starts[i] : result.passed[row.down];
    const std::uint32_t below = before.followed < setting.size ? latest[before.followed] : 0;
    latest[i] = below;
    const Found found = result.found[i];
    if (found.reached == 0) continue;
    const std::size_t last = lastOf(found.reached);
    const GroundReached& now = result.followed[i];
    const GroundReached& inwards = result.followed[before.followed];
    stretches.from_rho[count] = inwards.rho[last];
    stretches.from_height[count] = is_first ? shown.start_height : inwards.height[last];
    stretches.slope_before[count] = is_first ? kNoSlope : inwards.slope[last];
    stretches.rho[count] = now.rho[last];
    stretches.height[count] = now.height[last];
    stretches.long_slope[count] = now.slope[last];
    stretches.sector[count] = setting.sectors[i];
    stretches.is_doubted[count] = ~static_cast<std::uint32_t>(found.confirmed) >> last & 1;
    stretches.is_last[below] = 0;
    latest[i] = ++count;
    stretches.is_last[count] = 1;
  }
  return count;
}

/// Computes the bins of the stretches, the lines that are entered, and how much the slope changes.
HWY_INLINE void measureStretches(MapReports::Stretches& stretches, std::size_t count, float max_slope,
                                 Unevenness& unevenness) {
  auto changes = hn::Zero(kLaneInts), counts = changes;
  for (std::size_t i = 0; i < count; i += hn::MaxLanes(kLanes)) {
    const auto load = [i](const AlignedVector<float>& values) HWY_ATTR { return hn::LoadU(kLanes, &values[i]); };
    const auto store = [i](Floats value, AlignedVector<float>& to) HWY_ATTR { hn::StoreU(value, kLanes, &to[i]); };
    const auto from_rho = load(stretches.from_rho), rho = load(stretches.rho), height = load(stretches.height);
    const auto length = hn::Sub(rho, from_rho), rise = hn::Sub(height, load(stretches.from_height));
    const auto most = set(max_slope);
    const auto is_none = hn::Or(hn::Lt(length, set(1e-3F)), hn::Gt(rise, hn::Add(set(kStep), hn::Mul(most, length))));
    const auto own_slope = hn::Min(hn::Max(hn::Div(rise, length), hn::Neg(most)), most);
    const auto slope = hn::IfThenElse(hn::Gt(length, set(0.3F)), own_slope, load(stretches.long_slope));
    store(slope, stretches.slope);
    const auto change = hn::Abs(hn::Sub(own_slope, load(stretches.slope_before)));
    const auto in_range = hn::And(hn::Gt(rho, set(kUnevenFrom)), hn::Lt(rho, set(kUnevenTo)));
    const auto is_stretch =
        hn::And(hn::FirstN(kLanes, count - i), hn::AndNot(is_none, hn::Gt(length, set(kMinLength))));
    const auto counted =
        hn::RebindMask(kLaneInts, hn::And(hn::And(in_range, is_stretch), hn::Lt(change, set(kNoSlope / 2.0F))));
    const auto units = hn::ConvertTo(kLaneInts, hn::Mul(hn::Min(change, set(kMaxChange)), set(Unevenness::kUnit)));
    changes = hn::Add(changes, hn::IfThenElseZero(counted, units));
    counts = hn::Sub(counts, hn::VecFromMask(kLaneInts, counted));
    store(hn::Sub(height, hn::Mul(slope, rho)), stretches.offset);
    store(hn::Div(height, rho), stretches.ray);
    hn::StoreU(distanceBins(from_rho, kMapBins), kLaneInts, &stretches.first[i]);
    const auto last =
        hn::IfThenElse(hn::RebindMask(kLaneInts, is_none), hn::Set(kLaneInts, -1), distanceBins(rho, kMapBins));
    hn::StoreU(last, kLaneInts, &stretches.last[i]);
  }
  unevenness.add(hn::GetLane(hn::SumOfLanes(kLaneInts, changes)), hn::GetLane(hn::SumOfLanes(kLaneInts, counts)));
}

/// Forgets ground above the rays of the rows' latest returns, beyond the ground that their columns have shown. Rays of
/// neighbouring rows show nearly the same: each block has those of some of its rows.
void seeThrough(const Shown& shown, std::uint32_t block_number, GroundMap::Sector* sectors, Middles middles) {
  const FollowSetting& setting = shown.setting;
  const Block& block = *setting.block;
  for (std::size_t i = block_number % kRowsPerRay; i < setting.size; i += kRowsPerRay) {
    const auto row = static_cast<std::size_t>(setting.rows[i].row);
    const float to = block.last_rho[row];
    const GroundReached& ground = shown.result.followed[shown.result.passed[i].followed];
    const std::int32_t first = GroundMap::binOf(ground.rho[block.last[row]]) + 1;
    const std::int32_t end = GroundMap::binOf(to);
    if (first >= end) continue;
    GroundMap::Sector& sector = sectors[setting.sectors[i]];
    const auto slope = set(block.last_height[row] / to);
    forBins(first, end - 1, [&](std::size_t bin, Mask mask, Mask /*is_last*/) HWY_ATTR {
      const Cells cells{sector, bin};
      const auto middle = cells.load(middles);
      const auto ray = hn::Add(hn::Mul(slope, middle), set(kMarginRay));
      cells.store(hn::And(mask, hn::Gt(cells.heightAt(middle), ray)), set(GroundMap::kUnknown), sector.slack);
    });
  }
}

/// Enters a stretch, and updates the trend in the bin of its end.
HWY_INLINE void addStretch(GroundMap::Sector& sector, const MapReports::Stretches& stretches, std::size_t i,
                           float trend_gain, Middles middles) {
  const auto ray = set(stretches.ray[i]), from_rho = set(stretches.from_rho[i]), rho = set(stretches.rho[i]);
  const auto offset = set(stretches.offset[i]), slope = set(stretches.slope[i]);
  const auto most = hn::Mul(set(kMaxTrend), rho), gain = set(trend_gain);
  // Where ground is doubted that was there before, its slack is at least this, and more than before.
  const auto no_doubt = hn::Set(kLaneInts, static_cast<std::int32_t>(stretches.is_doubted[i]) - 1);
  const auto doubt = hn::MaskFromVec(hn::BitCast(kLanes, hn::Not(no_doubt)));
  forBins(stretches.first[i], stretches.last[i], [&](std::size_t bin, Mask mask, Mask is_end) HWY_ATTR {
    const Cells cells{sector, bin};
    const auto at = cells.load(middles);
    const auto inside = hn::Min(hn::Sub(at, from_rho), hn::Sub(rho, at));
    const auto slack = hn::Mul(set(kAlong), hn::Max(hn::Zero(kLanes), inside));
    const auto before = cells.load(sector.slack), height = cells.heightAt(at);
    // The return would have been hidden.
    const auto is_hidden = hn::Gt(height, hn::Add(hn::Mul(ray, at), set(kMarginHidden)));
    const auto is_better = hn::Le(slack, hn::Add(before, set(kMarginSame)));
    const auto doubted = hn::Min(hn::Add(hn::Max(slack, before), set(kDoubt)), set(GroundMap::kUnknown));
    const auto entered = hn::And(mask, hn::Or(is_hidden, is_better));

    const auto age = cells.load(sector.age), trend = cells.load(sector.trend);
    const auto is_known = hn::And(hn::Lt(before, set(1.0F)), hn::Gt(age, hn::Zero(kLanes)));
    const auto updates = hn::And(hn::And(is_end, is_known), hn::AndNot(is_hidden, is_better));
    const auto rise = hn::Sub(hn::Add(offset, hn::Mul(slope, at)), height);
    const auto update = hn::Mul(hn::Div(gain, hn::Max(age, set(1.0F))), rise);
    const auto updated = hn::Min(hn::Max(hn::Add(trend, update), hn::Neg(most)), most);
    const auto kept = hn::IfThenElse(updates, updated, trend);
    cells.store(hn::IfThenElse(hn::And(mask, is_hidden), hn::Zero(kLanes), kept), sector.trend);
    cells.store(entered, hn::IfThenElse(hn::AndNot(is_hidden, doubt), doubted, slack), sector.slack);
    cells.store(entered, offset, sector.offset);
    cells.store(entered, slope, sector.slope);
    cells.store(hn::IfThenElse(entered, hn::Zero(kLanes), age), sector.age);
  });
}

/// Expects the ground to go on beyond a stretch.
HWY_INLINE void extend(GroundMap::Sector& sector, const MapReports::Stretches& stretches, std::size_t i,
                       Middles middles) {
  const float rho = stretches.rho[i], slope = stretches.long_slope[i];
  const float farthest = rho + (kMaxBeyond - kBeyondStart) / kBeyond;
  const float offset = stretches.height[i] - slope * rho;
  const std::int32_t first = GroundMap::binOf(rho) + 1;
  if (first >= kMapBins) return;
  forBins(first, GroundMap::binOf(farthest), [&](std::size_t bin, Mask mask, Mask /*is_last*/) HWY_ATTR {
    const Cells cells{sector, bin};
    const auto way = hn::Sub(cells.load(middles), set(rho));
    const auto slack = hn::Add(set(kBeyondStart), hn::Mul(set(kBeyond), way));
    const auto entered =
        hn::And(mask, hn::And(hn::Le(slack, set(kMaxBeyond)), hn::Lt(slack, cells.load(sector.slack))));
    cells.store(entered, set(offset), sector.offset);
    cells.store(entered, set(slope), sector.slope);
    cells.store(entered, slack, sector.slack);
    cells.store(entered, hn::Zero(kLanes), sector.trend);
    cells.store(entered, hn::Zero(kLanes), sector.age);
  });
}

void enterReports(const Shown& shown, MapReports& reports, GroundMap::Sector* sectors) {
  Middles middles = GroundMap::middles();
  MapReports::Stretches& stretches = reports.stretches;
  seeThrough(shown, reports.block_number++, sectors, middles);
  const std::size_t count = collectStretches(shown, reports);
  measureStretches(stretches, count, shown.setting.max_slope, reports.unevenness);
  const float trend_gain = shown.turns_left ? kTrendGain : -kTrendGain;
  for (std::size_t i = 0; i < count; ++i)
    if (stretches.last[i] >= 0) addStretch(sectors[stretches.sector[i]], stretches, i, trend_gain, middles);
  for (std::size_t i = 0; i < count; ++i)
    if (stretches.is_last[i + 1] != 0) extend(sectors[stretches.sector[i]], stretches, i, middles);
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(enterReports);

void MapReports::begin(std::size_t lasers) {
  block_number = 0;
  unevenness = {};
  const std::size_t size = lasers + Block::kColumns;
  if (latest.size() >= size) return;
  for (auto* values : {&stretches.from_rho, &stretches.slope_before, &stretches.from_height, &stretches.rho,
                       &stretches.height, &stretches.long_slope, &stretches.slope, &stretches.offset, &stretches.ray})
    values->resize(size);
  for (auto* values : {&stretches.first, &stretches.last}) values->resize(size);
  for (auto* values : {&stretches.sector, &stretches.is_doubted, &stretches.is_last, &latest}) values->resize(size);
}

void MapReports::enter(const Shown& shown, GroundMap::Sector* sectors) {
  HWY_DYNAMIC_DISPATCH(enterReports)(shown, *this, sectors);
}

}  // namespace lisco::ground
#endif
