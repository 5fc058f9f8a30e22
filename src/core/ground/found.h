// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/ground/row_order.h"

namespace lisco::ground {

/// Decisions on the returns of a row of a block: bit i for column i.
struct Found {
  std::uint8_t ground;     ///< on the ground
  std::uint8_t reached;    ///< of these, those from which the ground is followed further outwards
  std::uint8_t confirmed;  ///< near the straight continuation of the ground further inwards
  std::uint8_t known;      ///< at the height of the map, where that is well known
  std::uint8_t higher;     ///< no ground, and above that continuation
};

/// Removes ground from rows where most returns around are `higher`, as single leaves of a hedge may be in line with the
/// ground in front of it. `known` ground stays.
/// \param found by position in the order; that of RowOrder::kNone, position -1, is empty
/// \param with_ground positions of the rows with ground; the first `count` are used
/// \param unevenness Unevenness::value
/// \param scattered at least `count` elements, overwritten
void dropScattered(const RowOrder::Row* rows, Found* found, const std::vector<std::int32_t>& with_ground,
                   std::size_t count, float unevenness, std::vector<std::int32_t>& scattered);

}  // namespace lisco::ground
