// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "lisco/sensor_hints.h"
#include "sensors/decoder.h"

namespace lisco_apps {

inline constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180;

/// What is known of a rotation before it comes.
inline lisco::SensorHints viewOf(const Decoder& decoder) {
  lisco::SensorHints view;
  view.clockwise = true;
  view.steps_per_turn = static_cast<int>(std::lround(std::min(decoder.columnsPerTurn(), 36000.)));
  const std::vector<Laser>& lasers = decoder.model().lasers;
  std::vector<double> steps;
  for (std::size_t i = 1; i < lasers.size(); ++i) steps.push_back(lasers[i - 1].elevation - lasers[i].elevation);
  if (steps.empty()) return view;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  view.elevation_step = static_cast<float>(*middle * kRadiansPerDegree);
  return view;
}

/// How far the azimuth of a return may differ from that of its column, radians: by its laser's place, by the time until
/// it fires, and by a margin.
inline double staggerOf(const SensorModel& model) {
  constexpr double kFastestTurn = 360 * 20e-6;  // degrees in a microsecond: no sensor turns faster
  constexpr double kJitter = 1;                 // degrees by which an azimuth may step back
  constexpr double kNearest = 0.5;              // metres, of returns of lasers that sit beside the axis
  double most = 0;
  for (const Laser& laser : model.lasers) {
    const double beside = std::asin(std::min(1., std::fabs(laser.side) / kNearest));
    const double offset = std::fabs(laser.azimuth_offset) + kFastestTurn * laser.delay_us;
    most = std::max(most, (offset + kJitter) * kRadiansPerDegree + beside);
  }
  return most;
}

}  // namespace lisco_apps
