// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/ground_map.h"

#include <cmath>

#include "core/ground/direction.h"
#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/ground_map.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Starts a sector with what is known some sectors away.
/// \param sectors how many; negative: clockwise
/// \param slope by which that of the ground is higher
/// \param per_metre what is added to the slack at each metre
void copySector(const GroundMap::Sector& from, float sectors, float slope, float per_metre, GroundMap::Sector& to) {
  constexpr hn::CappedTag<float, 8> kBins{};
  const auto set = [&](float value) HWY_ATTR { return hn::Set(kBins, value); };
  const GroundMap::Values& middles = GroundMap::middles();
  const auto turned = set(sectors), aged = set(std::fabs(sectors)), steeper = set(slope), growth = set(per_metre);
  for (std::size_t bin = 0; bin < GroundMap::kBins; bin += hn::MaxLanes(kBins)) {
    const auto load = [bin, kBins](const GroundMap::Values& values) HWY_ATTR { return hn::LoadU(kBins, &values[bin]); };
    const auto store = [bin, kBins](hn::Vec<decltype(kBins)> value, GroundMap::Values& values)
                           HWY_ATTR { hn::StoreU(value, kBins, &values[bin]); };
    const auto trend = load(from.trend);
    store(hn::Add(load(from.offset), hn::Mul(trend, turned)), to.offset);
    store(hn::Add(load(from.slope), steeper), to.slope);
    store(trend, to.trend);
    store(hn::Add(load(from.age), aged), to.age);
    const auto slack = hn::Add(load(from.slack), hn::Mul(growth, load(middles)));
    store(hn::Min(slack, set(GroundMap::kUnknown)), to.slack);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(copySector);

namespace {

// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr std::uint32_t kRecent = 16;  // blocks, of a sector beside
constexpr std::size_t kReach = 12;     // sectors
constexpr float kAcross = 0.06F;       // metres per metre, by which the ground may rise unseen across the sectors

}  // namespace

const GroundMap::Values& GroundMap::middles() {
  alignas(64) static const Values values = [] {
    Values all;
    for (std::size_t bin = 0; bin < all.size(); ++bin)
      all[bin] = 1.02F * std::sqrt(squaredDistanceOf(static_cast<std::int32_t>(bin)));
    return all;
  }();
  return values;
}

void GroundMap::begin() {
  sectors_.resize(kSectors);
  latest_.fill(0);
}

void GroundMap::renew(std::size_t number, std::uint32_t block, const Plane& plane) {
  Sector& sector = sectors_[number];
  const auto isRecent = [&](std::size_t other) { return latest_[other] != 0 && block - latest_[other] <= kRecent; };
  for (std::size_t step = 1; step <= kReach; ++step) {
    const std::size_t left = (number + step) % kSectors;
    const std::size_t right = (number + kSectors - step) % kSectors;
    const bool from_left = isRecent(left);
    if (!from_left && !isRecent(right)) continue;
    const Sector& from = sectors_[from_left ? left : right];
    const auto sectors = static_cast<float>(step);
    const float turned = from_left ? -sectors : sectors;
    // The ground's plane, seen in another direction, has another slope.
    const float slope =
        plane.slopeTowards(directionOf(number)) - plane.slopeTowards(directionOf(from_left ? left : right));
    const float per_metre = kAcross * kSectorWidth * sectors;
    HWY_DYNAMIC_DISPATCH(copySector)(from, turned, slope, per_metre, sector);
    return;
  }
  sector = Sector();
}

}  // namespace lisco::ground
#endif
