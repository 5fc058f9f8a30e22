// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "core/ground/ground_map.h"

namespace lisco::ground {

/// Ground found from `from_rho` to `rho`.
struct Stretch {
  float from_rho, from_height, rho, height;
  float slope;      ///< of the ground up to rho, over a longer way
  bool is_doubted;  ///< it is not where the ground before lets expect it
};

/// What a row of a block shows in a sector of the map.
struct Report {
  GroundMap::Sector* sector;
  float seen_from, seen_to;  ///< metres; a ray passes above the ground from one distance to the other
  float seen_height;         ///< where it ends, metres
  bool has_ground;
  bool is_last;     ///< no ground has been found beyond
  Stretch stretch;  ///< if it has ground
};

/// Enters what the rows have shown, in their order; then, beyond the last ground, that it is expected to go on.
/// \param turns_left sense of rotation
void enterReports(const std::vector<Report>& reports, float max_slope, bool turns_left);

}  // namespace lisco::ground
