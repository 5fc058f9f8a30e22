// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ground/block.h"
#include "core/ground/direction.h"

namespace lisco::ground {

/// Which rows of the columns are above each other: learned from the returns, so that rows may have any order and
/// lasers may be staggered.
class RowOrder {
 public:
  static constexpr std::int32_t kNone = -1;

  struct Row {
    std::int32_t row;    ///< in the block
    std::int32_t down;   ///< position in the order of the next row below with about its azimuth, or kNone
    std::int32_t up;     ///< of the next row above, or kNone
    std::int32_t above;  ///< of one clearly above, or kNone
  };

  void begin(std::size_t lasers);
  /// Learns from a block's returns.
  void update(const Block& block);
  /// The rows that have had returns, from the lowest one up.
  const std::vector<Row>& rows() const { return rows_; }
  /// Azimuth of a row's returns in the latest block, radians, 0 to 2 pi.
  float azimuthOf(std::int32_t row) const { return seen_[static_cast<std::size_t>(row)].azimuth; }
  Direction directionOf(std::int32_t row) const {
    const Seen& seen = seen_[static_cast<std::size_t>(row)];
    return {seen.x / seen.rho, seen.y / seen.rho};
  }

  bool turnsLeft() const { return turn_ > 0.0F; }

 private:
  struct Seen {
    float x = 1.0F, y = 0.0F, rho = 1.0F, height = 0.0F;  // of the latest return
    float azimuth = 0.0F;                                 // radians
    std::uint32_t block = 0;

    float slope() const { return height / rho; }
  };
  void sort();

  std::vector<Seen> seen_;
  std::vector<Row> rows_;
  std::vector<std::int32_t> order_;
  std::vector<float> now_;
  std::uint32_t block_ = 0;
  std::uint32_t sort_at_ = 0;
  float turn_ = 0.0F;  // of the azimuth per block, radians
};

}  // namespace lisco::ground
