// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>

namespace lisco {

/// What may be known beforehand about a scan. It decides the speed, never the result.
struct ViewHints {
  std::array<float, 3> origin{0.0F, 0.0F, 0.0F};  ///< where the sensor stands, metres
  float elevation_step = 0.0087F;                 ///< typical angle between lasers, radians
  int steps_per_turn = 0;                         ///< columns of a whole turn; 0: unknown, or no rotating sensor
  bool clockwise = false;                         ///< seen from above; of no use without steps_per_turn
  float far_distance = 1e30F;                     ///< few returns are further away horizontally, metres
  /// By how much the ranges of one laser's returns in two columns side by side differ, metres; infinite if most have
  /// none beside them.
  float roughness = 0.0F;
};

}  // namespace lisco
