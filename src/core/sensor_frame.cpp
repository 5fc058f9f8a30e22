// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/sensor_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lisco {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::size_t kUnknowns = 5;  // the origin, and the tilt
using Vector = std::array<double, kUnknowns>;
using Matrix = std::array<Vector, kUnknowns>;

// Fewer: frames are fitted to noise; more: scans of few returns have none (benchmarks/suite.sh recordings).
constexpr std::size_t kMinOfLaser = 4;   // returns
constexpr std::size_t kMinReturns = 40;  // of all such lasers
/// Times that the step of all lasers may be that of those around. More: a point on the ground is taken for the sensor;
/// less: so is none where lasers are spaced unevenly.
constexpr double kMostUneven = 4.0;

/// Solves a x = b for a symmetric, positive definite matrix, by Gaussian elimination.
Vector solve(Matrix a, Vector b) {
  for (std::size_t i = 0; i < kUnknowns; ++i)
    for (std::size_t row = i + 1; row < kUnknowns; ++row) {
      const double factor = a[row][i] / a[i][i];
      for (std::size_t column = i; column < kUnknowns; ++column) a[row][column] -= factor * a[i][column];
      b[row] -= factor * b[i];
    }
  for (std::size_t i = kUnknowns; i-- > 0;) {
    for (std::size_t column = i + 1; column < kUnknowns; ++column) b[i] -= a[i][column] * b[column];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace

/// The slopes of all returns as seen from a frame, laser by laser, and how they deviate from their laser's median.
class SensorFrameEstimator::Slopes {
 public:
  Slopes(const LaserReturns& returns, const SensorFrame& frame) {
    for (const LaserReturn& one : returns) {
      Seen seen;
      seen.x = static_cast<double>(one.point.x) - frame.origin[0];
      seen.y = static_cast<double>(one.point.y) - frame.origin[1];
      seen.rho = std::sqrt(seen.x * seen.x + seen.y * seen.y);
      seen.slope =
          (static_cast<double>(one.point.z) - frame.origin[2] - frame.tilt[0] * seen.x - frame.tilt[1] * seen.y) /
          seen.rho;
      seen_.push_back(seen);
    }
    Sample<double, kMaxReturns> sorted;
    for (std::size_t first = 0; first < returns.size();) {
      sorted.clear();
      std::size_t end = first;
      for (; end < returns.size() && returns[end].laser == returns[first].laser; ++end)
        sorted.push_back(seen_[end].slope);
      if (end - first >= kMinOfLaser) {
        const double median = quantile(sorted, 0.5);
        rings_.push_back({static_cast<double>(returns[first].laser), first, end, median});
      }
      first = end;
    }
  }

  /// Of most slopes about their laser's median; infinite if there are too few, or if they are no numbers.
  double spread() const {
    return spreadIn([](const Ring&) { return 1.0; });
  }

  /// The same in steps from laser to laser: that of all, or of those around if it is much less. From a point on flat
  /// ground most lasers have a slope of 0: there is no step between them, and the spread is large.
  double spreadInSteps() {
    sortRings();
    Bounds bounds;
    for (const Ring& ring : rings_) bounds.add(ring);
    const double step_of_all = bounds.step();
    return spreadIn([&](const Ring& ring) { return std::min(step_of_all, kMostUneven * stepAround(ring)); });
  }

  ElevationSteps elevationSteps() {
    sortRings();
    Bounds bounds;
    Sample<double> elevations, steps;
    for (const Ring& ring : rings_) {
      // A laser may have two rings, of about the same returns.
      if (ring.laser == bounds.last || !(std::fabs(ring.median) < kInfinity)) continue;
      bounds.add(ring);
      elevations.push_back(std::atan(ring.median));
    }
    if (elevations.size() < 2) return {kInfinity, kInfinity};
    std::sort(elevations.begin(), elevations.end());
    for (std::size_t i = 1; i < elevations.size(); ++i) steps.push_back(elevations[i] - elevations[i - 1]);
    const double lasers = bounds.last - bounds.first;
    const double all = elevations[elevations.size() - 1] - elevations[0];
    return {all / lasers, quantile(steps, 0.5) * static_cast<double>(steps.size()) / lasers};
  }

  /// By how much the frame is to change: a Gauss-Newton step on the deviations from each laser's mean, whose weights
  /// fall with the deviation.
  Vector step(const SensorFrame& frame, double scale) const {
    constexpr double kDamping = 1e-5;  // unknowns that the returns do not determine stay as they are
    Matrix a{};
    Vector b{};
    for (const Ring& ring : rings_) {
      // Sums of the derivatives and of their products; the ring's mean is taken away from these at the end.
      double weights = 0;
      double sum = 0;
      Vector sums{};
      for (std::size_t i = ring.begin; i < ring.end; ++i) {
        const Seen& seen = seen_[i];
        const double deviation = seen.slope - ring.median;
        const double outlying = deviation / scale;
        const double weight = 1 / ((1 + outlying * outlying) * (1 + outlying * outlying));
        const double inverse = 1 / seen.rho;
        const double turned = seen.slope * inverse * inverse;
        const Vector derivative{turned * seen.x + frame.tilt[0] * inverse, turned * seen.y + frame.tilt[1] * inverse,
                                -inverse, -seen.x * inverse, -seen.y * inverse};
        weights += weight;
        sum += weight * deviation;
        for (std::size_t j = 0; j < kUnknowns; ++j) {
          const double weighted = weight * derivative[j];
          sums[j] += weighted;
          b[j] -= weighted * deviation;
          for (std::size_t k = 0; k <= j; ++k) a[j][k] += weighted * derivative[k];
        }
      }
      for (std::size_t j = 0; j < kUnknowns; ++j) {
        b[j] += sums[j] * sum / weights;
        for (std::size_t k = 0; k <= j; ++k) a[j][k] -= sums[j] * sums[k] / weights;
      }
    }
    for (std::size_t j = 0; j < kUnknowns; ++j) {
      a[j][j] += kDamping * (a[j][j] + 1e-6);
      for (std::size_t k = 0; k < j; ++k) a[k][j] = a[j][k];
    }
    return solve(a, b);
  }

 private:
  /// A return as seen from the sensor.
  struct Seen {
    double x, y, rho, slope;
  };
  struct Ring {
    double laser;
    std::size_t begin, end;
    double median;
  };
  struct Bounds {
    double first = kInfinity, last = -kInfinity;      ///< lasers
    double lowest = kInfinity, highest = -kInfinity;  ///< slopes
    void add(const Ring& ring) {
      first = std::min(first, ring.laser);
      last = std::max(last, ring.laser);
      lowest = std::min(lowest, ring.median);
      highest = std::max(highest, ring.median);
    }
    double step() const { return (highest - lowest) / std::max(1.0, last - first); }
  };

  void sortRings() {
    std::sort(rings_.begin(), rings_.end(), [](const Ring& a, const Ring& b) { return a.laser < b.laser; });
  }

  /// The largest step to one of the two rings before and behind: with dual returns, two rings have the same slope.
  double stepAround(const Ring& ring) const {
    constexpr std::size_t kBeside = 2;
    const auto at = static_cast<std::size_t>(&ring - rings_.begin());
    double step = 0;
    for (std::size_t other = at - std::min(at, kBeside); other < std::min(rings_.size(), at + kBeside + 1); ++other) {
      Bounds bounds;
      bounds.add(ring);
      bounds.add(rings_[other]);
      step = std::max(step, bounds.step());
    }
    return step;
  }

  /// \param unit_of callable as double (const Ring&): the unit of a ring's deviations
  template <typename UnitOf>
  double spreadIn(UnitOf&& unit_of) const {
    Sample<double, kMaxReturns> deviations;
    for (const Ring& ring : rings_) {
      const double unit = unit_of(ring);
      for (std::size_t i = ring.begin; i < ring.end; ++i)
        deviations.push_back(unit > 0 ? std::fabs(seen_[i].slope - ring.median) / unit : kInfinity);
    }
    if (deviations.size() < kMinReturns) return kInfinity;
    const double spread = quantile(deviations, kSteadyShare);
    return spread < kInfinity ? spread : kInfinity;
  }

  Sample<Seen, kMaxReturns> seen_;
  Sample<Ring> rings_;
};

double SensorFrameEstimator::spread(const SensorFrame& frame) const {
  return Slopes(returns_, frame).spreadInSteps();
}

SensorFrameEstimator::ElevationSteps SensorFrameEstimator::elevationSteps(const SensorFrame& frame) const {
  return Slopes(returns_, frame).elevationSteps();
}

SensorFrame SensorFrameEstimator::middle() const {
  Sample<double, kMaxReturns> x, y, z;
  for (const LaserReturn& one : returns_) {
    x.push_back(static_cast<double>(one.point.x));
    y.push_back(static_cast<double>(one.point.y));
    z.push_back(static_cast<double>(one.point.z));
  }
  SensorFrame frame;
  if (!returns_.empty()) frame.origin = {quantile(x, 0.5), quantile(y, 0.5), quantile(z, 0.5)};
  return frame;
}

SensorFrame SensorFrameEstimator::fit() const {
  constexpr double kAboveGround = 1.5;  // metres: from a point on flat ground, no step leads to the sensor above it
  constexpr double kClear = 0.1;        // of the spread in steps
  SensorFrame start = middle();
  const SensorFrame first = fitFrom(start);
  const double spread_there = spread(first);
  if (spread_there < kClear) return first;
  start.origin[2] += kAboveGround;
  const SensorFrame second = fitFrom(start);
  return spread(second) < spread_there ? second : first;
}

SensorFrame SensorFrameEstimator::fitFrom(SensorFrame frame) const {
  constexpr int kSteps = 5;
  constexpr double kSettled = 0.02;  // metres
  constexpr double kMaxTilt = 0.3;
  constexpr double kMinScale = 1e-5;  // of slopes: rounding
  for (int i = 0; i < kSteps; ++i) {
    Slopes slopes(returns_, frame);
    const double spread = slopes.spread();
    if (std::isinf(spread)) break;
    const Vector step = slopes.step(frame, 2 * spread + kMinScale);
    for (std::size_t axis = 0; axis < 3; ++axis) frame.origin[axis] += step[axis];
    for (std::size_t axis = 0; axis < 2; ++axis)
      frame.tilt[axis] = std::clamp(frame.tilt[axis] + step[3 + axis], -kMaxTilt, kMaxTilt);
    if (std::fabs(step[0]) + std::fabs(step[1]) + std::fabs(step[2]) < kSettled) break;
  }
  return frame;
}

}  // namespace lisco
