// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "vector.h"

namespace lisco_simulation {

/// Where a ray is inside a solid, in metres from the sensor; nowhere if enter > leave.
struct Interval {
  double enter, leave;
};

struct Sphere {
  Vector centre;
  double radius;  ///< metres
};

/// A horizontal rectangle, as the bottom and the top of a block are.
struct Rectangle {
  double back, front;  ///< x
  double right, left;  ///< y
  double z;
};

/// A convex solid, which a ray from the sensor meets in at most one interval. It is what lies within a quadric (a ball
/// or an endless cylinder, scaled and turned as one likes; or none) and behind any number of planes. The interval of a
/// ray is the intersection of its intervals behind each of them.
///
/// Analytic shapes rather than triangles and a ray-casting library: balls and cylinders stay round from near and far,
/// no dependency is added, and a tree of triangles would have little to win. A scene has 200 to 500 solids, of which a
/// ray is held against few; `lisco_simulate --scene 3 -o scan.pcd` casts ten scans or so of 72,000 rays to fit its
/// scene, and takes 0.12 to 0.2 s for all of it on one core, less than 20 ms a scan.
class Solid {
 public:
  /// Between two horizontal rectangles, the bottom and the top, which may differ: car bodies and roofs slant.
  /// The sides are planes through the edges of equal direction. Each rectangle may be as thin as a line.
  static Solid block(const Rectangle& bottom, const Rectangle& top);
  /// A box with its sides along the axes. \param low, high opposite corners
  static Solid box(const Vector& low, const Vector& high);
  /// A cylinder with flat ends. \param from, to centres of the ends, not equal \param radius metres
  static Solid cylinder(const Vector& from, const Vector& to, double radius);
  /// \param radii along x, y, z, metres
  static Solid ellipsoid(const Vector& centre, const Vector& radii);

  /// The same solid of leaves: a ray is stopped only after some way in it, or not at all.
  /// \param mean_depth mean way through leaves, metres, > 0
  Solid ofLeaves(double mean_depth) const;
  /// Turned about the vertical axis through (0, 0), counterclockwise seen from above.
  Solid turned(double angle) const;
  Solid moved(const Vector& by) const;

  /// Where the ray from (0, 0, 0) is inside. \param direction of length 1
  Interval along(const Vector& direction) const;

  /// Whether a place is inside, or outside by no more than about `margin` metres.
  bool contains(const Vector& place, double margin = 0) const;

  /// A sphere around all of it.
  const Sphere& bounds() const { return bounds_; }

  /// 0: not made of leaves.
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
