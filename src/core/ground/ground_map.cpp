// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/ground_map.h"

#include <cmath>

#include "core/ground/direction.h"

namespace lisco::ground {
namespace {

constexpr std::uint32_t kRecent = 16;  // blocks, of a sector beside
constexpr std::size_t kReach = 12;     // sectors
constexpr float kAcross = 0.06F;       // metres per metre, by which the ground may rise unseen across the sectors

}  // namespace

const GroundMap::Values& GroundMap::middles() {
  static const Values values = [] {
    Values all;
    for (std::size_t bin = 0; bin < all.size(); ++bin) {
      const std::int32_t bits = (static_cast<std::int32_t>(bin) + kFirstBin) << kBinShift;
      float squared;
      std::memcpy(&squared, &bits, sizeof squared);
      all[bin] = 1.02F * std::sqrt(squared);
    }
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
    const float* const middle = middles().data();
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      sector.offset[bin] = from.offset[bin] + from.trend[bin] * turned;
      sector.slope[bin] = from.slope[bin] + slope;
      sector.trend[bin] = from.trend[bin];
      sector.age[bin] = from.age[bin] + sectors;
      sector.slack[bin] = std::min(from.slack[bin] + per_metre * middle[bin], kUnknown);
    }
    return;
  }
  sector = Sector();
}

}  // namespace lisco::ground
