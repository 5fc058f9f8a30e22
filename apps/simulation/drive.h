// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "simulation/caster.h"
#include "simulation/motion.h"
#include "simulation/scanner.h"
#include "simulation/sensor.h"
#include "simulation/solid.h"
#include "simulation/terrain.h"

namespace lisco_simulation {

/// How an object meets the ground.
enum class Footing {
  kWheels,   ///< follows the slope beneath it
  kFounded,  ///< likewise, sunk so that there is no gap beneath it
  kLevel,    ///< stays level, at the height of the ground in its middle
  kFixed,    ///< given in the world's coordinates
};

/// An object on the ground, at rest or in straight motion.
struct Body {
  std::string kind;
  std::vector<Solid> solids;  ///< on a floor of height 0 around (0, 0), facing x
  double length = 0;          ///< of its footprint along x and y, metres
  double width = 0;
  double height = 0;  ///< metres; 0: it is no box, and the footprint is what it stands on
  Footing footing = Footing::kFounded;
  Vector at;           ///< at the start; z is that of the ground
  double heading = 0;  ///< radians counterclockwise
  Vector velocity;     ///< horizontal, metres per second

  bool isMoving() const { return velocity.x != 0 || velocity.y != 0; }
};

/// Where a body is, and the slope it stands on: the rise per metre along x and y.
struct Standing {
  Vector place, slope;
};
Standing standingAfter(const Body& body, double seconds, const Terrain& ground);
/// The solids of a body that stands there, in the coordinates of the world.
std::vector<Solid> solidsOf(const Body& body, const Standing& standing);

/// The surroundings of a moving sensor. The coordinates of the world are those of the start: x ahead, y to the left, z
/// up from the ground of height 0.
struct World {
  Terrain ground;
  std::vector<Body> bodies;    ///< the object of index i has number i + 1
  std::vector<Solid> carrier;  ///< the vehicle below the sensor, in the sensor's frame: the last number; empty: none
};

/// A sensor that moves through a world. Each column is measured from the pose and among the objects of its own moment.
class Drive {
 public:
  /// \param height of the sensor above the ground, metres
  Drive(World world, Sensor sensor, const Disturbance& disturbance, const Motion& motion, double height);

  /// Columns from the start on, each in the sensor's frame of its moment, as a driver without motion compensation
  /// delivers them. The returns of a column do not depend on which columns are asked for.
  SimulatedScan columns(std::size_t first, std::size_t count);

  double secondsOf(std::size_t column) const { return motion_.turn_seconds * turnsOf(column); }
  Pose poseOf(std::size_t column) const { return motion_.poseAfter(turnsOf(column), world_.ground, height_); }
  const World& world() const { return world_; }
  const Sensor& sensor() const { return sensor_; }

 private:
  double turnsOf(std::size_t column) const { return static_cast<double>(column) / static_cast<double>(sensor_.steps); }
  void lookAround(std::size_t column);

  World world_;
  Sensor sensor_;
  Disturbance disturbance_;
  Motion motion_;
  double height_;
  Caster carrier_;

  // The world as it stands around a column, which serves for some columns: within them, objects and the sensor are
  // shifted.
  std::size_t columns_per_view_;
  std::optional<std::size_t> view_;  ///< its first column over columns_per_view_
  Caster caster_;
  std::vector<std::vector<Solid>> at_rest_;  ///< per body; empty: it moves
  std::vector<Solid> seen_;
  std::vector<Standing> standing_;
  Vector centre_;
  Caster::Shifts shifts_;
};

/// Scans a scene while the sensor moves; the returns are in the frame of the first column (motion-compensated).
/// \param columns more than the sensor's steps: the scan is longer than a turn
SimulatedScan scanInMotion(const Scene& scene, const Sensor& sensor, const Disturbance& disturbance,
                           const Motion& motion, std::size_t columns);

}  // namespace lisco_simulation
