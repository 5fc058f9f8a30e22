// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "simulation/vector.h"

namespace lisco_simulation {

/// The part of a ray inside a solid, in metres from the sensor; empty if enter > leave.
struct Interval {
  double enter, leave;
};

struct Sphere {
  Vector centre;
  double radius;  ///< metres
};

/// A horizontal rectangle: the bottom or the top of a block.
struct Rectangle {
  double back, front;  ///< x
  double right, left;  ///< y
  double z;
};

/// A convex solid: the intersection of half-spaces and optionally a quadric (a ball or an endless cylinder, scaled and
/// rotated). A ray meets it in at most one interval.
///
/// Analytic shapes are round at any range and need no ray-casting library; a scan of 72,000 rays takes under 20 ms.
class Solid {
 public:
  /// Between two horizontal rectangles, which may differ and may be as thin as a line: car bodies and roofs slant. The
  /// sides are planes through parallel edges.
  static Solid block(const Rectangle& bottom, const Rectangle& top);
  /// A box with its sides along the axes. \param low, high opposite corners
  static Solid box(const Vector& low, const Vector& high);
  /// A cylinder with flat ends. \param from, to centres of the ends, not equal \param radius metres
  static Solid cylinder(const Vector& from, const Vector& to, double radius);
  /// \param radii along x, y, z, metres
  static Solid ellipsoid(const Vector& centre, const Vector& radii);

  /// The same solid of leaves, which a ray enters to a random depth, or passes.
  /// \param mean_depth mean way through leaves, metres, > 0
  Solid ofLeaves(double mean_depth) const;
  /// Rotated about the vertical axis through (0, 0), counterclockwise seen from above. \param angle radians
  Solid rotated(double angle) const;
  Solid moved(const Vector& by) const;

  /// Lifted by x * slope.x + y * slope.y: upright edges stay upright, level ones follow a slope.
  Solid sheared(const Vector& slope) const;

  /// The part inside of the ray from a position. \param direction of length 1
  Interval along(const Vector& direction, const Vector& from = {}) const;

  /// Whether a position is inside, or outside by at most about `margin` metres.
  bool contains(const Vector& place, double margin = 0) const;

  /// A sphere around the solid.
  const Sphere& bounds() const { return bounds_; }

  /// Metres; 0: no leaves.
  double meanDepth() const { return mean_depth_; }

 private:
  /// The half-space normal * p <= limit; the normal has length 1.
  struct Plane {
    Vector normal;
    double limit;
  };

  void addPlane(const Vector& normal, const Vector& through);

  /// The quadric |A (p - centre)| <= 1 by the rows of A: three of an ellipsoid, two of a cylinder, or none.
  std::vector<Vector> rows_;
  Vector centre_;
  std::vector<Plane> planes_;
  Sphere bounds_{{}, 0};
  double mean_depth_ = 0;
};

}  // namespace lisco_simulation
