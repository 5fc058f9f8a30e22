// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/grid_mask.h"

#include <limits>

namespace lisco {
namespace {

constexpr double kCellSide = 1.5;  // in units of the tolerance
constexpr std::size_t kLeastSlots = 64;
constexpr std::size_t kMostSlots = std::size_t{1} << 20;

}  // namespace

void GridMask::prepare(const Tolerance& tolerance, std::size_t expected_returns) {
  // Rounded up: a neighbour is never further than this float.
  reach_ = std::nextafter(static_cast<float>(tolerance.reach()), std::numeric_limits<float>::infinity());
  cells_per_metre_ = static_cast<float>(1.0 / (kCellSide * std::max(tolerance.reach(), 1e-22)));
  std::size_t slots = kLeastSlots;
  while (slots < kMostSlots && slots < expected_returns) slots *= 2;
  slot_mask_ = static_cast<std::uint32_t>(slots - 1);
}

void GridMask::tilesOf(const float* x, const float* y, const float* z, std::size_t count, std::uint32_t* tiles) const {
  for (std::size_t i = 0; i < count; ++i) tiles[i] = slotOf(cellOf(x[i]), cellOf(y[i]), cellOf(z[i]));
}

}  // namespace lisco
