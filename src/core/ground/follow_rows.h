// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/ground/block.h"
#include "core/ground/found.h"
#include "core/ground/ground_map.h"
#include "core/ground/row_order.h"

namespace lisco::ground {

/// A float for each column of a block.
using Lanes = std::array<float, Block::kColumns>;

/// The ground that the rows of a block up to one of them have shown, per column.
struct alignas(sizeof(Lanes)) GroundReached {
  Lanes rho, height;            ///< of the ground reached; rho is 0 before the first return on it
  Lanes slope;                  ///< of the ground up to there
  Lanes back_rho, back_height;  ///< ground further inwards, from which the slope is measured
  Lanes next_rho, next_height;  ///< becomes back_rho, back_height, once the ground is kBaseline beyond it
};

/// What the rows up to one of them have shown, per column of the block.
struct alignas(sizeof(Lanes)) Passed {
  Lanes limit;             ///< metres: at a distance rho, no ground is higher than limit + max_slope * rho
  std::size_t followed;    ///< number of the GroundReached, in FollowResult
  std::uint8_t obstacles;  ///< columns in which objects hide the ground beyond the ground reached, as bits
};

/// What the rows are followed with. Rows are numbered by their position in the order.
struct FollowSetting {
  const Block* block;
  const RowOrder::Row* rows;
  std::size_t size;
  float max_slope;               ///< of ground, metres per metre
  const GroundMap::Sector* map;  ///< all sectors
  const std::uint32_t* sectors;  ///< for each row, its sector
  const Passed* starts;          ///< for each row with none below: what is known before it
  float unevenness;              ///< Unevenness::value
};

/// What they show, for each row.
struct FollowResult {
  Passed* passed;
  /// Of each row that changes the ground reached; see Passed::followed. Elements of `starts` follow those of the rows.
  GroundReached* followed;
  Found* found;
};

/// Follows the ground of a block's columns outwards, row by row in their order, from row `first` to before `end`; those
/// before them have been followed.
void followRows(const FollowSetting& setting, std::size_t first, std::size_t end, const FollowResult& result);

}  // namespace lisco::ground
