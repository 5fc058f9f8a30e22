// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lisco_apps {

/// One laser, and how it sits in its sensor.
struct Laser {
  std::size_t number = 0;      ///< its place among the measurements of a firing
  double elevation = 0;        ///< degrees above the horizon
  double azimuth_offset = 0;   ///< degrees clockwise, to the azimuth of its block
  double delay_us = 0;         ///< it fires so much later than its block's azimuth was taken
  double distance_offset = 0;  ///< metres, added to what was measured
  double height = 0;           ///< metres above the origin
  double side = 0;             ///< metres to the left of the origin, seen along the ray
};

/// A rotating Velodyne sensor and its data packets: 1206 bytes, little-endian, of 12 blocks of 100 bytes (flag,
/// azimuth in hundredths of a degree, 32 times distance and intensity), the time of the first firing in microseconds
/// past the hour, and two factory bytes: the mode of returns and the model.
struct SensorModel {
  std::string name;
  std::vector<Laser> lasers;         ///< from top to bottom
  std::vector<std::uint16_t> flags;  ///< of the blocks that hold one firing of all lasers
  std::size_t firings = 1;           ///< in one block
  double firing_period_us = 0;       ///< from one firing of all lasers to the next
  double distance_unit = 0.002;      ///< metres
  /// What the last byte says, empty if the byte is used for something else.
  std::vector<std::uint8_t> factory_bytes;
};

/// The names makeSensorModel() knows.
std::vector<std::string> sensorModelNames();

/// A sensor as its maker describes it:
/// - vlp16: VLP-16 (Puck), 16 lasers, +-15 degrees
/// - hdl32e: HDL-32E, 32 lasers, +10.67 to -30.67 degrees
/// - hdl64e: HDL-64E, 64 lasers, each sensor with a calibration of its own
/// - vls128: VLS-128 (Alpha Prime), 128 lasers, +15 to -25 degrees, looking into eight directions within +-6.354 degrees
/// \param calibration_file of the hdl64e, see readCalibration()
/// \throws std::runtime_error with one line if there is no sensor of that name, if the hdl64e comes without a
///         calibration or another one with it, or if readCalibration() does
SensorModel makeSensorModel(const std::string& name, const std::filesystem::path& calibration_file = {});

/// The HDL-64E's lasers in the order of their numbers, from the XML file that Velodyne delivers with each sensor
/// (db.xml) and that PCL's HDLGrabber reads: angles in degrees, lengths in centimetres.
/// \throws std::runtime_error with one line if it is missing, no such file, or does not describe each of the 64 lasers
std::vector<Laser> readCalibration(const std::filesystem::path& file);

}  // namespace lisco_apps
