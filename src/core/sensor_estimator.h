// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>

#include "core/sample.h"
#include "core/sensor_frame.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco {

/// Estimates the sensor from a few pairs of cells near each other.
class SensorEstimator {
 public:
  /// Two returns of one laser in adjacent columns.
  void addAlongRow(const Return& a, const Return& b) { along_row_.push_back({a, b}); }
  /// A return of a laser that has none in the next column.
  void addAlone() { ++alone_; }
  /// Between the columns of a pair that SensorHints::drift is measured by; less than half a turn of any sensor.
  static constexpr std::size_t kDriftColumns = 32;
  /// Two returns of one laser, b kDriftColumns columns after a.
  void addFurtherAlongRow(const Return& a, const Return& b) { further_.push_back({a, b}); }
  /// Two returns of adjacent lasers in one column.
  void addAlongColumn(const Return& a, const Return& b) { along_column_.push_back({a, b}); }
  /// Returns of a laser, one laser after the other.
  void addOfLaser(std::size_t laser, const Return& point) { frame_.add(laser, point); }

  /// See estimateSensor.
  SensorHints estimate(const std::array<float, 3>& declared_origin, const SensorHints& former) const;

 private:
  bool estimateFrame(const std::array<float, 3>& declared_origin, const SensorHints& former, SensorHints& hints) const;

  struct Pair {
    Return a, b;
  };
  Sample<Pair> along_row_, along_column_, further_;
  SensorFrameEstimator frame_;
  std::size_t alone_ = 0;
};

}  // namespace lisco
