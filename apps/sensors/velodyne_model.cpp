// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "velodyne_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <boost/algorithm/string/join.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include "io/text.h"

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
/// Azimuth offsets of the VLS-128's lasers by the last three bits of their numbers, degrees clockwise.
constexpr std::array kVls128Directions{6.354, 4.548, 2.732, 0.911, -0.911, -2.732, -4.548, -6.354};

constexpr std::size_t kCalibratedLasers = 64;

/// \param laser_period_us from one laser of a column to the next
template <std::size_t kCount>
std::vector<Laser> lasersAt(const std::array<double, kCount>& elevations, double laser_period_us) {
  std::vector<Laser> lasers(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    lasers[i].number = i;
    lasers[i].elevation = elevations[i];
    lasers[i].delay_us = static_cast<double>(i) * laser_period_us;
  }
  return lasers;
}

std::vector<Laser> lasersOf(const std::string& name, const fs::path& calibration_file) {
  if (name == "vlp16") return lasersAt(kVlp16, 2.304);
  if (name == "hdl32e") return lasersAt(kHdl32e, 1.152);
  if (name == "hdl64e") {
    if (calibration_file.empty())
      throw std::runtime_error(
          "the hdl64e needs its calibration file: each of these sensors has its own; give it by --calibration");
    return readCalibration(calibration_file);  // which has no delays
  }
  // All lasers take their block's azimuth, as in most drivers.
  std::vector<Laser> lasers = lasersAt(kVls128, 0.);
  for (Laser& laser : lasers) laser.azimuth_offset = kVls128Directions[laser.number % 8];
  return lasers;
}

}  // namespace

std::vector<std::string> velodyneModelNames() {
  return {"vlp16", "hdl32e", "hdl64e", "vls128"};
}

VelodyneModel velodynePackets(const std::string& name) {
  if (name == "vlp16") return {name, {}, {kUpperBlock}, 2, 55.296, 0.002, {0x22}};
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
  if (name != "hdl64e" && !calibration_file.empty())
    throw std::runtime_error("a calibration file is for the hdl64e only, not for the " + name);
  sortByElevation(model.lasers);
  return model;
}

// PCL's HDLGrabber uses uninitialized numbers if the file is missing, and writes out of bounds for a laser number of 64
// or more.
std::vector<Laser> readCalibration(const fs::path& file) {
  namespace tree = boost::property_tree;
  std::vector<std::optional<Laser>> found(kCalibratedLasers);
  try {
    tree::ptree document;
    tree::read_xml(file.string(), document, tree::xml_parser::trim_whitespace);
    for (const auto& [kind, item] : document.get_child("boost_serialization.DB.points_")) {
      if (kind != "item") continue;
      const tree::ptree& values = item.get_child("px");
      const auto value = [&](const char* name) {
        const std::string& text = values.get_child(name).data();
        double read = 0;
        if (!boost::conversion::try_lexical_convert(text, read) || !std::isfinite(read))
          fail(file, std::string(name) + " is no number: '" + text + "'");
        return read;
      };
      const double number = value("id_");
      if (!(number >= 0 && number < static_cast<double>(kCalibratedLasers)) || number != std::floor(number))
        fail(file, "there is no laser " + values.get_child("id_").data());
      constexpr double kCentimetre = 0.01;
      Laser laser;
      laser.number = static_cast<std::size_t>(number);
      laser.elevation = value("vertCorrection_");
      laser.azimuth_offset = -value("rotCorrection_");
      laser.distance_offset = kCentimetre * value("distCorrection_");
      laser.height = kCentimetre * value("vertOffsetCorrection_");
      laser.side = kCentimetre * value("horizOffsetCorrection_");
      found[laser.number] = laser;
    }
  } catch (const tree::xml_parser_error& error) {
    fail(file, "is no calibration file: " + error.message());
  } catch (const tree::ptree_error& error) {
    fail(file, std::string("is no calibration file of an HDL-64E: ") + error.what());
  }
  std::vector<Laser> lasers;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) fail(file, "does not describe laser " + std::to_string(i));
    lasers.push_back(*found[i]);
  }
  return lasers;
}

}  // namespace lisco_apps
