// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/ground/row_order.h"

namespace lisco::ground {

/// Which columns of a row of a block have ground, as bits.
struct Found {
  std::uint8_t ground;     ///< the return is on the ground
  std::uint8_t reached;    ///< and the ground goes on to there
  std::uint8_t confirmed;  ///< it is about where the ground before lets expect it
  std::uint8_t known;      ///< it is where the map has ground
  std::uint8_t higher;     ///< the return is no ground, and higher than the ground would be
};

/// Takes back ground among returns of which most are higher, as single leaves of a hedge may be in line with the ground
/// in front of it; what the map has known stays.
/// \param found by position in the order; that of position -1, RowOrder::kNone, is empty
/// \param with_ground positions of the rows with ground
/// \param scattered room for as many
void dropScattered(const RowOrder::Row* rows, Found* found, const std::vector<std::int32_t>& with_ground,
                   std::size_t count, std::vector<std::int32_t>& scattered);

}  // namespace lisco::ground
