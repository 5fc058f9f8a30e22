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
  /// \param map tells of the blocks before
  void followFirstRows(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map,
                       std::uint32_t number);
  /// Follows the other rows.
  /// \param ground receives 1 for each of the first `columns` cells of the lasers that is on the ground, in rows of
  ///        `stride`; 0 or nothing for the others
  void followOtherRows(const Block& block, const RowOrder& order, const GroundMap& map, std::uint8_t* ground,
                       std::size_t columns, std::size_t stride);
  /// Tells the map of the block just followed.
  void tell(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map);

 private:
  void prepare(const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number);

  void write(const RowOrder::Row* rows, std::size_t count, std::uint8_t* ground, std::size_t columns,
             std::size_t stride) const;
  FollowSetting settingOf(const Block& block, const RowOrder& order, const GroundMap& map) const;
  FollowResult result() { return {passed_.data(), followed_.data(), found_.data() + 1}; }

  // By position in the order.
  std::vector<std::uint32_t> sectors_;  // of the map
  std::vector<Passed> starts_;          // of rows with none below: what is known before
  std::vector<Followed> followed_;      // then those of the starts
  std::vector<Passed> passed_;
  std::vector<Found> found_;  // behind that of position -1
  std::vector<std::int32_t> with_ground_, scattered_;

  MapReports reports_;
  float max_slope_ = 0.0F;
};

}  // namespace lisco::ground
