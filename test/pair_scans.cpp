// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "pair_scans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine.h"
#include "far_hints.h"
#include "oracle.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A sensor's cells, and which of them sees a position.
class Sensor {
 public:
  Sensor(Random& random, PairScan& pairs) : random_(random), scan_(pairs.scan), hints_(pairs.hints) {
    const std::array<int, 5> steps_choices{512, 600, 1000, 1024, 2048};
    const std::array<double, 8> turns{1.0, 1.0, 1.0, 0.5, 1.04, 1.2, 2.3, 3.2};
    steps_ = random.oneOf(steps_choices);
    hints_ = hintsFor(steps_, 0.1F, random.chance(0.5));
    hints_.elevation_step = elevationStepFor(hints_, random.magnitude(1.0, 60.0));
    const std::size_t lasers = 1 + random.below(24);
    scan_ = Scan(static_cast<std::size_t>(steps_ * random.oneOf(turns)), lasers);
    start_ = random.between(0.0, 2.0 * kPi);
    lag_.assign(lasers, 0.0);
    if (random.chance(0.6))
      for (double& lag : lag_) lag = random.between(-50.0, 50.0);
    slope_.resize(lasers);
    const double ring = random.magnitude(0.003, 0.3);
    const double top = random.between(-0.3, 0.5);
    for (std::size_t i = 0; i < lasers; ++i) slope_[i] = top - ring * static_cast<double>(i);
    if (random.chance(0.3)) random.shuffle(slope_);
    if (random.chance(0.2)) std::reverse(slope_.begin(), slope_.end());
    const std::array<double, 6> jitters{0.0, 0.0, 0.02, 0.3, 0.74, 2.0};
    jitter_ = random.oneOf(jitters);
    // Lost packets: the columns after them move up.
    const double lost = random.chance(0.4) ? 0.05 : 0.0;
    for (std::size_t column = 0; column < scan_.columns; ++column)
      if (column % 16 != 0 || !random.chance(lost))
        column_of_time_.push_back(column);
      else
        column_of_time_.insert(column_of_time_.end(), 16, column);
  }

  double step() const { return 2.0 * kPi / steps_; }
  int steps() const { return steps_; }
  std::size_t lasers() const { return scan_.lasers; }
  std::size_t columns() const { return scan_.columns; }
  double slope(std::size_t laser) const { return slope_[laser]; }

  static Point at(const lisco::SensorHints& hints, double start, double turned, double ahead, double left, double up) {
    const double azimuth = start + (hints.clockwise ? -turned : turned);
    const double aside = hints.clockwise ? -left : left;
    return {static_cast<float>(ahead * std::cos(azimuth) - aside * std::sin(azimuth)) + hints.origin[0],
            static_cast<float>(ahead * std::sin(azimuth) + aside * std::cos(azimuth)) + hints.origin[1],
            static_cast<float>(up) + hints.origin[2]};
  }

  /// Sets the empty cell that sees one bin to a return ahead and to the left of another bin.
  bool set(std::size_t laser, double seen_bin, double bin, double ahead, double left, double up) {
    const double time = seen_bin + lag_[laser] + random_.between(-jitter_, jitter_);
    if (!(time > -0.5) || time > static_cast<double>(column_of_time_.size()) - 0.6) return false;
    const std::size_t column = column_of_time_[static_cast<std::size_t>(std::lround(time))];
    const lisco::Return& cell = scan_.at(laser, column);
    if (isValid({cell.x, cell.y, cell.z})) return false;
    scan_.set(laser, column, at(hints_, start_, bin * step(), ahead, left, up));
    return true;
  }

 private:
  Random& random_;
  Scan& scan_;
  lisco::SensorHints& hints_;
  int steps_ = 0;
  double start_ = 0;
  double jitter_ = 0;
  std::vector<double> lag_, slope_;
  std::vector<std::size_t> column_of_time_;
};

}  // namespace

PairScan randomPairs(Random& random) {
  PairScan pairs;
  Sensor sensor(random, pairs);
  const std::array<double, 6> scales{1.0, 1.0, 1.0, 0.3, 1e-15, 1e11};
  const double tolerance = random.oneOf(scales);
  pairs.tolerance = static_cast<float>(tolerance);
  const double min_range = tolerance * std::min(1e4, minRangeOf(pairs.hints));
  if (random.chance(0.3))
    for (float& axis : pairs.hints.origin) axis = static_cast<float>(min_range * random.between(-2.0, 2.0));
  const auto almost = [&random] {
    const std::array<double, 5> closeness{1e-7, 1e-6, 1e-5, 1e-3, 0.3};
    return 1.0 + random.oneOf(closeness) * random.between(-1.0, 1.0);
  };

  const std::size_t sites = 20 + random.below(150);
  for (std::size_t site = 0; site < sites; ++site) {
    // Often at the borders of sectors, which are sixteen bins from the first return's.
    double bin = random.between(0.0, static_cast<double>(sensor.columns()));
    if (random.chance(0.6)) bin = std::round(bin / 16.0) * 16.0 + static_cast<double>(random.below(4)) - 2.0;
    if (random.chance(0.3)) bin += random.between(-0.75, 0.75);
    const std::array<double, 16> spans{0, 1, 2, 3, 8, 14, 15, 16, 17, 31, 32, 33, 44, 45, 46, 47};
    const double span = random.oneOf(spans);
    const std::array<double, 6> distances{min_range,
                                          min_range + tolerance,
                                          min_range + 0.5 * tolerance,
                                          min_range * random.between(1.0, 1.5),
                                          min_range * random.magnitude(0.7, 30.0),
                                          tolerance / (2.0 * std::sin(std::max(span, 0.3) * sensor.step() / 2.0))};
    const double rho = random.oneOf(distances) * almost();
    const std::size_t one = random.below(sensor.lasers());
    const std::size_t other = random.chance(0.3) ? one : random.below(sensor.lasers());
    const double up = rho * sensor.slope(one);

    // The vector to the other return, about the tolerance long.
    const double sine = std::min(0.9, tolerance / rho);
    std::array<double, 3> way{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    switch (random.below(7)) {
      case 0:  // as far aside as possible
        way = {-sine, std::sqrt(1.0 - sine * sine), 0.0};
        break;
      case 1:  // aside at the same distance
        way = {-0.5 * sine, std::sqrt(1.0 - 0.25 * sine * sine), 0.0};
        break;
      case 2:  // above or below
        way = {random.chance(0.5) ? 0.0 : -sine, 0.0, 1.0};
        break;
      case 3:
        way = {1.0, 0.0, 0.0};
        break;
      case 4:  // onto the other laser
        way = {random.between(-0.1, 0.1), random.between(-1, 1),
               std::clamp(rho * (sensor.slope(other) - sensor.slope(one)) / tolerance, -1.0, 1.0)};
        break;
      default:
        break;
    }
    const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    const double factor = tolerance * almost() / length;
    for (double& axis : way) axis *= factor;
    if (random.chance(0.5)) way[1] = -way[1];
    if (random.chance(0.5)) way[2] = -way[2];
    const double turned = std::atan2(way[1], rho + way[0]) / sensor.step();
    // Seen in the same turn, or in the turn before or after.
    const std::array<int, 4> turns{0, 0, 1, -1};
    const double turn = sensor.steps() * random.oneOf(turns);
    sensor.set(one, bin, bin, rho, 0.0, up);
    sensor.set(other, bin + turned + turn, bin, rho + way[0], way[1], up + way[2]);
    // A third return next to one of them makes runs of more than one return.
    if (random.chance(0.4))
      sensor.set(one, bin + 1.0, bin + 1.0, rho * almost(), 0.0, up + 0.5 * tolerance * random.between(-1, 1));
  }

  // Returns far behind tell the bins of the lasers; or none do, so that the bins must be found.
  const double behind = random.chance(0.3) ? 0.0 : 500.0 / static_cast<double>(pairs.scan.cells.size());
  for (std::size_t laser = 0; laser < sensor.lasers(); ++laser)
    for (std::size_t column = 0; column < sensor.columns(); ++column) {
      if (!random.chance(behind)) continue;
      const double rho = 3000.0 * min_range * random.between(1.0, 10.0);
      const auto bin = static_cast<double>(column);
      sensor.set(laser, bin, bin, rho, 0.0, rho * sensor.slope(laser));
    }
  if (random.chance(0.1)) pairs.hints.clockwise = !pairs.hints.clockwise;  // wrong hints
  if (random.chance(0.1)) pairs.hints.steps_per_turn += static_cast<int>(random.below(20));
  return pairs;
}

}  // namespace lisco_test
