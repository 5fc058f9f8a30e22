// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/bits.h"
#include "core/neighbour.h"
#include "core/ring_block.h"
#include "core/stream_position.h"
#include "lisco/endless_clusterer.h"

namespace lisco {

/// Which columns of an endless stream can reach which returns, by azimuth: the definition in EndlessClusterer.
class StreamReach {
 public:
  static constexpr std::int64_t kComparablePanes = 4;  ///< panes whose returns may be neighbours

  /// Starts a stream.
  void begin(const EndlessParameters& parameters);

  /// Sets the position (turns) of a column of the next block.
  void setColumn(std::size_t column, double position);

  /// Finds the returns of a block whose azimuth differs from that of their column by more than the stagger.
  /// \param rho receives the horizontal distances, metres: in double, since squares may overflow or underflow a float
  ColumnBits findOutliers(const RingBlock& block, const RingBlockInfo& info, double* rho) const;

  /// The position from which on no column can reach a return, nor what was reached up to `known`.
  /// \param column position of the return
  /// \param pane of the return
  /// \param rho horizontal distance, metres
  Ticks endOf(Ticks column, std::int64_t pane, double rho, Ticks known) const;

  /// A ray from the sensor. All returns of a pane lie on one side of that at its end plus the stagger.
  struct Ray {
    std::array<double, 2> across;  ///< unit vector from the ray towards later columns
  };
  Ray rayAfter(std::int64_t pane) const;
  /// False if the box lies beyond the ray, further from it than the tolerance.
  bool reaches(const Box& box, const Ray& ray) const;

 private:
  /// Of a position, radians.
  double azimuthOf(double turns) const;

  Tolerance tolerance_;
  std::array<float, 3> origin_{};  ///< of the sensor, metres
  double start_azimuth_ = 0;       ///< radians
  double direction_ = 1;           ///< +1: counter-clockwise
  float cos_stagger_ = 0;          ///< rounded down so that no return is wrongly an outlier
  double turns_of_stagger_ = 0;    ///< of both returns of a pair, rounded up
  double near_rho_ = 0;            ///< up to here a neighbour may lie at any azimuth, metres
  std::array<float, RingBlock::kColumns> cosines_{}, sines_{};  ///< of the columns' azimuths
};

}  // namespace lisco
