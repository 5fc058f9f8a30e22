// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/ground_map.h"

#include <cmath>

#include "core/ground/direction.h"

namespace lisco::ground {
namespace {

constexpr float kSectorWidth = 6.2831853F / static_cast<float>(kSectors);  // radians
constexpr std::uint32_t kFresh = 40;   // blocks after which a sector shows the rotation before
constexpr std::uint32_t kRecent = 16;  // blocks, of a sector beside
constexpr std::size_t kReach = 12;     // sectors
constexpr float kAcross = 0.06F;       // metres per metre, by which the ground may rise unseen across the sectors
constexpr float kAlong = 0.05F;        // metres per metre, the same between two returns
constexpr float kBeyond = 0.1F;        // metres per metre, the same beyond the last one
constexpr float kMostBeyond = 1.5F;    // metres
constexpr float kStep = 0.25F;         // metres; higher ones are no ground, even if they were found to be
constexpr float kTrendGain = 0.3F;
constexpr float kMostTrend = 0.005F;    // metres per metre of distance
constexpr float kMarginSame = 0.01F;    // metres
constexpr float kMarginRay = 0.1F;      // metres
constexpr float kMarginHidden = 0.05F;  // metres
constexpr float kDoubt = 0.01F;         // metres

/// Distances in the middle of the bins, metres.
const std::array<float, GroundMap::kBins>& middles() {
  static const std::array<float, GroundMap::kBins> values = [] {
    std::array<float, GroundMap::kBins> all;
    for (std::size_t bin = 0; bin < all.size(); ++bin) {
      const std::int32_t bits = (static_cast<std::int32_t>(bin) + GroundMap::kFirstBin) << GroundMap::kBinShift;
      float squared;
      std::memcpy(&squared, &bits, sizeof squared);
      all[bin] = 1.02F * std::sqrt(squared);
    }
    return all;
  }();
  return values;
}

}  // namespace

void GroundMap::begin(float max_slope) {
  max_slope_ = max_slope;
  sectors_.resize(kSectors);
  for (Sector& sector : sectors_) sector = Sector();
}

GroundMap::Sector& GroundMap::sectorAt(float azimuth, std::uint32_t block, const Plane& plane) {
  const std::size_t number = static_cast<std::size_t>(azimuth / kSectorWidth) % kSectors;
  Sector& sector = sectors_[number];
  if (sector.block == 0 || block - sector.block > kFresh) renew(number, block, plane);
  sector.block = block;
  return sector;
}

void GroundMap::renew(std::size_t number, std::uint32_t block, const Plane& plane) {
  Sector& sector = sectors_[number];
  const auto isRecent = [&](std::size_t other) {
    return sectors_[other].block != 0 && block - sectors_[other].block <= kRecent;
  };
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

void GroundMap::seeThrough(Sector& sector, float from_rho, float rho, float ray) {
  const std::size_t end = binOf(rho);
  const float* const middle = middles().data();
  for (std::size_t bin = binOf(from_rho) + 1; bin < end; ++bin)
    if (sector.heightAt(bin, middle[bin]) > ray * middle[bin] + kMarginRay) sector.forget(bin);
}

void GroundMap::add(Sector& sector, const Stretch& stretch, bool turns_left) const {
  const auto [from_rho, from_height, rho, height, long_slope, is_doubted] = stretch;
  const float length = rho - from_rho;
  const float rise = height - from_height;
  if (length < 1e-3F || rise > kStep + max_slope_ * length) return;
  const float slope = length > 0.3F ? std::clamp(rise / length, -max_slope_, max_slope_) : long_slope;
  const float offset = height - slope * rho;
  const float ray = height / rho;
  const std::size_t last = binOf(rho);
  const float* const middle = middles().data();
  for (std::size_t bin = binOf(from_rho); bin <= last; ++bin) {
    const float at = middle[bin];
    const float slack = kAlong * std::max(0.0F, std::min(at - from_rho, rho - at));
    const float before = sector.heightAt(bin, at);
    if (before > ray * at + kMarginHidden) {  // the return would have been hidden
      sector.trend[bin] = 0.0F;
      sector.slack[bin] = slack;
    } else if (slack <= sector.slack[bin] + kMarginSame) {
      if (bin == last && sector.slack[bin] < 1.0F && sector.age[bin] > 0.0F) {
        const float gain = (turns_left ? kTrendGain : -kTrendGain) / sector.age[bin];
        sector.trend[bin] =
            std::clamp(sector.trend[bin] + gain * (offset + slope * at - before), -kMostTrend * rho, kMostTrend * rho);
      }
      sector.slack[bin] = is_doubted ? std::min(std::max(slack, sector.slack[bin]) + kDoubt, kUnknown) : slack;
    } else {
      continue;
    }
    sector.offset[bin] = offset;
    sector.slope[bin] = slope;
    sector.age[bin] = 0.0F;
  }
}

void GroundMap::extend(Sector& sector, const Stretch& stretch) {
  const float* const middle = middles().data();
  for (std::size_t bin = binOf(stretch.rho) + 1; bin < kBins; ++bin) {
    const float slack = 0.02F + kBeyond * (middle[bin] - stretch.rho);
    if (slack > kMostBeyond) break;
    if (slack >= sector.slack[bin]) continue;
    sector.offset[bin] = stretch.height - stretch.slope * stretch.rho;
    sector.slope[bin] = stretch.slope;
    sector.slack[bin] = slack;
    sector.trend[bin] = sector.age[bin] = 0.0F;
  }
}

}  // namespace lisco::ground
