// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <optional>

namespace lisco_apps {

/// The unwrapped position of a sensor, which never decreases: whole turns plus azimuth / 360 degrees.
class TurnPosition {
 public:
  /// \param azimuth of the next column, degrees clockwise
  /// \param turns_by_time turns since the last column, by the sensor's clock and speed; nullopt: less than one
  /// \param after_break whether at least one turn is missing before the column
  /// \return turns; unchanged if the azimuth steps back
  double next(double azimuth, std::optional<double> turns_by_time, bool after_break) {
    const double direction = azimuth / 360;
    if (!started_) {
      started_ = true;
      position_ = direction;
      return position_;
    }
    double ahead = direction - position_;
    ahead -= std::floor(ahead);
    const double turns = turns_by_time ? std::round(*turns_by_time - ahead) : ahead > kMaxAhead ? -1. : 0.;
    double advance = ahead + turns;
    if (after_break && advance < 1) advance = ahead + 1;
    if (advance > 0) position_ += advance;
    return position_;
  }

 private:
  static constexpr double kMaxAhead = 350. / 360;  ///< turns; more is a step back

  bool started_ = false;
  double position_ = 0;
};

}  // namespace lisco_apps
