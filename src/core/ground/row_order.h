// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ground/block.h"
#include "core/ground/direction.h"
#include "core/ground/latest_returns.h"

namespace lisco::ground {

/// Which rows of the columns are above each other: learned from the returns, so that rows may have any order and
/// lasers may be staggered.
class RowOrder {
 public:
  static constexpr std::int32_t kNone = -1;
  static constexpr std::size_t kPadding = 8;  ///< elements, the most that are looked at together

  struct Row {
    std::int32_t row;        ///< in the block
    std::int32_t down;       ///< position in the order of the next row below with about its azimuth, or kNone
    std::int32_t up;         ///< of the next row above, or kNone
    std::int32_t up_row;     ///< that row in the block, or the number of lasers
    std::int32_t above_row;  ///< a row clearly above, or the number of lasers
  };

  void begin(std::size_t lasers);
  /// Makes room for all lasers; a copy has it only for those with returns.
  void reserve();
  /// Learns from a block's returns.
  void update(const Block& block);
  /// The rows that have had returns, from the lowest one up.
  const std::vector<Row>& rows() const { return rows_; }
  /// Sectors of the rows' latest returns, by row.
  const std::int32_t* sectors() const { return latest_.sector.data(); }
  Direction directionOf(std::int32_t row) const {
    const auto i = static_cast<std::size_t>(row);
    return {latest_.x[i] / latest_.rho[i], latest_.y[i] / latest_.rho[i]};
  }

  /// The row of one of the order's keys.
  static std::int32_t rowOf(std::uint64_t key) { return static_cast<std::int32_t>(key & 0x7FFFFFFFU); }

  bool turnsLeft() const { return turn_ > 0.0F; }

 private:
  void sort();

  std::size_t lasers_ = 0;
  LatestReturns latest_;
  std::vector<Row> rows_;
  std::vector<std::uint64_t> order_;  // slope and row; see orderedBits
  // By position in the order: azimuth of the latest return, turned on to the latest block, radians, with kPadding
  // elements before and behind; and the slope of its ray.
  std::vector<float> azimuths_, slopes_;
  std::uint32_t block_ = 0;
  std::uint32_t sort_at_ = 0;
  float turn_ = 0.0F;  // of the azimuth per block, radians
};

}  // namespace lisco::ground
