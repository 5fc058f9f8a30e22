// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/aligned_vector.h"
#include "core/ground/direction.h"
#include "core/ground/distance_bins.h"
#include "core/ground/plane_estimator.h"

namespace lisco::ground {

/// The ground found so far, by azimuth and horizontal distance: a line for each cell, in the frame of the sensor.
class GroundMap {
 public:
  static constexpr std::size_t kBins = 128;  ///< of distance, see distance_bins.h
  static constexpr float kUnknown = 1e9F;

  /// A value for each bin.
  using Values = std::array<float, kBins>;

  /// The cells of a sector of azimuth: the ground is at offset + slope * distance.
  struct alignas(64) Sector {
    Values offset{};  ///< metres
    Values slope{};   ///< metres per metre
    Values slack;     ///< metres by which the ground may differ; kUnknown: nothing is known
    Values trend{};   ///< rise of the ground from one sector to the next, metres
    Values age{};     ///< sectors since the ground was seen

    Sector() { slack.fill(kUnknown); }
  };

  void begin();

  static std::int32_t binOf(float rho) { return distanceBin(rho, static_cast<std::int32_t>(kBins)); }
  /// Distances in the middle of the bins, metres.
  static const Values& middles();

  /// Prepares a sector for a block's returns. If it was last seen in another rotation, it starts with what is known
  /// beside it.
  void prepare(std::size_t sector, std::uint32_t block, const Plane& plane) {
    if (latest_[sector] == block) return;
    if (latest_[sector] == 0 || block - latest_[sector] > kFresh) renew(sector, block, plane);
    latest_[sector] = block;
  }

  /// All kSectors sectors.
  Sector* sectors() { return sectors_.data(); }
  const Sector* sectors() const { return sectors_.data(); }

 private:
  static constexpr float kSectorWidth = kTurn / static_cast<float>(kSectors);  // radians
  static constexpr std::uint32_t kFresh = 40;  // blocks after which a sector shows the rotation before

  void renew(std::size_t number, std::uint32_t block, const Plane& plane);

  AlignedVector<Sector> sectors_;
  std::array<std::uint32_t, kSectors> latest_{};  // block that a sector was last prepared for, from 1 on; 0: none
};

}  // namespace lisco::ground
