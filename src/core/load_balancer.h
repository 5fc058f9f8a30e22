// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "lisco/return.h"

namespace lisco {

/// Divides the columns of a rotation among threads: consecutive columns of about equal work, measured in the rotation
/// before if that had as many columns and lasers, else estimated from the number of returns.
class LoadBalancer {
 public:
  /// Prepares for a rotation.
  void prepare(std::size_t columns, std::size_t lasers, const CellSource& cells) {
    const bool is_like_last = lasers == lasers_ && columns == columns_;
    lasers_ = lasers;
    columns_ = columns;
    if (is_like_last) return;
    weights_.clear();
    for (std::size_t column = 0; column < columns; column += kGroup) {
      std::size_t returns = 0;
      for (std::size_t laser = column / kGroup % kSampled; laser < lasers; laser += kSampled) {
        const Return cell = cells.at(laser, column);
        returns += isReturn(cell.x, cell.y, cell.z) ? 1 : 0;
      }
      weights_.push_back(static_cast<std::uint32_t>(lasers + kSampled * kReturnWeight * returns));
    }
  }

  /// Number of parts, up to a maximum, that are worth a thread each.
  std::size_t partCount(std::size_t max_parts) const {
    return std::clamp<std::size_t>(weights_.size() / kMinGroups, 1, max_parts);
  }

  /// Calls visit(part, first_column, end_column) for each part.
  template <typename Visit>
  void divide(std::size_t parts, Visit&& visit) const {
    const auto all = std::accumulate(weights_.begin(), weights_.end(), std::uint64_t{0});
    std::uint64_t sum = 0;
    std::size_t group = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t first = group;
      while (group < weights_.size() && sum < all * (part + 1) / parts) sum += weights_[group++];
      visit(part, std::min(first * kGroup, columns_), std::min(group * kGroup, columns_));
    }
  }

  /// Records the work of some columns, in any unit. Threads may call it at the same time, each for its own part.
  void record(std::size_t first, std::size_t columns, std::size_t work) {
    if (columns == 0) return;
    const std::size_t begin = first / kGroup;
    const std::size_t end = (first + columns + kGroup - 1) / kGroup;
    // At least 1, so that every column belongs to a part.
    const std::size_t weight = std::clamp<std::size_t>(work / (end - begin), 1, std::size_t{1} << 30U);
    std::fill(weights_.begin() + static_cast<std::ptrdiff_t>(begin),
              weights_.begin() + static_cast<std::ptrdiff_t>(end), static_cast<std::uint32_t>(weight));
  }

 private:
  static constexpr std::size_t kGroup = 16;        ///< columns weighed together
  static constexpr std::size_t kMinGroups = 4;     ///< of a part: 64 columns
  static constexpr std::size_t kSampled = 4;       ///< one in this many lasers is sampled, in one column of a group
  static constexpr std::size_t kReturnWeight = 4;  ///< of a return, where a cell weighs 1

  std::size_t columns_ = 0, lasers_ = 0;
  std::vector<std::uint32_t> weights_;
};

}  // namespace lisco
