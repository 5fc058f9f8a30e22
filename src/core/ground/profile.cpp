// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/profile.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lisco::ground {
namespace {

/// Cells of a sector with returns, from the sensor outwards.
struct Outwards {
  std::array<Cell*, kBins> cells;
  std::array<float, kBins> low, rho;
  std::array<bool, kBins> bare;
  std::array<std::uint8_t, kBins> bins;
  std::size_t size = 0;

  explicit Outwards(Sector& sector) {
    forEachBin(sector, [&](std::size_t bin) {
      cells[size] = &sector.cells[bin];
      bins[size] = static_cast<std::uint8_t>(bin);
      low[size] = cells[size]->low();
      rho[size] = cells[size]->lowRho();
      ++size;
    });
    for (std::size_t i = 0; i < size; ++i) {
      std::uint64_t levels = cells[i]->levels;
      if (i + 1 < size && bins[i + 1] == bins[i] + 1) levels |= cells[i + 1]->levels;
      bare[i] = isBare(low[i], levels);
    }
  }

  /// The first bare cell clearly beyond one; `size` if there is none nearby.
  std::size_t beyond(std::size_t i) const {
    const float least = 1.12F * rho[i] + 0.2F;
    constexpr std::size_t kMost = 6;
    for (std::size_t j = i + 1; j < size && j < i + kMost; ++j)
      if (bare[j] && rho[j] >= least) return j;
    return size;
  }

  float slope(std::size_t i, std::size_t j) const { return (low[j] - low[i]) / (rho[j] - rho[i]); }

  /// Whether a cell and two beyond it lie on a line that meets a height beneath the sensor.
  bool isOnLineFrom(float height, std::size_t i, float max_slope) const {
    const std::size_t j = beyond(i);
    if (j >= size) return false;
    const std::size_t k = beyond(j);
    if (k >= size) return false;
    const float all = slope(i, k);
    return std::fabs(slope(j, k) - slope(i, j)) < 0.08F && std::fabs(all) < max_slope &&
           std::fabs(low[i] - all * rho[i] - height) < 0.12F + 0.02F * rho[i];
  }
};

/// Ground reached so far, and a part of it further inwards.
struct Reached {
  float rho, ground;
  float back_rho, back_ground;
  float next_rho, next_ground;  // becomes the back

  float slope(float max_slope) const {
    return rho > back_rho ? std::clamp((ground - back_ground) / (rho - back_rho), -max_slope, max_slope) : 0.0F;
  }
  void advance(float new_rho, float new_ground) {
    constexpr float kBaseline = 1.5F;  // metres
    rho = new_rho;
    ground = new_ground;
    if (rho - next_rho < kBaseline + 0.1F * rho) return;
    back_rho = next_rho;
    back_ground = next_ground;
    next_rho = rho;
    next_ground = ground;
  }
};

}  // namespace

void Profile::follow(Sector& sector, const Direction& direction, const Sector* beside) const {
  const Outwards outwards(sector);
  Reached reached{0.0F, plane_.height, 0.0F, plane_.height, 0.0F, plane_.height};
  const float first_slope = plane_.slopeTowards(direction);
  bool first = true;
  for (std::size_t i = 0; i < outwards.size; ++i) {
    Cell& cell = *outwards.cells[i];
    const float low = outwards.low[i];
    const float rho = outwards.rho[i];
    const bool bare = outwards.bare[i];
    const float distance = std::max(rho - reached.rho, 0.0F);
    const float slope = first ? first_slope : reached.slope(max_slope_);
    const float baseline = first ? rho : reached.rho - reached.back_rho;
    const float expected = reached.ground + slope * std::min(distance, 2.0F * baseline);
    const float above = low - expected;
    const float from_back = std::max(rho - reached.back_rho, 0.0F);
    const float rise = low - reached.back_ground;
    bool found;
    if (first)
      found = above > -0.2F - 0.12F * distance &&
              (above < (bare ? 0.1F + 0.04F * distance : 0.1F + 0.03F * distance) ||
               (bare && std::min(above, low - plane_.height) < 0.12F + 0.09F * std::min(distance, 8.0F) &&
                outwards.isOnLineFrom(plane_.height, i, max_slope_)));
    else if (bare)
      found = above < 0.12F + std::min(max_slope_ * distance, 0.15F + 0.02F * distance) &&
              above > -0.2F - std::min(max_slope_ * distance, 0.3F) && rise < 0.15F + max_slope_ * from_back;
    else
      found = above < 0.1F + std::min(0.15F * distance, 0.06F) &&
              above > -0.2F - std::min(max_slope_ * distance, 0.3F) && rise < 0.12F + max_slope_ * from_back;
    if (!found && !first && bare && std::fabs(low - reached.ground) < 0.1F + max_slope_ * distance) {
      // A change of slope, if the next cell continues it.
      const std::size_t next = outwards.beyond(i);
      if (next < outwards.size) {
        const float here = (low - reached.ground) / std::max(distance, 0.5F);
        const float step = outwards.rho[next] - rho;
        const float further = outwards.slope(i, next);
        found = std::fabs(further) < max_slope_ && std::fabs(further - here) < 0.07F + 0.03F / step;
        if (found && distance > 3.0F + 0.15F * rho) {
          const std::size_t last = outwards.beyond(next);
          found = last < outwards.size && std::fabs(outwards.slope(next, last) - further) < 0.1F;
        }
      }
    }
    int confidence = found ? 8 : 0;
    const std::size_t bin = outwards.bins[i];
    if (!found && beside != nullptr && beside->has(bin) && beside->cells[bin].confidence > 1) {
      const Cell& other = beside->cells[bin];
      const float above_beside = low - (other.offset + other.slope * rho);
      const float width = 0.0245F * rho;
      found = std::fabs(above_beside) < (bare ? 0.08F + 0.05F * width : 0.06F) &&
              std::fabs(low - reached.ground) < 0.2F + max_slope_ * distance;
      if (found) confidence = other.confidence - 1;
    }
    cell.confidence = confidence;
    if (found) {
      first = false;
      reached.advance(rho, low);
      cell.slope = reached.slope(max_slope_);
      cell.offset = low - cell.slope * rho;
      cell.tolerance = bare ? 0.15F : 0.05F;
    } else if (above < 0.0F) {  // a reflection, perhaps
      cell.slope = slope;
      cell.offset = expected - slope * rho;
      cell.tolerance = 0.1F;
    } else {
      cell.offset = low;
      cell.slope = 0.0F;
      cell.tolerance = -1e30F;
    }
  }
}

}  // namespace lisco::ground
