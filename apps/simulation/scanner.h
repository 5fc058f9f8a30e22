// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/sensor.h"
#include "simulation/solid.h"
#include "simulation/vector.h"

namespace lisco_simulation {

/// An object of a scene.
struct Object {
  std::string kind;  ///< "car", "tree", ...
  std::vector<Solid> solids;
};

/// The surroundings of the sensor, which is at (0, 0, 0) with x ahead, y to the left and z up.
struct Scene {
  std::vector<Object> objects;  ///< the object of index i has number i + 1
  double floor_z = -1.8;        ///< height of the floor or ground, an endless plane, metres
  float ground_z = -1.6F;       ///< returns below this height are left out of clustering, metres
};

/// Noise and drop-outs of a scan. Equal values give equal scans.
struct Disturbance {
  std::uint64_t seed = 1;
  double range_noise = 0.02;  ///< standard deviation of a range, metres, >= 0
  double drop_outs = 0.005;   ///< part of the returns that is lost, 0 to below 1
};

/// Shorter ranges are set to this, metres, so that noise keeps the direction of a return.
constexpr double kMinRange = 0.01;

/// One cell of a scan.
struct SimulatedCell {
  float x, y, z;         ///< metres; NaN: no return
  std::uint32_t object;  ///< number of the object hit; 0: the ground, or no return
};

/// One rotation of a sensor.
struct SimulatedScan {
  std::size_t lasers = 0;
  std::size_t steps = 0;
  std::vector<SimulatedCell> cells;  ///< laser by laser from top to bottom, each step by step

  const SimulatedCell& at(std::size_t laser, std::size_t step) const { return cells[laser * steps + step]; }
  std::size_t returns() const;
  /// Returns with z >= ground_z.
  std::size_t returnsAbove(float ground_z) const;
  /// Returns nearer to the sensor than `range` metres.
  std::size_t returnsWithin(double range) const;
};

/// A scan without returns.
SimulatedScan emptyScan(std::size_t lasers, std::size_t steps);
SimulatedCell cellAt(const Vector& place, std::uint32_t object);
inline Vector placeOf(const SimulatedCell& cell) {
  return {static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)};
}

/// Casts one ray per cell to the first object it meets.
SimulatedScan scan(const Scene& scene, const Sensor& sensor, const Disturbance& disturbance);

/// The scene in the frame of a sensor elsewhere. \param heading radians counterclockwise
Scene seenFrom(const Scene& scene, const Vector& place, double heading);

}  // namespace lisco_simulation
