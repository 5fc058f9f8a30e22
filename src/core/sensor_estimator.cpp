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

// Constants of the estimate. They tell clear cases apart: each of them halved or doubled changes the mean time of
// organized clouds (at rest, moved, deskewed, over one turn, dual returns) by less than 3 % (benchmarks/suite.sh
// recordings).

/// Spread of a laser's slopes in steps between lasers, up to which a frame is not improved. More: masks cover more
/// lasers than they need; less: a frame is fitted to clouds that have one, which takes longer.
constexpr double kTidy = 0.25;
/// Ratio of spreads from which on another frame is better. More: frames that save little; less: a displaced sensor is
/// taken for one at (0, 0, 0).
constexpr double kClearlyBetter = 0.5;
/// The spread that is good enough, in steps between lasers, where no other frame may have seen the cloud.
constexpr double kClear = 1.0;
/// Ratio of spreads, either way, up to which the frame of the cloud before is kept. More: frames that have become worse
/// are kept; less: frames are fitted to every cloud of a sequence.
constexpr double kAsBefore = 1.5;

/// Pairs of adjacent returns, and of returns further apart in a row, that an estimate needs. More: small and sparse
/// clouds get no hints; fewer: chance decides the medians.
constexpr std::size_t kMinPairs = 8;
/// Smallest azimuth step between columns, radians; below it the cloud does not turn. Less than any sensor's.
constexpr double kMinStep = 1e-4;
/// Median deviation of azimuths in steps; beyond, columns are no steps of a turn. More: clouds of cameras get a range
/// image; less: clouds that jitter get none.
constexpr double kMaxAzimuthDeviation = 0.5;
/// Times the mean step between lasers, above which the median of adjacent rows shows that rows are unsorted. It is at
/// most twice the mean if they are sorted. More: the step of unsorted lasers is that of distant ones; less: the lasers
/// that are sampled decide the step of sensors whose lasers are spaced unevenly.
constexpr double kUnsorted = 3.0;
/// Part of the returns beyond SensorHints::far_distance, from which on a range image is worth its memory.
constexpr double kFarShare = 0.2;

/// Cells of a cloud, below which a range image takes longer to prepare than it saves.
constexpr std::size_t kMinCells = 4096;
/// Cells that are sampled, and the rows they are in. More: the estimate takes longer; fewer: chance decides.
constexpr std::size_t kSamples = 128;
constexpr std::size_t kSampledRows = 8;
/// If fewer than 1 / kFewReturns of these are returns, other rows are sampled: with dual returns, the rows of second
/// returns alternate with those of first ones.
constexpr std::size_t kFewReturns = 4;
/// Turns that the steps may make of a cloud's columns: a range image of a cloud of less than a quarter turn would be
/// mostly empty.
constexpr std::size_t kMaxTurnsPerCloud = 4;

/// A point as seen from the sensor, metres.
struct Seen {
  double x, y, z;

  Seen(const Return& point, const std::array<float, 3>& origin)
      : x(static_cast<double>(point.x) - static_cast<double>(origin[0])),
        y(static_cast<double>(point.y) - static_cast<double>(origin[1])),
        z(static_cast<double>(point.z) - static_cast<double>(origin[2])) {}
  double rho() const { return std::sqrt(x * x + y * y); }
  double range() const { return std::sqrt(x * x + y * y + z * z); }
};

/// The angle of a vector, radians within half a turn: small ones, as most steps are, by its series.
double angleOf(double along, double across) {
  constexpr double kSmall = 0.25;  // tangent, whose next term is 1e-7 of the angle
  if (!(std::fabs(across) < kSmall * along)) return std::atan2(across, along);
  const double tangent = across / along;
  const double square = tangent * tangent;
  return tangent * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square * (1.0 / 7 - square / 9))));
}

/// From one azimuth to another, radians within half a turn.
double azimuthStep(const Seen& from, const Seen& to) {
  return angleOf(from.x * to.x + from.y * to.y, from.x * to.y - from.y * to.x);
}

/// Between two elevations, radians.
double elevationStep(const Seen& a, const Seen& b) {
  const double a_rho = a.rho();
  const double b_rho = b.rho();
  return std::fabs(angleOf(a_rho * b_rho + a.z * b.z, a_rho * b.z - a.z * b_rho));
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

template <std::size_t kCount>
std::array<double, kCount> toDouble(const std::array<float, kCount>& values) {
  std::array<double, kCount> doubles{};
  std::copy(values.begin(), values.end(), doubles.begin());
  return doubles;
}

}  // namespace

/// Keeps the frame of the cloud before if the lasers' slopes spread as much there. Otherwise chooses the origin from
/// which they spread least: (0, 0, 0), the declared one if that is clearly better, or the one that fits best if that
/// is.
/// \return false if none may have seen the cloud
bool SensorEstimator::estimateFrame(const std::array<float, 3>& declared_origin, const SensorHints& former,
                                    SensorHints& hints) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const auto* pairs : {&along_row_, &along_column_})
    for (const Pair& pair : *pairs) box.add(Box::around(pair.a.x, pair.a.y, pair.a.z));

  const auto take = [&hints](const std::array<float, 3>& origin, const std::array<double, 2>& tilt, double spread) {
    hints.origin = origin;
    hints.tilt = {static_cast<float>(tilt[0]), static_cast<float>(tilt[1])};
    hints.slope_spread = static_cast<float>(spread);
  };
  const auto before = static_cast<double>(former.slope_spread);
  if (before > 0 && !std::isinf(before) && mayHaveSeen(former.origin, box)) {
    const std::array<double, 2> tilt = toDouble(former.tilt);
    const double seen = frame_.spread({toDouble(former.origin), tilt});
    if (seen <= kAsBefore * before && before <= kAsBefore * seen) {
      take(former.origin, tilt, before);  // as estimated, so that many clouds do not add up to a worse frame
      return true;
    }
  }

  bool found = false;
  double spread = kClear / kClearlyBetter;
  for (const auto& origin : {std::array<float, 3>{0.0F, 0.0F, 0.0F}, declared_origin}) {
    if ((found && (spread < kTidy || origin == hints.origin)) || !mayHaveSeen(origin, box)) continue;
    const double seen = frame_.spread({toDouble(origin), {}});
    if (found && !(seen < kClearlyBetter * spread)) continue;
    take(origin, {}, seen);
    spread = seen;
    found = true;
  }
  if (found && spread < kTidy) return true;
  const SensorFrame fit = frame_.fit();
  const std::array<float, 3> origin{static_cast<float>(fit.origin[0]), static_cast<float>(fit.origin[1]),
                                    static_cast<float>(fit.origin[2])};
  if (!mayHaveSeen(origin, box)) return found;
  const double seen = frame_.spread({toDouble(origin), fit.tilt});
  if (!(seen < kClearlyBetter * spread)) return found;
  take(origin, fit.tilt, seen);
  return true;
}

SensorHints SensorEstimator::estimate(const std::array<float, 3>& declared_origin, const SensorHints& former) const {
  SensorHints hints;
  if (along_row_.size() + along_column_.size() < kMinPairs || further_.size() < kMinPairs) return hints;

  if (!estimateFrame(declared_origin, former, hints)) return hints;
  const auto& origin = hints.origin;

  Sample<double> jumps;
  for (const Pair& pair : along_row_)
    jumps.push_back(std::fabs(Seen(pair.a, origin).range() - Seen(pair.b, origin).range()));
  for (std::size_t i = 0; i < alone_; ++i) jumps.push_back(std::numeric_limits<double>::infinity());
  hints.roughness = median(jumps, 0.0F);

  Sample<double> elevation_steps;
  for (const Pair& pair : along_column_)
    elevation_steps.push_back(elevationStep(Seen(pair.a, origin), Seen(pair.b, origin)));
  hints.elevation_step = median(elevation_steps, hints.elevation_step);
  const auto of_lasers = frame_.elevationSteps({toDouble(origin), toDouble(hints.tilt)});
  if (static_cast<double>(hints.elevation_step) > kUnsorted * of_lasers.mean)
    hints.elevation_step = static_cast<float>(of_lasers.median);

  // Over many columns, the step and the sense of rotation are measured more finely.
  Sample<double> turns;
  for (const Pair& pair : further_)
    turns.push_back(azimuthStep(Seen(pair.a, origin), Seen(pair.b, origin)) / static_cast<double>(kDriftColumns));
  const auto step = static_cast<double>(median(turns, 0.0F));
  Sample<double> deviations;
  for (const double turn : turns) deviations.push_back(std::fabs(turn - step));
  if (std::fabs(step) > kMinStep &&
      static_cast<double>(median(deviations, 0.0F)) < kMaxAzimuthDeviation * std::fabs(step))
    hints.steps_per_turn = static_cast<int>(std::lround(2.0 * kPi / std::fabs(step)));
  hints.clockwise = step < 0;
  if (hints.steps_per_turn > 0)
    hints.drift =
        static_cast<float>(quantile(deviations, kSteadyShare) / std::fabs(step)) * static_cast<float>(kDriftColumns);
  if (hints.steps_per_turn > 0 && !along_row_.empty()) {
    Sample<double> jitters;
    for (const Pair& pair : along_row_)
      jitters.push_back(std::fabs(azimuthStep(Seen(pair.a, origin), Seen(pair.b, origin)) - step));
    hints.jitter = static_cast<float>(quantile(jitters, kSteadyShare) / std::fabs(step));
  }

  Sample<double> distances;
  for (const Pair& pair : along_row_) distances.push_back(Seen(pair.a, origin).rho());
  const auto few = static_cast<std::size_t>(kFarShare * static_cast<double>(distances.size()));
  if (!distances.empty()) hints.far_distance = static_cast<float>(sortedElement(distances, distances.size() - 1 - few));
  return hints;
}

SensorHints estimateSensor(std::size_t columns, std::size_t lasers, const std::array<float, 3>& declared_origin,
                           const CellSource& cells, const SensorHints& former) {
  if (lasers < 2 || columns * lasers < kMinCells) return SensorHints();
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
    return estimator.estimate(declared_origin, former);
  };
  SensorHints hints = estimateFrom(row_step / 2);
  // These may be the rows of second returns, of which few rays have one.
  if (hints.steps_per_turn == 0 && row_step > 1 && returns * kFewReturns < samples)
    hints = estimateFrom(row_step / 2 - 1);
  if (static_cast<std::size_t>(hints.steps_per_turn) > kMaxTurnsPerCloud * columns) hints.steps_per_turn = 0;
  return hints;
}

}  // namespace lisco
