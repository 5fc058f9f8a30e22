// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cmath>

namespace lisco {

/// The exact predicate: two points are neighbours iff squaredDistance of their differences is less than
/// Tolerance::squared (), in float, with each operation rounded in this order (doc/contract.md). Files that use it are
/// compiled with -ffp-contract=off: a fused multiply-add changes d2 for most pairs. The vectorized form is
/// areNeighbours in lanes-inl.h; all else that rejects or accepts pairs is a bound on it: Tolerance::reach () and Box
/// here, and those of doc/algorithm.md, "The predicate and its bounds".
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

/// Axis-aligned bounding box of some returns. Its tests are exact, without any margin: rounding is monotone, so
/// the same float formula applied to a larger (smaller) difference per axis never gives a smaller (larger) d2.
struct Box {
  float lo[3], hi[3];

  static Box around(float x, float y, float z) { return {{x, y, z}, {x, y, z}}; }

  void add(const Box& other) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], other.lo[axis]);
      hi[axis] = std::max(hi[axis], other.hi[axis]);
    }
  }

  /// If this is not below the squared tolerance, no point of a and point of b are neighbours.
  static float squaredGap(const Box& a, const Box& b) {
    const float dx = std::max(std::max(a.lo[0] - b.hi[0], b.lo[0] - a.hi[0]), 0.0F);
    const float dy = std::max(std::max(a.lo[1] - b.hi[1], b.lo[1] - a.hi[1]), 0.0F);
    const float dz = std::max(std::max(a.lo[2] - b.hi[2], b.lo[2] - a.hi[2]), 0.0F);
    return squaredDistance(dx, dy, dz);
  }

  /// If this is below the squared tolerance, every point of a and every point of b are neighbours (and so are
  /// the points of each among themselves).
  static float squaredSpan(const Box& a, const Box& b) {
    const float dx = std::max(a.hi[0], b.hi[0]) - std::min(a.lo[0], b.lo[0]);
    const float dy = std::max(a.hi[1], b.hi[1]) - std::min(a.lo[1], b.lo[1]);
    const float dz = std::max(a.hi[2], b.hi[2]) - std::min(a.lo[2], b.lo[2]);
    return squaredDistance(dx, dy, dz);
  }
};

}  // namespace lisco
