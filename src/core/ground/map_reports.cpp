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

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using ground::GroundMap;
using ground::Report;
using ground::Stretch;

using BinFloats = hn::CappedTag<float, 8>;
using BinInts = hn::RebindToSigned<BinFloats>;
using BinVector = hn::Vec<BinFloats>;
using BinMask = hn::Mask<BinFloats>;
constexpr BinFloats kBinFloats{};
constexpr BinInts kBinInts{};

constexpr float kAlong = 0.05F;        // metres per metre, by which the ground may rise unseen between two returns
constexpr float kBeyond = 0.1F;        // metres per metre, the same beyond the last one
constexpr float kBeyondStart = 0.02F;  // metres, the same
constexpr float kMaxBeyond = 1.5F;     // metres
constexpr float kStep = 0.25F;         // metres; higher ones are no ground, even if they were found to be
constexpr float kTrendGain = 0.3F;
constexpr float kMaxTrend = 0.005F;     // metres per metre of distance
constexpr float kMarginSame = 0.01F;    // metres
constexpr float kMarginRay = 0.1F;      // metres
constexpr float kMarginHidden = 0.05F;  // metres
constexpr float kDoubt = 0.01F;         // metres

HWY_INLINE BinVector set(float value) {
  return hn::Set(kBinFloats, value);
}

/// Calls visit(bin, mask) for the bins from first to last, some at a time: those of the mask, from `bin` on.
template <typename Visit>
HWY_INLINE void forBins(std::size_t first, std::size_t last, Visit&& visit) {
  constexpr std::size_t kTogether = hn::MaxLanes(kBinFloats);
  const auto int32 = [](std::size_t value) HWY_ATTR { return hn::Set(kBinInts, static_cast<std::int32_t>(value)); };
  for (std::size_t bin = first - first % kTogether; bin <= last; bin += kTogether) {
    const auto bins = hn::Add(hn::Iota(kBinInts, 0), int32(bin));
    visit(bin, hn::RebindMask(kBinFloats, hn::And(hn::Gt(bins, int32(first - 1)), hn::Lt(bins, int32(last + 1)))));
  }
}

/// The values of a sector's cells from a bin on.
struct Cells {
  HWY_INLINE BinVector load(const GroundMap::Values& values) const { return hn::LoadU(kBinFloats, &values[bin]); }
  HWY_INLINE void store(BinMask mask, BinVector value, GroundMap::Values& values) const {
    hn::StoreU(hn::IfThenElse(mask, value, load(values)), kBinFloats, &values[bin]);
  }
  HWY_INLINE BinVector heightAt(BinVector rho) const {
    return hn::Add(load(sector.offset), hn::Mul(load(sector.slope), rho));
  }

  const GroundMap::Sector& sector;
  std::size_t bin;
};

using Middles = const GroundMap::Values&;

HWY_INLINE void seeThrough(const Report& report, Middles middles) {
  const std::size_t first = GroundMap::binOf(report.seen_from) + 1, end = GroundMap::binOf(report.seen_to);
  if (first >= end) return;
  const float slope = report.seen_height / report.seen_to;
  forBins(first, end - 1, [&](std::size_t bin, BinMask mask) HWY_ATTR {
    const Cells cells{*report.sector, bin};
    const auto middle = cells.load(middles);
    const auto ray = hn::Add(hn::Mul(set(slope), middle), set(kMarginRay));
    cells.store(hn::And(mask, hn::Gt(cells.heightAt(middle), ray)), set(GroundMap::kUnknown), report.sector->slack);
  });
}

/// Updates the trend in the bin of the farthest return.
HWY_INLINE void addTrend(GroundMap::Sector& sector, const Stretch& stretch, float offset, float slope, bool turns_left,
                         Middles middles) {
  const std::size_t bin = GroundMap::binOf(stretch.rho);
  if (sector.slack[bin] >= 1.0F || sector.age[bin] <= 0.0F) return;
  const float at = middles[bin], before = sector.heightAt(bin, at);
  const float slack = kAlong * std::max(0.0F, std::min(at - stretch.from_rho, stretch.rho - at));
  if (before > stretch.height / stretch.rho * at + kMarginHidden || slack > sector.slack[bin] + kMarginSame) return;
  const float gain = (turns_left ? kTrendGain : -kTrendGain) / sector.age[bin];
  const float most = kMaxTrend * stretch.rho;
  sector.trend[bin] = std::clamp(sector.trend[bin] + gain * (offset + slope * at - before), -most, most);
}

HWY_INLINE void addStretch(GroundMap::Sector& sector, const Stretch& stretch, float max_slope, bool turns_left,
                           Middles middles) {
  const float length = stretch.rho - stretch.from_rho;
  const float rise = stretch.height - stretch.from_height;
  if (length < 1e-3F || rise > kStep + max_slope * length) return;
  const float slope = length > 0.3F ? std::clamp(rise / length, -max_slope, max_slope) : stretch.slope;
  const float offset = stretch.height - slope * stretch.rho;
  const auto ray = set(stretch.height / stretch.rho);
  addTrend(sector, stretch, offset, slope, turns_left, middles);
  forBins(GroundMap::binOf(stretch.from_rho), GroundMap::binOf(stretch.rho),
          [&](std::size_t bin, BinMask mask) HWY_ATTR {
            const Cells cells{sector, bin};
            const auto at = cells.load(middles);
            const auto inside = hn::Min(hn::Sub(at, set(stretch.from_rho)), hn::Sub(set(stretch.rho), at));
            const auto slack = hn::Mul(set(kAlong), hn::Max(hn::Zero(kBinFloats), inside));
            const auto before = cells.load(sector.slack);
            // The return would have been hidden.
            const auto is_hidden = hn::Gt(cells.heightAt(at), hn::Add(hn::Mul(ray, at), set(kMarginHidden)));
            const auto is_better = hn::Le(slack, hn::Add(before, set(kMarginSame)));
            const auto doubted = hn::Min(hn::Add(hn::Max(slack, before), set(kDoubt)), set(GroundMap::kUnknown));
            const auto entered = hn::And(mask, hn::Or(is_hidden, is_better));
            cells.store(hn::And(mask, is_hidden), hn::Zero(kBinFloats), sector.trend);
            cells.store(entered, stretch.is_doubted ? hn::IfThenElse(is_hidden, slack, doubted) : slack, sector.slack);
            cells.store(entered, set(offset), sector.offset);
            cells.store(entered, set(slope), sector.slope);
            cells.store(entered, hn::Zero(kBinFloats), sector.age);
          });
}

/// Expects the ground to go on beyond a stretch.
HWY_INLINE void extend(GroundMap::Sector& sector, const Stretch& stretch, Middles middles) {
  const float farthest = stretch.rho + (kMaxBeyond - kBeyondStart) / kBeyond;
  const auto slackAt = [&](BinVector at) HWY_ATTR {
    return hn::Add(set(kBeyondStart), hn::Mul(set(kBeyond), hn::Sub(at, set(stretch.rho))));
  };
  const std::size_t first = GroundMap::binOf(stretch.rho) + 1;
  if (first >= GroundMap::kBins) return;
  forBins(first, GroundMap::binOf(farthest), [&](std::size_t bin, BinMask mask) HWY_ATTR {
    const Cells cells{sector, bin};
    const auto slack = slackAt(cells.load(middles));
    const auto entered =
        hn::And(mask, hn::And(hn::Le(slack, set(kMaxBeyond)), hn::Lt(slack, cells.load(sector.slack))));
    cells.store(entered, set(stretch.height - stretch.slope * stretch.rho), sector.offset);
    cells.store(entered, set(stretch.slope), sector.slope);
    cells.store(entered, slack, sector.slack);
    cells.store(entered, hn::Zero(kBinFloats), sector.trend);
    cells.store(entered, hn::Zero(kBinFloats), sector.age);
  });
}

void enterReports(const std::vector<Report>& reports, float max_slope, bool turns_left) {
  Middles middles = GroundMap::middles();
  for (const Report& report : reports) {
    if (report.seen_to > report.seen_from) seeThrough(report, middles);
    if (report.has_ground) addStretch(*report.sector, report.stretch, max_slope, turns_left, middles);
  }
  for (const Report& report : reports)
    if (report.has_ground && report.is_last) extend(*report.sector, report.stretch, middles);
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(enterReports);

void ground::enterReports(const std::vector<Report>& reports, float max_slope, bool turns_left) {
  HWY_DYNAMIC_DISPATCH(enterReports)(reports, max_slope, turns_left);
}

}  // namespace lisco
#endif
