// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cmath>

namespace lisco {

/// The arithmetic that decides whether two points are neighbours, exactly as PCL's kd-tree does it:
/// d2 = ((dx*dx) + dy*dy) + dz*dz in float, neighbours iff d2 < (float)((double)tol * tol).
/// Files that use it are compiled with -ffp-contract=off: a fused multiply-add changes d2 for most pairs.
inline float squaredDistance(float dx, float dy, float dz) {
  return (dx * dx + dy * dy) + dz * dz;
}

/// The cluster tolerance eps of Definition 1 of the paper.
class Tolerance {
 public:
  /// \param metres eps; a negative value acts as its absolute value; 0 and NaN make no two points neighbours;
  ///        an infinite one makes all points neighbours whose squared distance does not overflow a float.
  explicit Tolerance(float metres = 0.0F)
      : squared_(static_cast<float>(static_cast<double>(metres) * static_cast<double>(metres))) {
    // No pair further apart than this passes the float test. The factor covers the test's rounding, the
    // summand its underflow, and the cap stands where d2 itself overflows to infinity.
    constexpr double kRounding = 1.0 + 1e-6;
    constexpr double kUnderflow = 1e-44;
    constexpr double kOverflow = 1.85e19;
    reach_ =
        squared_ > 0.0F ? std::min(std::sqrt(static_cast<double>(squared_) * kRounding + kUnderflow), kOverflow) : 0.0;
  }

  /// The squared tolerance the test compares with; may be 0, infinite or NaN.
  float squared() const { return squared_; }

  /// Upper bound, in metres, on the true distance between two neighbours; 0 if there are none.
  double reach() const { return reach_; }

  /// False if no two points can be neighbours, not even equal ones (eps 0 or NaN, or eps^2 underflows to 0).
  bool joinsAnything() const { return squared_ > 0.0F; }

 private:
  float squared_;
  double reach_;
};

}  // namespace lisco
