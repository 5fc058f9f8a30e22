// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <optional>

namespace lisco_apps {

/// How far a sensor has turned, which never goes back: its whole part counts turns, the rest is the azimuth.
class TurnPosition {
 public:
  /// \param azimuth of the next column, degrees clockwise
  /// \param turns_by_time how far the sensor has turned since the last column, by its clock and its speed; nullopt:
  ///        unknown, it is then taken for less than a turn
  /// \param after_break whether it was a turn at least
  /// \return turns; the same as for the last column if the azimuth steps back
  double next(double azimuth, std::optional<double> turns_by_time, bool after_break) {
    const double direction = azimuth / 360;
    if (!started_) {
      started_ = true;
      position_ = direction;
      return position_;
    }
    double ahead = direction - position_;
    ahead -= std::floor(ahead);
    constexpr double kLongestAhead = 350. / 360;  // further is a step back
    const double turns = turns_by_time ? std::round(*turns_by_time - ahead) : ahead > kLongestAhead ? -1. : 0.;
    double advance = ahead + turns;
    if (after_break && advance < 1) advance = ahead + 1;
    if (advance > 0) position_ += advance;
    return position_;
  }

 private:
  bool started_ = false;
  double position_ = 0;
};

}  // namespace lisco_apps
