// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/ground/block.h"
#include "core/ground/found.h"
#include "core/ground/ground_map.h"

namespace lisco::ground {

/// A float for each column of a block.
using Lanes = std::array<float, Block::kColumns>;

/// The ground that the rows of a block up to one of them have shown, per column.
struct Followed {
  Lanes rho, height;            ///< of the ground reached; rho is 0 before the first return on it
  Lanes slope;                  ///< of the ground up to there
  Lanes back_rho, back_height;  ///< ground further inwards, from which the slope is measured
  Lanes next_rho, next_height;  ///< becomes that
};

/// What the rows up to one of them have shown.
struct Passed {
  const Followed* followed;
  Lanes reach;             ///< distance of the farthest return
  Lanes limit;             ///< no ground is higher than this, beneath the sensor, but for the steepest slope
  std::uint8_t obstacles;  ///< columns in which objects hide the ground beyond the ground reached, as bits
};

/// A row of a block, for the kernel.
struct FollowedRow {
  const float* rho;
  const float* height;
  const float* up_rho;  ///< of the row above; zeros if there is none
  const float* up_height;
  const float* above_rho;  ///< of a row clearly above
  const float* above_height;
  const Passed* before;  ///< of the rows below
  Passed* passed;
  Followed* followed;  ///< used where this row changes what the rows below have shown
  const GroundMap::Sector* sector;
  std::uint8_t returns;  ///< columns with returns, as bits
};

/// Follows the ground of a block's columns outwards, row by row in the order given.
/// \param max_slope of ground, metres per metre
/// \param found receives what is found, for each row
void followRows(const FollowedRow* rows, std::size_t count, float max_slope, Found* found);

}  // namespace lisco::ground
