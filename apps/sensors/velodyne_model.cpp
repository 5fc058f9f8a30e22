// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/velodyne_model.h"

#include <array>
#include <stdexcept>

#include <boost/algorithm/string/join.hpp>

#include "io/text.h"
#include "sensors/velodyne_calibration.h"

namespace lisco_apps {
namespace {

constexpr std::uint16_t kUpperBlock = 0xEEFF, kLowerBlock = 0xDDFF, kThirdBlock = 0xCCFF, kFourthBlock = 0xBBFF;

/// Elevations by laser number, degrees.
constexpr std::array<double, 16> kVlp16{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
constexpr std::array<double, 32> kHdl32e{-30.67, -9.33, -29.33, -8, -28, -6.66, -26.66, -5.33, -25.33, -4, -24, -2.67,
                                         -22.67, -1.33, -21.33, 0,  -20, 1.33,  -18.67, 2.67,  -17.33, 4,  -16, 5.33,
                                         -14.67, 6.67,  -13.33, 8,  -12, 9.33,  -10.67, 10.67};
constexpr std::array<double, 128> kVls128{
    -11.742, -1.99, 3.4,   -5.29,  -0.78, 4.61,  -4.08, 1.31,    -6.5,  -1.11,   4.28,   -4.41, 0.1,     6.48,  -3.2,
    2.19,    -3.86, 1.53,  -9.244, -1.77, 2.74,  -5.95, -0.56,   4.83,  -2.98,   2.41,   -6.28, -0.89,   3.62,  -5.07,
    0.32,    7.58,  -0.34, 5.18,   -3.64, 1.75,  -25,   -2.43,   2.96,  -5.73,   0.54,   9.7,   -2.76,   2.63,  -7.65,
    -1.55,   3.84,  -4.85, 3.18,   -5.51, -0.12, 5.73,  -4.3,    1.09,  -16.042, -2.21,  4.06,  -4.63,   0.76,  15,
    -3.42,   1.97,  -6.85, -1.33,  -5.62, -0.23, 5.43,  -3.53,   0.98,  -19.582, -2.32,  3.07,  -4.74,   0.65,  11.75,
    -2.65,   1.86,  -7.15, -1.44,  3.95,  -2.1,  3.29,  -5.4,    -0.01, 4.5,     -4.19,  1.2,   -13.565, -1.22, 4.17,
    -4.52,   0.87,  6.08,  -3.31,  2.08,  -6.65, 1.42,  -10.346, -1.88, 3.51,    -6.06,  -0.67, 4.72,    -3.97, 2.3,
    -6.39,   -1,    4.39,  -5.18,  0.21,  6.98,  -3.09, 4.98,    -3.75, 1.64,    -8.352, -2.54, 2.85,    -5.84, -0.45,
    8.43,    -2.87, 2.52,  -6.17,  -1.66, 3.73,  -4.96, 0.43};
constexpr std::array<double, 32> kVlp32c{-25,    -1,    -1.667, -15.639, -11.31, 0,     -0.667, -8.843,
                                         -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4,
                                         -4.667, 1.667, 1,      -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                         -3,     7,     4.667,  -2.333,  -2,     15,    10.333, -1.333};
/// Azimuth offsets of the VLP-32C's lasers, degrees clockwise.
constexpr std::array<double, 32> kVlp32cDirections{1.4,  -4.2, 1.4,  -1.4, 1.4,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,
                                                   -1.4, 4.2,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,  -4.2, 4.2,  -1.4,
                                                   1.4,  -1.4, 1.4,  -1.4, 1.4,  -4.2, 4.2,  -1.4, 1.4,  -1.4};
/// Azimuth offsets of the VLS-128's lasers by the last three bits of their numbers, degrees clockwise.
constexpr std::array kVls128Directions{6.354, 4.548, 2.732, 0.911, -0.911, -2.732, -4.548, -6.354};

/// \param laser_period_us from one laser of a column to the next
template <std::size_t kCount>
std::vector<Laser> lasersAt(const std::array<double, kCount>& elevations, double laser_period_us) {
  std::vector<Laser> lasers;
  for (std::size_t i = 0; i < kCount; ++i)
    lasers.push_back({i, elevations[i], 0, static_cast<double>(i) * laser_period_us});
  return lasers;
}

std::vector<Laser> lasersOf(const std::string& name, const fs::path& calibration_file) {
  if (name == "vlp16") return lasersAt(kVlp16, 2.304);
  if (name == "hdl32e") return lasersAt(kHdl32e, 1.152);
  if (name == "hdl64e") {
    if (calibration_file.empty())
      throw std::runtime_error(
          "the hdl64e needs its calibration file: each of these sensors has its own; give it by --calibration");
    return readCalibration(calibration_file, 64);  // which has no delays
  }
  if (name == "vlp32c") {
    std::vector<Laser> lasers = lasersAt(kVlp32c, 0.);
    for (std::size_t i = 0; i < lasers.size(); ++i) lasers[i].azimuth_offset = kVlp32cDirections[i];
    if (!calibration_file.empty()) lasers = readCalibration(calibration_file, lasers.size());
    constexpr double kPairPeriodUs = 2.304;  // two lasers fire together
    for (Laser& laser : lasers) laser.delay_us = static_cast<double>(laser.number / 2) * kPairPeriodUs;
    return lasers;
  }
  // All lasers take their block's azimuth, as in most drivers.
  std::vector<Laser> lasers = lasersAt(kVls128, 0.);
  for (Laser& laser : lasers) laser.azimuth_offset = kVls128Directions[laser.number % 8];
  return lasers;
}

}  // namespace

std::vector<std::string> velodyneModelNames() {
  return {"vlp16", "vlp32c", "hdl32e", "hdl64e", "vls128"};
}

VelodyneModel velodynePackets(const std::string& name) {
  if (name == "vlp16") return {name, {}, {kUpperBlock}, 2, 55.296, 0.002, {0x22}, {false, true, 1}};
  // The driver counts the time of each laser of a pair.
  if (name == "vlp32c") return {name, {}, {kUpperBlock}, 1, 55.296, 0.004, {0x28}, {true, true, 2}};
  if (name == "hdl32e") return {name, {}, {kUpperBlock}, 1, 46.08, 0.002, {0x21}};
  // The last two bytes of the packets carry a status.
  if (name == "hdl64e") return {name, {}, {kUpperBlock, kLowerBlock}, 1, 48., 0.002, {}};
  // The period is measured.
  if (name == "vls128")
    return {name, {}, {kUpperBlock, kLowerBlock, kThirdBlock, kFourthBlock}, 1, 55.2, 0.004, {0x63, 0xA1}};
  throw std::runtime_error("there is no sensor '" + name + "': it is one of " +
                           boost::join(velodyneModelNames(), ", "));
}

VelodyneModel makeVelodyneModel(const std::string& name, const fs::path& calibration_file) {
  VelodyneModel model = velodynePackets(name);
  model.lasers = lasersOf(name, calibration_file);
  if (name != "hdl64e" && name != "vlp32c" && !calibration_file.empty())
    throw std::runtime_error("a calibration file is for the hdl64e or the vlp32c, not for the " + name);
  sortByElevation(model.lasers);
  return model;
}

}  // namespace lisco_apps
