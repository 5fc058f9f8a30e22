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
  /// \param number of the block, from 1 on
  /// \param map tells of the blocks before
  /// \param ground receives a byte for each of the first `columns` cells of the lasers in the order, 1 on the ground,
  ///        else 0, in rows of `stride`
  void follow(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number,
              std::uint8_t* ground, std::size_t columns, std::size_t stride);
  /// Tells the map of the block just followed.
  void tell(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map);

 private:
  void prepare(const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number);
  void report(const Block& block, const RowOrder& order, const Plane& plane);
  /// What is known before a row.
  const Passed& before(const RowOrder::Row& row, std::size_t position) const {
    return row.down == RowOrder::kNone ? starts_[position] : passed_[static_cast<std::size_t>(row.down)];
  }

  // By position in the order.
  std::vector<GroundMap::Sector*> sectors_;
  std::vector<std::size_t> sector_numbers_;  // a copy has a map of its own
  std::vector<Passed> starts_;               // of rows with none below: what is known before
  std::vector<Followed> followed_;           // then those of the starts
  std::vector<Passed> passed_;
  std::vector<Found> found_;
  std::vector<std::int32_t> last_ground_;  // of the reports: latest one with ground, or RowOrder::kNone

  std::vector<Report> reports_;
  float max_slope_ = 0.0F;
};

}  // namespace lisco::ground
