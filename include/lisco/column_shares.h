// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "lisco/return.h"

namespace lisco {

/// Shares the columns of a rotation out to threads: columns side by side, by the work that they took in the rotation before, as far
/// as somebody counted it; or, if there was none of as many columns and lasers, by the number of returns.
class ColumnShares {
 public:
  /// Gets ready for a rotation.
  /// \param cell_at callable as Return (std::size_t laser, std::size_t column)
  template <typename CellAt>
  void prepare(std::size_t columns, std::size_t lasers, CellAt&& cell_at) {
    const bool is_like_last = lasers == lasers_ && columns == columns_;
    lasers_ = lasers;
    columns_ = columns;
    if (is_like_last) return;
    weights_.clear();
    for (std::size_t column = 0; column < columns; column += kGroup) {
      std::size_t returns = 0;
      for (std::size_t laser = column / kGroup % kSampled; laser < lasers; laser += kSampled) {
        const Return cell = cell_at(laser, column);
        returns += isReturn(cell.x, cell.y, cell.z) ? 1 : 0;
      }
      weights_.push_back(static_cast<std::uint32_t>(lasers + kSampled * kReturnWeight * returns));
    }
  }

  /// Into how many shares, up to so many, the columns may be cut.
  std::size_t shares(std::size_t most) const {
    constexpr std::size_t kFewestGroups = 4;
    return std::clamp<std::size_t>(weights_.size() / kFewestGroups, 1, most);
  }

  /// Calls visit(share, first_column, end_column) for each of so many shares.
  template <typename Visit>
  void cut(std::size_t shares, Visit&& visit) const {
    const auto all = std::accumulate(weights_.begin(), weights_.end(), std::uint64_t{0});
    std::uint64_t sum = 0;
    std::size_t group = 0;
    for (std::size_t share = 0; share < shares; ++share) {
      const std::size_t first = group;
      while (group < weights_.size() && sum < all * (share + 1) / shares) sum += weights_[group++];
      visit(share, std::min(first * kGroup, columns_), std::min(group * kGroup, columns_));
    }
  }

  /// Notes what some columns took, in any unit. Threads may do so at the same time, each for its own share.
  void weigh(std::size_t first, std::size_t columns, std::size_t work) {
    const std::size_t begin = first / kGroup;
    const std::size_t end = (first + columns + kGroup - 1) / kGroup;
    // Never 0: a column without weight would be nobody's.
    const std::size_t weight = std::clamp<std::size_t>(work / (end - begin), 1, std::size_t{1} << 30U);
    std::fill(weights_.begin() + static_cast<std::ptrdiff_t>(begin),
              weights_.begin() + static_cast<std::ptrdiff_t>(end), static_cast<std::uint32_t>(weight));
  }

 private:
  static constexpr std::size_t kGroup = 16;        // columns that are weighed together
  static constexpr std::size_t kSampled = 4;       // one in so many lasers is looked at, in one column of a group
  static constexpr std::size_t kReturnWeight = 4;  // of a return, when a cell has 1

  std::size_t columns_ = 0, lasers_ = 0;
  std::vector<std::uint32_t> weights_;
};

}  // namespace lisco
