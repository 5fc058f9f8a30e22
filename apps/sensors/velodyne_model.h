// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/text.h"
#include "sensors/laser.h"

namespace lisco_apps {

/// A rotating Velodyne sensor and its data packets: 1206 bytes, little-endian, of 12 blocks of 100 bytes (flag,
/// azimuth in hundredths of a degree, 32 times distance and intensity), the time of the first firing in microseconds
/// past the hour, and two factory bytes: the mode of returns and the model.
struct VelodyneModel {
  std::string name;
  std::vector<Laser> lasers;                ///< from top to bottom
  std::vector<std::uint16_t> flags;         ///< of the blocks that hold one firing of all lasers
  std::size_t firings = 1;                  ///< in one block
  double firing_period_us = 0;              ///< from one firing of all lasers to the next
  double distance_unit = 0.002;             ///< metres
  std::vector<std::uint8_t> factory_bytes;  ///< values of the last byte; empty if it does not name the model

  /// Where Turning::kDriver departs from the manual.
  struct Driver {
    bool one_return = false, two_returns = false;  ///< in which packets
    double delay_factor = 1;                       ///< of the lasers' delays
  };
  Driver driver = {};
};

/// The names that makeVelodyneModel () accepts.
std::vector<std::string> velodyneModelNames();

/// A sensor by its manual:
/// - vlp16: VLP-16 (Puck), 16 lasers, +-15 degrees
/// - vlp32c: VLP-32C (Ultra Puck), 32 lasers, +15 to -25 degrees, in four directions within +-4.2 degrees, fired in
///   pairs
/// - hdl32e: HDL-32E, 32 lasers, +10.67 to -30.67 degrees
/// - hdl64e: HDL-64E, 64 lasers, each sensor with a calibration of its own
/// - vls128: VLS-128 (Alpha Prime), 128 lasers, +15 to -25 degrees, in eight directions within +-6.354 degrees
/// \param calibration_file of the hdl64e, or instead of the manual's angles of the vlp32c, see readCalibration ()
/// \throws std::runtime_error with one line if the name is unknown, if the hdl64e comes without a calibration or a
///         sensor with one that has none, or if readCalibration () throws
VelodyneModel makeVelodyneModel(const std::string& name, const fs::path& calibration_file = {});

/// A sensor's packets: its model without lasers, which needs no calibration.
/// \throws std::runtime_error with one line if the name is unknown
VelodyneModel velodynePackets(const std::string& name);

}  // namespace lisco_apps
