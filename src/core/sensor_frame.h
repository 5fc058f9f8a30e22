// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>

#include "core/sample.h"
#include "lisco/return.h"

namespace lisco {

/// Part of the returns, or of pairs of them, that lie as estimates say, or nearer. More: moved objects and bad returns
/// decide; less: a sensor that moves in a part of the turn is taken for one at rest.
inline constexpr double kSteadyShare = 0.75;

/// Where a rotating sensor is, and how its horizon lies.
struct SensorFrame {
  std::array<double, 3> origin{};  ///< metres
  std::array<double, 2> tilt{};    ///< by which the horizon rises along x and y
};

/// Estimates the frame from returns of some lasers. Those of one laser lie on a cone about the sensor: in its frame
/// they have one slope, z / rho. Allocates nothing.
class SensorFrameEstimator {
 public:
  /// Those of one laser follow each other.
  void add(std::size_t laser, const Return& point) { returns_.push_back({laser, point}); }

  /// By how much the slopes of a laser's returns spread as seen from a frame, in steps from laser to laser; infinite if
  /// there are too few returns. The same at any scale: from far away, all slopes are alike.
  double spread(const SensorFrame& frame) const;

  /// Steps from laser to laser in elevation, radians; infinite if there are too few returns. Those added may be of some
  /// lasers only: others are taken to lie evenly between these.
  struct ElevationSteps {
    double mean;    ///< whatever the order of the lasers
    double median;  ///< the same; about 0 if rows repeat each other
  };
  ElevationSteps elevationSteps(const SensorFrame& frame) const;

  /// The frame that makes the spread least, by Gauss-Newton steps from the middle of the returns, or from above it.
  SensorFrame fit() const;

 private:
  static constexpr std::size_t kMaxReturns = 512;
  struct LaserReturn {
    std::size_t laser;
    Return point;
  };
  using LaserReturns = Sample<LaserReturn, kMaxReturns>;
  class Slopes;

  SensorFrame middle() const;
  SensorFrame fitFrom(SensorFrame frame) const;

  LaserReturns returns_;
};

}  // namespace lisco
