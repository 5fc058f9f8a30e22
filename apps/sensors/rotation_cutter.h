// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace lisco_apps {

/// A turn ends after this many columns, which bounds its memory if the sensor does not turn: 0.01 degrees per column,
/// the resolution of azimuths in packets.
inline constexpr std::size_t kMaxColumns = 36000;

/// Cuts a stream of columns into rotations of at most a full turn (and a step back). The sensor may turn either way;
/// columns may step back a little, and any number of them may be missing.
class RotationCutter {
 public:
  /// \param cut azimuth at which each rotation begins, degrees; nullopt: that of the first column
  explicit RotationCutter(std::optional<double> cut = std::nullopt);

  /// \param azimuth of the next column, degrees, finite; steps of more than 350 degrees are steps back
  /// \param after_break whether at least a whole turn is missing before it, which the azimuth does not show
  /// \return whether a rotation starts with it
  bool startsRotation(double azimuth, bool after_break = false);

 private:
  using Angle = std::int64_t;  ///< millionths of a degree: sums are exact

  bool isClockwise() const { return drift_ >= 0; }
  void placeFromCut(Angle azimuth);

  std::optional<Angle> cut_;
  bool started_ = false;
  Angle last_ = 0;    ///< azimuth of the last column
  Angle turned_ = 0;  ///< from the cut to the last column, clockwise
  Angle drift_ = 0;   ///< positive if the latest columns turned clockwise
};

}  // namespace lisco_apps
