// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/pi.h"
#include "io/text.h"

namespace lisco_apps {

using lisco::kPi;
inline constexpr double kRadiansPerDegree = kPi / 180.;

/// One laser, and its place in the sensor.
struct Laser {
  std::size_t number = 0;      ///< index among the measurements of a firing
  double elevation = 0;        ///< degrees above the horizon
  double azimuth_offset = 0;   ///< degrees clockwise from the azimuth of its block
  double delay_us = 0;         ///< of its firing, since the azimuth of its block was taken
  double distance_offset = 0;  ///< metres, added to the measured distance
  double height = 0;           ///< metres above the origin
  double side = 0;             ///< metres to the left of the origin, seen along the ray
};

/// Sorts from top to bottom.
inline void sortByElevation(std::vector<Laser>& lasers) {
  std::stable_sort(lasers.begin(), lasers.end(),
                   [](const Laser& a, const Laser& b) { return a.elevation > b.elevation; });
}

/// The lasers that a calibration file describes, by their numbers.
/// \param first number of the first laser in the file
/// \throws std::runtime_error with one line if one is missing
inline std::vector<Laser> allOf(const std::vector<std::optional<Laser>>& found, const fs::path& file,
                                std::size_t first) {
  std::vector<Laser> all;
  for (const std::optional<Laser>& laser : found) {
    if (!laser) fail(file, "does not describe laser " + std::to_string(first + all.size()));
    all.push_back(*laser);
  }
  return all;
}

inline std::vector<double> elevationsOf(const std::vector<Laser>& lasers) {
  std::vector<double> elevations;
  for (const Laser& laser : lasers) elevations.push_back(laser.elevation);
  return elevations;
}

/// Upper bound of the azimuth between a return and its column, radians: by the laser's place, by the delay of its
/// firing, and by a margin.
inline double staggerOf(const std::vector<Laser>& lasers) {
  constexpr double kMaxSpeed = 360 * 20e-6;  // degrees per microsecond: 20 turns a second
  constexpr double kJitter = 1;              // degrees by which an azimuth may step back
  constexpr double kMinRange = 0.5;          // metres, of returns of lasers beside the axis
  double bound = 0;
  for (const Laser& laser : lasers) {
    const double beside = std::asin(std::min(1., std::fabs(laser.side) / kMinRange));
    const double offset = std::fabs(laser.azimuth_offset) + kMaxSpeed * std::fabs(laser.delay_us);
    bound = std::max(bound, (offset + kJitter) * kRadiansPerDegree + beside);
  }
  return bound;
}

}  // namespace lisco_apps
