// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/sensor_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/neighbour.h"
#include "core/pi.h"

namespace lisco {
namespace {

/// Of a point as seen from the sensor, radians.
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
  return values.empty() ? if_empty : static_cast<float>(sortedElement(values, values.size() / 2));
}

/// Whether a sensor may have measured what lies in the box: it is not further outside than the box is wide.
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

std::array<double, 3> toDouble(const std::array<float, 3>& point) {
  return {static_cast<double>(point[0]), static_cast<double>(point[1]), static_cast<double>(point[2])};
}

}  // namespace

/// Chooses the origin from which the lasers' slopes spread least: (0, 0, 0), the declared one if that is clearly
/// better, or the one that fits best if that is. \return false if none may have seen the cloud
bool SensorEstimator::estimateFrame(const std::array<float, 3>& declared_origin, SensorHints& hints) const {
  constexpr double kTidy = 0.25;          // of a step between lasers: a better frame saves nothing
  constexpr double kClearlyBetter = 0.5;  // as a ratio of spreads
  constexpr double kClear = 1.0;          // steps between lasers, if there is nothing to compare with
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const auto* pairs : {&along_row_, &along_column_})
    for (const Pair& pair : *pairs) box.add(Box::around(pair.a.x, pair.a.y, pair.a.z));

  bool found = false;
  double spread = kClear / kClearlyBetter;
  for (const auto& origin : {std::array<float, 3>{0.0F, 0.0F, 0.0F}, declared_origin}) {
    if ((found && (spread < kTidy || origin == hints.origin)) || !mayHaveSeen(origin, box)) continue;
    const double seen = frame_.spread({toDouble(origin), {}});
    if (found && !(seen < kClearlyBetter * spread)) continue;
    hints.origin = origin;
    spread = seen;
    found = true;
  }
  if (found && spread < kTidy) return true;
  const SensorFrame fit = frame_.fit();
  const std::array<float, 3> origin{static_cast<float>(fit.origin[0]), static_cast<float>(fit.origin[1]),
                                    static_cast<float>(fit.origin[2])};
  if (!mayHaveSeen(origin, box) || !(frame_.spread({toDouble(origin), fit.tilt}) < kClearlyBetter * spread))
    return found;
  hints.origin = origin;
  hints.tilt = {static_cast<float>(fit.tilt[0]), static_cast<float>(fit.tilt[1])};
  return true;
}

SensorHints SensorEstimator::estimate(const std::array<float, 3>& declared_origin) const {
  constexpr std::size_t kMinPairs = 8;
  SensorHints hints;
  if (along_row_.size() + along_column_.size() < kMinPairs || further_.size() < kMinPairs) return hints;

  if (!estimateFrame(declared_origin, hints)) return hints;
  const auto& origin = hints.origin;

  const auto rangeOf = [&origin](const Return& point) {
    return std::hypot(static_cast<double>(point.x) - static_cast<double>(origin[0]),
                      static_cast<double>(point.y) - static_cast<double>(origin[1]),
                      static_cast<double>(point.z) - static_cast<double>(origin[2]));
  };
  Sample<double> jumps;
  for (const Pair& pair : along_row_) jumps.push_back(std::fabs(rangeOf(pair.a) - rangeOf(pair.b)));
  for (std::size_t i = 0; i < alone_; ++i) jumps.push_back(std::numeric_limits<double>::infinity());
  hints.roughness = median(jumps, 0.0F);

  Sample<double> elevation_steps;
  for (const Pair& pair : along_column_)
    elevation_steps.push_back(std::fabs(directionOf(pair.a, origin).elevation - directionOf(pair.b, origin).elevation));
  hints.elevation_step = median(elevation_steps, hints.elevation_step);

  // Over many columns, the step and the sense of rotation are measured more finely.
  Sample<double> turns;
  for (const Pair& pair : further_)
    turns.push_back(
        std::remainder(directionOf(pair.b, origin).azimuth - directionOf(pair.a, origin).azimuth, 2.0 * kPi) /
        static_cast<double>(kDriftColumns));
  const auto step = static_cast<double>(median(turns, 0.0F));
  Sample<double> deviations;
  for (const double turn : turns) deviations.push_back(std::fabs(turn - step));
  constexpr double kMinStep = 1e-4;      // radians
  constexpr double kMaxDeviation = 0.5;  // median, in steps: beyond, the columns are no steps of a turn
  if (std::fabs(step) > kMinStep && static_cast<double>(median(deviations, 0.0F)) < kMaxDeviation * std::fabs(step))
    hints.steps_per_turn = static_cast<int>(std::lround(2.0 * kPi / std::fabs(step)));
  hints.clockwise = step < 0;
  constexpr double kSteadyShare = 0.75;  // part of the pairs that jitter and drift less
  if (hints.steps_per_turn > 0)
    hints.drift =
        static_cast<float>(quantile(deviations, kSteadyShare) / std::fabs(step)) * static_cast<float>(kDriftColumns);
  Sample<double> jitters;
  for (const Pair& pair : along_row_)
    jitters.push_back(std::fabs(
        std::remainder(directionOf(pair.b, origin).azimuth - directionOf(pair.a, origin).azimuth, 2.0 * kPi) - step));
  if (!jitters.empty() && hints.steps_per_turn > 0)
    hints.jitter = static_cast<float>(quantile(jitters, kSteadyShare) / std::fabs(step));

  constexpr double kFew = 0.2;  // share of the returns beyond SensorHints::far_distance
  Sample<double> distances;
  for (const Pair& pair : along_row_)
    distances.push_back(std::hypot(static_cast<double>(pair.a.x) - static_cast<double>(origin[0]),
                                   static_cast<double>(pair.a.y) - static_cast<double>(origin[1])));
  const auto few = static_cast<std::size_t>(kFew * static_cast<double>(distances.size()));
  if (!distances.empty()) hints.far_distance = static_cast<float>(sortedElement(distances, distances.size() - 1 - few));
  return hints;
}

SensorHints estimateSensor(std::size_t columns, std::size_t lasers, const std::array<float, 3>& declared_origin,
                           const CellSource& cells) {
  constexpr std::size_t kSmall = 4096;  // cells, below which a range image is not worth its preparation
  constexpr std::size_t kSampledRows = 8;
  constexpr std::size_t kSamples = 128;
  constexpr std::size_t kFew = 4;       // of the samples: 1 / kFew
  constexpr std::size_t kMinShare = 4;  // of a turn: 1 / kMinShare; less would leave the range image mostly empty
  if (lasers < 2 || columns * lasers < kSmall) return SensorHints();
  const auto valid = [](const Return& cell) { return isReturn(cell.x, cell.y, cell.z); };

  const std::size_t row_step = std::max<std::size_t>(1, lasers / kSampledRows);
  const std::size_t samples_per_row = std::max<std::size_t>(1, kSamples * row_step / lasers);
  const std::size_t column_step = std::max<std::size_t>(1, columns / samples_per_row);
  std::size_t samples = 0;
  std::size_t returns = 0;
  const auto estimateFrom = [&](std::size_t first_laser) {
    SensorEstimator estimator;
    struct BelowOne {
      std::size_t laser;
      Return point;
    };
    Sample<BelowOne> below_ones;
    for (std::size_t laser = first_laser; laser < lasers; laser += row_step)
      for (std::size_t column = column_step / 2; column < columns; column += column_step) {
        ++samples;
        const Return cell = cells.at(laser, column);
        if (!valid(cell)) continue;
        ++returns;
        const Return right = column + 1 < columns ? cells.at(laser, column + 1) : kNoReturn;
        const Return below = laser + 1 < lasers ? cells.at(laser + 1, column) : kNoReturn;
        const std::size_t after = column + SensorEstimator::kDriftColumns;
        const Return further = after < columns ? cells.at(laser, after) : kNoReturn;
        if (valid(right))
          estimator.addAlongRow(cell, right);
        else
          estimator.addAlone();
        if (valid(further)) estimator.addFurtherAlongRow(cell, further);
        estimator.addOfLaser(laser, cell);
        if (!valid(below)) continue;
        estimator.addAlongColumn(cell, below);
        below_ones.push_back({laser + 1, below});
      }
    for (const BelowOne& one : below_ones) estimator.addOfLaser(one.laser, one.point);
    return estimator.estimate(declared_origin);
  };
  SensorHints hints = estimateFrom(row_step / 2);
  // These may be the rows of second returns, of which few rays have one.
  if (hints.steps_per_turn == 0 && row_step > 1 && returns * kFew < samples) hints = estimateFrom(row_step / 2 - 1);
  if (static_cast<std::size_t>(hints.steps_per_turn) > kMinShare * columns) hints.steps_per_turn = 0;
  return hints;
}

}  // namespace lisco
