// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/motion.h"

#include <algorithm>
#include <cmath>

namespace lisco_simulation {

Rotation::Rotation(const Pose& pose) {
  const double cr = std::cos(pose.roll), sr = std::sin(pose.roll);
  const double cp = std::cos(pose.pitch), sp = std::sin(pose.pitch);
  const double cy = std::cos(pose.yaw), sy = std::sin(pose.yaw);
  x_ = {cy * cp, sy * cp, -sp};
  y_ = {cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr};
  z_ = {cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr};
}

Vector Motion::placeAfter(double turns) const {
  const double way = speed * turn_seconds * turns;
  const double heading = headingAfter(turns);
  if (heading == 0) return {way, 0, 0};
  const double radius = way / heading;
  return {radius * std::sin(heading), radius * (1 - std::cos(heading)), 0};
}

Pose Motion::poseAfter(double turns, const Terrain& ground, double height) const {
  constexpr double kAxle = 1.2;   // metres from the middle of the vehicle
  constexpr double kWheel = 0.7;  // likewise, sideways
  const double seconds = turn_seconds * turns;
  Pose pose{placeAfter(turns), roll * std::cos(2 * kPi * seconds / roll_seconds),
            pitch * std::cos(2 * kPi * seconds / pitch_seconds), headingAfter(turns)};
  double sum = 0;
  for (const double along : {-kAxle, kAxle})
    for (const double across : {-kWheel, kWheel}) {
      const Vector wheel = pose.place + rotated({along, across, 0}, pose.yaw);
      sum += ground.height(wheel.x, wheel.y);
    }
  // Over a crest, the ground in the middle is higher than beneath the wheels; a low sensor stays above it.
  pose.place.z = std::max(sum / 4 + height, ground.height(pose.place.x, pose.place.y) + height / 2);
  return pose;
}

}  // namespace lisco_simulation
