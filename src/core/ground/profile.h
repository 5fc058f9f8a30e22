// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "core/ground/plane_estimator.h"
#include "core/ground/polar_grid.h"

namespace lisco::ground {

/// Follows the ground of a sector outwards, and sets `ground`, `slope` and `observed` of its cells.
class Profile {
 public:
  /// \param plane the ground around the sensor
  /// \param max_slope metres per metre
  Profile(const Plane& plane, float max_slope) : plane_(plane), max_slope_(max_slope) {}

  /// \param beside a sector beside this one whose ground is known, or null
  /// \param direction of the sector
  void follow(Sector& sector, const Direction& direction, const Sector* beside) const;

 private:
  Plane plane_;
  float max_slope_;
};

}  // namespace lisco::ground
