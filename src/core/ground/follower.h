// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ground/block.h"
#include "core/ground/follow_rows.h"
#include "core/ground/found.h"
#include "core/ground/ground_map.h"
#include "core/ground/map_reports.h"
#include "core/ground/plane_estimator.h"
#include "core/ground/row_order.h"

namespace lisco::ground {

/// Follows the ground of a block's columns outwards, row by row from the lowest one, eight columns at a time.
class Follower {
 public:
  /// Allocates only if there are more lasers than ever before.
  void begin(std::size_t lasers, float max_slope);
  /// Follows the first rows of a block.
  /// \param number of the block, from 1 on
  /// \param map ground of the blocks before
  void followFirstRows(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map,
                       std::uint32_t number);
  /// Follows the other rows, and writes the decisions on all.
  /// \param ground zeros, in rows of `stride`; receives 1 for each of a laser's first `columns` cells on the ground
  void followOtherRows(const Block& block, const RowOrder& order, const GroundMap& map, std::uint8_t* ground,
                       std::size_t columns, std::size_t stride);
  /// Enters the block just followed into the map.
  void enterIntoMap(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map);

 private:
  void prepare(const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number);

  void write(const RowOrder::Row* rows, std::uint8_t* ground, std::size_t columns, std::size_t stride) const;
  FollowSetting settingOf(const Block& block, const RowOrder& order, const GroundMap& map) const;
  FollowResult result() { return {passed_.data(), followed_.data(), found_.data() + 1}; }

  // By position in the order.
  std::vector<std::uint32_t> sectors_;   // of the map
  std::vector<Passed> starts_;           // of rows with none below: what is known before
  std::vector<GroundReached> followed_;  // element i: of row i; size () / 2 + i: before row i, if none is below
  std::vector<Passed> passed_;
  std::vector<Found> found_;  // element i + 1: of row i; element 0: none
  std::vector<std::int32_t> with_ground_, scattered_;
  std::size_t with_ground_count_ = 0;

  MapReports reports_;
  float max_slope_ = 0.0F;
};

}  // namespace lisco::ground
