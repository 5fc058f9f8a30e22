// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cmath>

namespace lisco {

/// Cheap stand-ins for azimuth and elevation. A mask needs no true angles, only functions that grow with the
/// angle and never faster than a known rate: a bound on the angle between two returns then bounds their
/// difference. Both are built from g(t) = t + 0.3476 t (1 - t), which maps the slope t = tan(angle) of an
/// octant, 0 <= t <= 1, to 0..1 within 0.25 degrees of the octant's true fraction.
namespace view_angle {

/// d g / d angle lies between 0.97 and 1.059 per octant (pi/4); a generous upper bound.
inline constexpr double kSteepest = 1.06;
/// Bound on all float rounding in the two functions below and in what they are given (1e-6 of a turn).
inline constexpr double kRounding = 2e-6;

inline float octantFraction(float smaller, float larger) {
  const float t = larger > 0.0F ? smaller / larger : 0.0F;
  return t + 0.3476F * t * (1.0F - t);
}

/// Azimuth of (x, y) in turns, 0..1, counter-clockwise from +x. The z axis itself has azimuth 0.
inline float azimuth(float x, float y) {
  const float ax = std::fabs(x);
  const float ay = std::fabs(y);
  const float g = octantFraction(std::min(ax, ay), std::max(ax, ay));
  const float quadrant = ay > ax ? 2.0F - g : g;
  const float half = x < 0.0F ? 4.0F - quadrant : quadrant;
  return (y < 0.0F ? 8.0F - half : half) * 0.125F;
}

/// Elevation over the horizontal plane, 0 straight down to 1 straight up, of a return at horizontal distance rho.
inline float elevation(float rho, float z) {
  const float az = std::fabs(z);
  const float g = octantFraction(std::min(rho, az), std::max(rho, az));
  const float quadrant = az > rho ? 2.0F - g : g;
  return 0.5F + 0.25F * (z < 0.0F ? -quadrant : quadrant);
}

/// How far apart in azimuth (turns) two neighbours can lie, one of them at horizontal distance rho > reach:
/// the projection of the other lies in a disk of radius reach, which is seen under asin(reach / rho).
/// Elevations (0..1) of neighbours at distance d differ by at most twice this with d in place of rho.
inline double widest(double reach, double distance) {
  const double s = std::min(reach / distance * (1.0 + 1e-6), 1.0);
  const double asin_bound = s + 0.5708 * s * s * s;  // >= asin(s) on 0..1
  constexpr double kTurnsPerRadian = 0.15915494309189535;
  return asin_bound * (kSteepest * kTurnsPerRadian) + kRounding;
}

}  // namespace view_angle
}  // namespace lisco
