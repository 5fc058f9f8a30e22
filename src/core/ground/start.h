// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>

#include "core/ground/block.h"

namespace lisco::ground {

/// Estimates the height of the ground beneath the sensor, above its horizon, from columns: the lowest height that many
/// returns agree with.
class StartEstimator {
 public:
  static constexpr std::size_t kMemory = 64;  ///< columns

  /// Forgets all columns.
  /// \param sensor unless it shows where the sensor is, the ground may be as high as the origin of the cloud
  void begin(const SensorHints& sensor) {
    const bool known = sensor.steps_per_turn != 0 || sensor.origin != std::array<float, 3>{};
    highest_ = known ? -0.2F : 0.5F;
    count_ = 0;
  }

  /// Adds what a column shows, if it shows ground clearly; forgets the oldest of kMemory.
  /// \param block whose column it is
  void add(const Block& block, std::size_t column, float max_slope);

  /// NaN if too little was added.
  float estimate() const;

 private:
  struct Vote {
    float height;
    float weight;
  };
  std::array<Vote, kMemory> votes_;
  std::size_t count_ = 0;  // ever added
  float highest_ = 0.0F;   // metres
};

}  // namespace lisco::ground
