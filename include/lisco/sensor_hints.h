// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>

#include "lisco/return.h"

namespace lisco {

/// What may be known of the sensor before a rotation. Decides how fast clusterers are, never their result; GroundFilter
/// searches for the ground by it.
struct SensorHints {
  std::array<float, 3> origin{0.0F, 0.0F, 0.0F};  ///< position of the sensor, metres
  std::array<float, 2> tilt{0.0F, 0.0F};          ///< by which the sensor's horizon rises along x and y (slopes)
  float elevation_step = 0.0087F;                 ///< typical angle between adjacent lasers, radians
  int steps_per_turn = 0;                         ///< columns of a whole turn; 0: unknown, or no rotating sensor
  bool clockwise = false;                         ///< sense of rotation, seen from above
  float far_distance = 1e30F;                     ///< horizontal distance that a fifth of the returns exceed, metres
  float jitter = 0.0F;  ///< by how much azimuths of adjacent columns differ from a step of the turn, in steps
  float drift = 0.0F;   ///< by how much azimuths of columns that are 32 apart differ from 32 steps, in steps
  /// Typical difference between the ranges of one laser's returns in adjacent columns, metres; infinite if most have
  /// none in the next column.
  float roughness = 0.0F;
  /// By how much the slopes of a laser's returns differ as seen from the origin, in steps between lasers; 0: not
  /// measured.
  float slope_spread = 0.0F;
};

/// Estimates the sensor of an organized cloud (lasers > 1) from about a hundred of its cells and those beside them, or
/// of a rotation before. Allocates nothing. Without a clear answer, steps_per_turn is 0, as it is for fewer than 4096
/// cells and for less than a quarter of a turn. The origin is (0, 0, 0), the declared one, or an estimate, if the cloud
/// shows clearly that it is there; so is the tilt, which otherwise is 0.
/// \param declared_origin position that the cloud states for its sensor, metres; without effect if not finite
/// \param former the estimate of the cloud before, whose origin and tilt are kept if this cloud has about its
///        slope_spread there: finding them is most of the work
LISCO_EXPORT SensorHints estimateSensor(std::size_t columns, std::size_t lasers,
                                        const std::array<float, 3>& declared_origin, const CellSource& cells,
                                        const SensorHints& former = {});

}  // namespace lisco
