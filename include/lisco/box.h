// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>

#include "lisco/tolerance.h"

namespace lisco {

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
