// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/scan_survey.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lisco/box.h"

namespace lisco {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Points seen from the sensor, in double: only here, where it is done for a few of them.
struct Direction {
  double azimuth, elevation;
};

Direction directionOf(const Return& point, const std::array<float, 3>& origin) {
  const double x = static_cast<double>(point.x) - static_cast<double>(origin[0]);
  const double y = static_cast<double>(point.y) - static_cast<double>(origin[1]);
  const double z = static_cast<double>(point.z) - static_cast<double>(origin[2]);
  return {std::atan2(y, x), std::atan2(z, std::hypot(x, y))};
}

float median(Sample<double>& values, float if_empty) {
  if (values.empty()) return if_empty;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<float>(*middle);
}

/// Whether a sensor there may have seen what lies in the box: not further outside it than the box is wide.
bool mayHaveSeen(const std::array<float, 3>& origin, const Box& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lo = static_cast<double>(box.lo[axis]);
    const double hi = static_cast<double>(box.hi[axis]);
    const double o = static_cast<double>(origin[axis]);
    const double width = std::max({static_cast<double>(box.hi[0]) - static_cast<double>(box.lo[0]),
                                   static_cast<double>(box.hi[1]) - static_cast<double>(box.lo[1]),
                                   static_cast<double>(box.hi[2]) - static_cast<double>(box.lo[2])});
    if (!(std::fabs(o) <= 1e30) || o < lo - width || o > hi + width) return false;
  }
  return true;
}

}  // namespace

Parameters ScanSurvey::judge(const std::array<float, 3>& sensor, bool organized) const {
  constexpr std::size_t kFewest = 8;
  Parameters parameters;
  if (!organized || along_row_.size() + along_column_.size() < kFewest || further_.size() < kFewest) return parameters;

  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const auto* pairs : {&along_row_, &along_column_})
    for (const Pair& pair : *pairs) box.add(Box::around(pair.a.x, pair.a.y, pair.a.z));
  if (!mayHaveSeen(parameters.view.origin, box)) {
    if (!mayHaveSeen(sensor, box)) return parameters;
    parameters.view.origin = sensor;
  }
  const auto& origin = parameters.view.origin;

  const auto rangeOf = [&origin](const Return& point) {
    return std::hypot(static_cast<double>(point.x) - static_cast<double>(origin[0]),
                      static_cast<double>(point.y) - static_cast<double>(origin[1]),
                      static_cast<double>(point.z) - static_cast<double>(origin[2]));
  };
  Sample<double> jumps;
  for (const Pair& pair : along_row_) jumps.push_back(std::fabs(rangeOf(pair.a) - rangeOf(pair.b)));
  for (std::size_t i = 0; i < alone_; ++i) jumps.push_back(std::numeric_limits<double>::infinity());
  parameters.view.roughness = median(jumps, 0.0F);

  Sample<double> elevation_steps;
  for (const Pair& pair : along_column_)
    elevation_steps.push_back(std::fabs(directionOf(pair.a, origin).elevation - directionOf(pair.b, origin).elevation));
  parameters.view.elevation_step = median(elevation_steps, parameters.view.elevation_step);

  // Over many columns, steps are measured more finely, and so is the direction of the turn.
  Sample<double> turns;
  for (const FurtherPair& pair : further_)
    turns.push_back(
        std::remainder(directionOf(pair.b, origin).azimuth - directionOf(pair.a, origin).azimuth, 2.0 * kPi) /
        static_cast<double>(pair.columns));
  const auto step = static_cast<double>(median(turns, 0.0F));
  Sample<double> deviations;
  for (const double turn : turns) deviations.push_back(std::fabs(turn - step));
  constexpr double kLeastStep = 1e-4;
  constexpr double kMostDeviation = 0.5;  // of a step, typically: else the columns are no steps of a turn
  if (std::fabs(step) > kLeastStep && static_cast<double>(median(deviations, 0.0F)) < kMostDeviation * std::fabs(step))
    parameters.view.steps_per_turn = static_cast<int>(std::lround(2.0 * kPi / std::fabs(step)));
  parameters.view.clockwise = step < 0;

  constexpr double kFew = 0.2;
  Sample<double> distances;
  for (const Pair& pair : along_row_)
    distances.push_back(std::hypot(static_cast<double>(pair.a.x) - static_cast<double>(origin[0]),
                                   static_cast<double>(pair.a.y) - static_cast<double>(origin[1])));
  if (!distances.empty()) {
    const auto few = distances.end() - 1 - static_cast<std::ptrdiff_t>(kFew * static_cast<double>(distances.size()));
    std::nth_element(distances.begin(), few, distances.end());
    parameters.view.far_distance = static_cast<float>(*few);
  }
  return parameters;
}

}  // namespace lisco
