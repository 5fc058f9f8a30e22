// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/ground/block.h"
#include "core/ground/column_line.h"
#include "core/ground/direction.h"
#include "lisco/ground_filter.h"

namespace lisco::ground {

/// The ground around the sensor, in its frame: height (metres) beneath it, and slopes along x and y.
struct Plane {
  float height = 0.0F;
  float slope_x = 0.0F, slope_y = 0.0F;

  float slopeTowards(const Direction& direction) const { return slope_x * direction.x + slope_y * direction.y; }
};

/// Estimates the plane of the ground around the sensor from columns: the lowest height that lines through many
/// columns' returns agree with, and the slopes of these lines.
class PlaneEstimator {
 public:
  static constexpr std::size_t kMemory = 64;  ///< columns

  /// Forgets all columns. A height that is not NaN is not estimated. Allocates only if there are more lasers than ever
  /// before.
  void begin(const GroundParameters& parameters, float max_slope, std::size_t lasers);

  /// Adds what a column of a block shows, if it shows ground clearly; forgets the oldest of kMemory.
  /// \param columns those that the block was measured from, `first` its first one
  void add(const Block& block, const Columns& columns, std::size_t first, std::size_t column);

  /// Updates the plane by the columns added since the last update; it stays as it is if they show too little.
  void update();

  /// Estimates the plane by all columns added, as those of a whole scan, instead of update ().
  void estimate();

  /// Whether a height was given or found.
  bool hasHeight() const { return height_state_ != Height::kUnknown; }
  /// Whether there is a plane: a height was given, or enough of the latest updates have shown ground.
  bool isKnown() const;
  const Plane& plane() const { return plane_; }

 private:
  bool find();
  void fitSlopes();
  void refine();
  float weightOn(const Plane& plane) const;

  ColumnLineFinder finder_;
  static_assert(kMemory <= kMaxLines);
  std::array<ColumnLine, kMemory> lines_;
  std::size_t count_ = 0;  // ever added
  Plane plane_;
  enum class Height { kUnknown, kGiven, kFound } height_state_ = Height::kUnknown;
  static constexpr std::uint32_t kUpdates = 64;
  std::uint32_t updates_ = 0;  // up to kUpdates
  std::size_t seen_ = 0;       // of count_, by the latest update
  std::uint64_t showed_ = 0;   // bit i: whether the update i updates ago showed ground, of kUpdates
  float max_slope_ = 0.0F;
};

}  // namespace lisco::ground
