// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "simulation/terrain.h"
#include "simulation/vector.h"

namespace lisco_simulation {

/// Where a sensor is, and how it is turned: by roll about its x axis, then pitch about y, then yaw about z, radians,
/// each counterclockwise seen against the axis. Positive pitch looks down, positive roll leans to the right.
struct Pose {
  Vector place;
  double roll = 0, pitch = 0, yaw = 0;
};

/// The rotation of a pose.
class Rotation {
 public:
  explicit Rotation(const Pose& pose);
  /// From the sensor's axes to those of the world.
  Vector operator()(const Vector& v) const { return v.x * x_ + v.y * y_ + v.z * z_; }

 private:
  Vector x_, y_, z_;  ///< the sensor's axes
};

/// Of a sensor that drives along a circle, x ahead, and sways.
struct Motion {
  double speed = 0;           ///< metres per second
  double turn_rate = 0;       ///< radians per second, counterclockwise
  double turn_seconds = 0.1;  ///< of one rotation
  double roll = 0;            ///< amplitude, radians; a cosine: the first column has it in full
  double roll_seconds = 1.7;  ///< its period, > 0
  double pitch = 0;           ///< likewise
  double pitch_seconds = 1.3;

  /// \param turns since the start
  double headingAfter(double turns) const { return turn_rate * turn_seconds * turns; }
  Vector placeAfter(double turns) const;
  /// \param height of the sensor above the ground beneath its wheels in the mean, metres; at least half of it above the
  ///        ground in the middle
  Pose poseAfter(double turns, const Terrain& ground, double height) const;
};

}  // namespace lisco_simulation
