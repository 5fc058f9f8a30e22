// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lisco/box.h"
#include "lisco/tolerance.h"

namespace lisco {

/// The neighbour mask of points that no single place has seen (unorganized maps, clouds of several sensors):
/// cubic cells instead of tiles of a view, hashed into a table. Cells that share a slot only cost time.
class GridMask {
 public:
  /// Lays out the table for about `expected_returns` returns.
  void prepare(const Tolerance& tolerance, std::size_t expected_returns);

  std::size_t tileCount() const { return static_cast<std::size_t>(slot_mask_) + 1; }

  /// tiles[i] = slot of the cell that the return (x[i], y[i], z[i]) lies in.
  void tilesOf(const float* x, const float* y, const float* z, std::size_t count, std::uint32_t* tiles) const;

  /// Calls visit(slot) for every cell that may hold a neighbour of any return within the box; a slot may come
  /// twice.
  template <typename Visit>
  void forEachTile(const Box& box, Visit&& visit) const;

 private:
  /// Grows with x (rounding is monotone and the ends are clamped), so that no margin is needed: a float
  /// x <= hi + reach is also <= the float nearest to hi + reach.
  std::int32_t cellOf(float x) const {
    constexpr float kMost = 2e9F;
    return static_cast<std::int32_t>(std::floor(std::clamp(x * cells_per_metre_, -kMost, kMost)));
  }
  std::uint32_t slotOf(std::int32_t x, std::int32_t y, std::int32_t z) const {
    // Teschner et al. 2003, with a final mix so that flat scenes use the whole table.
    std::uint32_t h = static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U ^
                      static_cast<std::uint32_t>(z) * 83492791U;
    h ^= h >> 15;
    return h & slot_mask_;
  }

  float cells_per_metre_ = 1.0F;
  float reach_ = 0.0F;
  std::uint32_t slot_mask_ = 0;
};

template <typename Visit>
void GridMask::forEachTile(const Box& box, Visit&& visit) const {
  std::array<std::int32_t, 3> first{};
  std::array<std::int32_t, 3> last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = cellOf(box.lo[axis] - reach_);
    last[axis] = cellOf(box.hi[axis] + reach_);
  }
  for (std::int32_t z = first[2]; z <= last[2]; ++z)
    for (std::int32_t y = first[1]; y <= last[1]; ++y)
      for (std::int32_t x = first[0]; x <= last[0]; ++x) visit(slotOf(x, y, z));
}

}  // namespace lisco
