// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

namespace lisco {

/// A point of the x-y plane, metres.
struct PlanePoint {
  double x, y;
};

/// The corners of the convex hull, counterclockwise, without those on the line between their neighbours. One corner if
/// all points are equal, two if all lie on a line.
/// \param points one or more
std::vector<PlanePoint> convexHull(const std::vector<PlanePoint>& points);

}  // namespace lisco
