// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include "io/text.h"
#include "sensors/velodyne_encoder.h"
#include "sensors/velodyne_model.h"
#include "simulation/scanner.h"
#include "simulation/sensor.h"

namespace lisco_apps {

/// The sensors whose packets can be simulated.
std::vector<std::string> packetSensorNames();

/// A sensor as its packets describe it: directions that they can state, ranges in their unit.
/// \param steps of a rotation; 0: 1800
/// \throws std::runtime_error with one line if the sensor has no packets, or they cannot state so many steps: a whole
///         number of packets' blocks must take a whole number of hundredths of a degree each
lisco_simulation::Sensor packetSensor(const std::string& name, std::size_t steps);
/// Seconds of a rotation of that sensor.
double turnSeconds(const lisco_simulation::Sensor& sensor);

/// Writes a capture of the packets of such a sensor, from straight behind on.
class PacketWriter {
 public:
  /// \throws std::runtime_error with one line if the file cannot be written
  PacketWriter(const fs::path& file, const lisco_simulation::Sensor& sensor);

  /// The next columns.
  void add(const lisco_simulation::SimulatedScan& scan);
  /// Fills the last packet with lasers that have no return. \throws std::runtime_error as above
  void finish();

 private:
  void writePacket();

  fs::path file_;
  std::ofstream stream_;
  VelodyneEncoder encoder_;
  std::vector<std::size_t> row_of_;  ///< per laser number
  double distance_unit_;
  std::size_t firings_ = 0;                     ///< written
  std::vector<std::vector<Measured>> waiting_;  ///< firings that fill no packet yet, each by laser number
};

}  // namespace lisco_apps
