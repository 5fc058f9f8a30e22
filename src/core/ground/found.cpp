// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/found.h"

#include <cstddef>

#include "core/bits.h"

namespace lisco::ground {
namespace {

// Least part of the ground among a row's returns and those of the rows next to it.
constexpr std::uint32_t kMinGround = 2, kOfReturns = 7;

}  // namespace

void dropScattered(const std::vector<RowOrder::Row>& rows, std::vector<Found>& found) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    found[i].is_scattered = false;
    if (found[i].ground == 0) continue;
    const auto higherAt = [&](std::int32_t position) {
      return position == RowOrder::kNone ? 0 : found[static_cast<std::size_t>(position)].higher;
    };
    if ((found[i].higher | higherAt(rows[i].down) | higherAt(rows[i].up)) == 0) continue;
    std::uint32_t ground = 0, returns = 0;
    for (const std::int32_t position : {static_cast<std::int32_t>(i), rows[i].down, rows[i].up}) {
      if (position == RowOrder::kNone) continue;
      const Found& row = found[static_cast<std::size_t>(position)];
      ground += countBits(row.ground);
      returns += countBits(static_cast<ColumnBits>(row.ground | row.higher));
    }
    found[i].is_scattered = ground * kOfReturns < returns * kMinGround;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!found[i].is_scattered) continue;
    found[i].ground &= found[i].known;
    found[i].reached &= found[i].known;
  }
}

}  // namespace lisco::ground
