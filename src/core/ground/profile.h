// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "core/ground/polar_grid.h"

namespace lisco::ground {

/// Follows the ground of a sector outwards, and sets `ground`, `slope` and `observed` of its cells.
class Profile {
 public:
  /// \param start height of the ground beneath the sensor, metres above the sensor's horizon
  /// \param max_slope metres per metre
  Profile(float start, float max_slope) : start_(start), max_slope_(max_slope) {}

  /// \param beside a sector beside this one whose ground is known, or null
  void follow(Sector& sector, const Sector* beside) const;

 private:
  float start_;
  float max_slope_;
};

}  // namespace lisco::ground
