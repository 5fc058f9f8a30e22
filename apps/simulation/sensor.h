// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/vector.h"

namespace lisco_simulation {

/// A rotating LiDAR: a column of lasers that turns clockwise, seen from above, in equal steps.
struct Sensor {
  std::string name;
  std::vector<double> elevation;  ///< of each laser, radians above the horizon, from top to bottom
  std::vector<double> stagger;    ///< of each laser in its column, radians clockwise
  std::size_t steps = 0;          ///< of one rotation
  double max_range = 120;         ///< metres; no returns beyond
  double range_unit = 0;          ///< metres; ranges are rounded to multiples of it; 0: they are not

  std::size_t lasers() const { return elevation.size(); }

  /// Azimuth of a laser in a step, radians counterclockwise from straight ahead, not wrapped. Step 0 is straight
  /// behind, so that straight ahead is in the middle of a scan.
  double azimuth(std::size_t laser, std::size_t step) const;
  /// The direction of a laser in a step, of length 1.
  Vector direction(std::size_t laser, std::size_t step) const;
};

/// The names that makeSensor () accepts, the default first.
std::vector<std::string> simulatedSensors();

/// A sensor by its manual:
/// - hdl64e: Velodyne HDL-64E, 64 lasers x 1125 steps (the paper's): 32 upper lasers 1/3 degree apart from +2 degrees
///   down, 32 lower ones 1/2 degree apart to -24.33. Its columns are straight, as in the paper.
/// - hdl32e: Velodyne HDL-32E, 32 x 2170, +10.67 to -30.67 degrees. The lasers of a column fire one after the other,
///   alternately one of the lower and one of the upper half, while the sensor turns.
/// - vlp16: Velodyne VLP-16, 16 x 1808, +-15 degrees, firing likewise.
/// - vls128: Velodyne VLS-128, 128 x 1808, +15 to -25 degrees, 0.11 degrees apart around the horizon and further apart
///   towards both ends. The stagger of successive lasers takes eight values within +-6.354 degrees.
/// - os1-128: Ouster OS1-128, 128 x 1024, +-22.5 degrees. The stagger takes four values within +-4.23 degrees.
/// \param lasers 0: as many as the model has. Otherwise the elevations are interpolated between the model's, from top
///         to bottom (one laser: in their middle), and the pattern of the stagger is continued.
/// \param steps 0: as many as the model has
/// \throws std::invalid_argument if the name is unknown
Sensor makeSensor(const std::string& name, std::size_t lasers = 0, std::size_t steps = 0);

}  // namespace lisco_simulation
