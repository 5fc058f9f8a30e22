// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ground/block.h"
#include "core/ground/found.h"
#include "core/ground/ground_map.h"
#include "core/ground/plane_estimator.h"
#include "core/ground/row_order.h"

namespace lisco::ground {

/// A float for each column of a block.
using Lanes = std::array<float, Block::kColumns>;

/// What the rows of a block up to one of them have shown, per column.
struct Followed {
  Lanes rho, height;            ///< of the ground reached; rho is 0 before the first return on it
  Lanes slope;                  ///< of the ground up to there
  Lanes back_rho, back_height;  ///< ground further inwards, from which the slope is measured
  Lanes next_rho, next_height;  ///< becomes that
  Lanes obstacle;               ///< 1: objects hide the ground beyond the ground reached; else 0
  Lanes limit;                  ///< no ground is higher than this, beneath the sensor, but for the steepest slope
  Lanes reach;                  ///< distance of the farthest return
};

/// Follows the ground of a block's columns outwards, row by row from the lowest one, eight columns at a time.
class Follower {
 public:
  /// Allocates only if there are more lasers than ever before.
  void begin(std::size_t lasers, float max_slope);
  /// \param number of the block, from 1 on
  /// \param map tells of the blocks before, and is told of this one
  /// \param ground receives a byte for each cell of the block, 1 on the ground
  void follow(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number,
              std::uint8_t* ground);

  /// A row of the block, for the kernel.
  struct Row {
    const float* rho;
    const float* height;
    const float* up_rho;  ///< of the row above; zeros if there is none
    const float* up_height;
    const float* above_rho;  ///< of a row clearly above
    const float* above_height;
    const Followed* before;  ///< of the rows below
    Followed* followed;
    const GroundMap::Sector* sector;
  };

 private:
  void tellMap(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number);

  std::vector<Followed> followed_;         // by position in the order
  std::vector<Found> found_;               // likewise
  std::vector<std::int32_t> last_ground_;  // position of the latest row with ground, or RowOrder::kNone
  std::vector<std::uint8_t> goes_on_;      // whether a row further up has found ground beyond
  std::vector<Followed> starts_;           // of rows with none below
  std::vector<Row> rows_;
  float max_slope_ = 0.0F;
};

}  // namespace lisco::ground
