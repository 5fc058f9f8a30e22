// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bits.h"

namespace lisco::ground {
void Profile::follow(Sector& sector, const Sector* beside) const {
  constexpr float kBaseline = 1.5F;  // metres over which steps may not add up
  float ground = start_;
  float slope = 0.0F;
  float last_rho = 0.0F;
  float back_rho = 0.0F, back_ground = start_;  // ground at least a baseline inwards
  float next_rho = 0.0F, next_ground = start_;  // the next one to become that
  forEachBin(sector, [&](std::size_t bin) {
    Cell& cell = sector.cells[bin];
    const float distance = std::max(cell.low_rho - last_rho, 0.0F);
    const float from_back = std::max(cell.low_rho - back_rho, 0.0F);
    const bool bare = isBare(cell);
    const float back_slope = back_rho == 0.0F ? 0.07F : max_slope_;
    const float expected = ground + slope * std::min(distance, 2.0F);
    const float above = cell.low - expected;
    bool found;
    if (last_rho == 0.0F)
      found = std::fabs(above) < (bare ? 0.12F + 0.07F * distance : 0.1F + 0.04F * distance);
    else if (bare)
      found = above < 0.15F + std::min(max_slope_ * distance, 0.15F + 0.02F * distance) &&
              above > -0.2F - max_slope_ * distance && cell.low - back_ground < 0.15F + back_slope * from_back;
    else
      found = above < 0.12F + std::min(0.15F * distance, 0.08F) &&
              above > -0.2F - std::min(max_slope_ * distance, 0.4F) &&
              cell.low - back_ground < 0.12F + back_slope * from_back;
    int confidence = found ? 8 : 0;
    if (!found && beside != nullptr && beside->has(bin) && beside->cells[bin].confidence > 1) {
      const Cell& other = beside->cells[bin];
      const float above_beside = cell.low - (other.ground + other.slope * (cell.low_rho - other.low_rho));
      const float width = 0.0245F * cell.low_rho;
      found = std::fabs(above_beside) < (bare ? 0.1F + 0.1F * width : 0.08F) &&
              std::fabs(above) < 0.3F + max_slope_ * distance;
      if (found) confidence = other.confidence - 1;
    }
    cell.confidence = static_cast<std::int8_t>(confidence);
    if (found) {
      if (distance > 0.2F) {
        const float new_slope = std::clamp((cell.low - ground) / distance, -max_slope_, max_slope_);
        const float weight = std::min(0.7F, distance * 0.4F);
        slope += weight * (new_slope - slope);
      }
      ground = cell.low;
      last_rho = cell.low_rho;
      if (next_rho == 0.0F) {
        next_rho = last_rho;
        next_ground = ground;
      } else if (last_rho - next_rho > kBaseline) {
        back_rho = next_rho;
        back_ground = next_ground;
        next_rho = last_rho;
        next_ground = ground;
      }
      cell.ground = ground;
      cell.slope = slope;
      cell.tolerance = bare ? 0.15F : 0.05F;
    } else if (above < 0) {  // a reflection, perhaps
      cell.ground = expected;
      cell.slope = slope;
      cell.tolerance = 0.1F;
    } else {
      cell.ground = cell.low;
      cell.slope = 0.0F;
      cell.tolerance = -1e30F;
    }
  });
}

}  // namespace lisco::ground
