// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bits.h"

namespace lisco::ground {
namespace {

template <typename Visit>
void forEachBin(const Sector& sector, Visit&& visit) {
  for (std::size_t word = 0; word < sector.occupied.size(); ++word)
    forEachBit(sector.occupied[word], [&](std::size_t bit) { visit(word * 64 + bit); });
}

}  // namespace

void Profile::follow(Sector& sector, const Sector* beside) const {
  float ground = start_;
  float slope = 0.0F;
  float last_rho = 0.0F;
  forEachBin(sector, [&](std::size_t bin) {
    Cell& cell = sector.cells[bin];
    const float distance = std::max(cell.low_rho - last_rho, 0.0F);
    float expected = ground + slope * distance;
    float tolerance = 0.2F + std::min(max_slope_ * distance, 0.3F + 0.08F * distance);
    if (beside != nullptr && beside->has(bin) && beside->cells[bin].observed) {
      const Cell& other = beside->cells[bin];
      expected = other.ground + other.slope * (cell.low_rho - other.low_rho);
      tolerance = 0.15F + max_slope_ * 0.025F * cell.low_rho;
    }
    cell.observed = std::fabs(cell.low - expected) <= tolerance;
    if (cell.observed) {
      const float new_slope = distance > 0.3F ? (cell.low - ground) / distance : slope;
      slope = std::clamp(0.5F * slope + 0.5F * new_slope, -max_slope_, max_slope_);
      ground = cell.low;
      last_rho = cell.low_rho;
      cell.ground = ground;
    } else {
      cell.ground = expected;
    }
    cell.slope = slope;
  });
}

float findStart(const Sector& sector, float max_slope) {
  constexpr float kNear = 25.0F;
  constexpr int kMinCells = 3;
  float best = std::numeric_limits<float>::quiet_NaN();
  int most = kMinCells - 1;
  forEachBin(sector, [&](std::size_t candidate) {
    const Cell& cell = sector.cells[candidate];
    if (cell.low_rho > kNear || !(cell.low < 0.0F)) return;
    int count = 0;
    forEachBin(sector, [&](std::size_t bin) {
      const Cell& other = sector.cells[bin];
      count += std::fabs(other.low - cell.low) < 0.1F + 0.2F * max_slope * std::fabs(other.low_rho - cell.low_rho);
    });
    if (count <= most) return;
    most = count;
    best = cell.low;
  });
  return best;
}

}  // namespace lisco::ground
