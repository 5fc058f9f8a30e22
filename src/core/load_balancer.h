// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/work_shares.h"
#include "lisco/return.h"

namespace lisco {

/// Divides the columns of a rotation among threads: consecutive columns of about equal time. Their work is measured in
/// the rotation before if that had as many columns and lasers, else estimated from the number of returns; WorkShares
/// says how much of it each thread gets.
class LoadBalancer {
 public:
  /// Columns [first, end).
  struct Part {
    std::size_t first, end;
  };

  /// Divides a rotation into as many parts as are worth a thread each: 1 to max_parts.
  /// \param parts receives them, in order
  void divide(std::size_t columns, std::size_t lasers, const CellSource& cells, std::size_t max_parts,
              std::vector<Part>& parts) {
    if (lasers != lasers_ || columns != columns_) weigh(columns, lasers, cells);
    parts.resize(std::clamp<std::size_t>(weights_.size() / kMinGroups, 1, max_parts));
    shares_.begin(parts.size());
    const auto all = static_cast<double>(std::accumulate(weights_.begin(), weights_.end(), std::uint64_t{0}));
    double share = 0;
    double sum = 0;
    std::size_t group = 0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const std::size_t first = group;
      share += shares_.of(part);
      const bool is_last = part + 1 == parts.size();
      while (group < weights_.size() && (is_last || sum < share * all)) sum += static_cast<double>(weights_[group++]);
      parts[part] = {std::min(first * kGroup, columns), std::min(group * kGroup, columns)};
    }
  }

  /// See WorkShares.
  template <typename Read>
  void time(std::size_t part, Read&& read) {
    shares_.time(part, read);
  }

  /// Records the work of some columns of the rotation divided last, in any unit. Threads may call it at the same time,
  /// each for its own part.
  void record(std::size_t first, std::size_t columns, std::size_t work) {
    if (columns == 0) return;
    const std::size_t begin = first / kGroup;
    const std::size_t end = (first + columns + kGroup - 1) / kGroup;
    // At least 1, so that every column belongs to a part; at most 2^30, which 32 bits hold.
    const std::size_t weight = std::clamp<std::size_t>(work / (end - begin), 1, std::size_t{1} << 30U);
    std::fill(weights_.begin() + static_cast<std::ptrdiff_t>(begin),
              weights_.begin() + static_cast<std::ptrdiff_t>(end), static_cast<std::uint32_t>(weight));
  }

 private:
  /// Estimates the work of columns from their returns.
  void weigh(std::size_t columns, std::size_t lasers, const CellSource& cells) {
    lasers_ = lasers;
    columns_ = columns;
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

  // Finer weights even out the work of threads, and take longer to sample (benchmarks/suite.sh threads).
  static constexpr std::size_t kGroup = 16;        ///< columns weighed together
  static constexpr std::size_t kMinGroups = 4;     ///< of a part: 64 columns
  static constexpr std::size_t kSampled = 4;       ///< one in this many lasers is sampled, in one column of a group
  static constexpr std::size_t kReturnWeight = 4;  ///< of a return, where a cell weighs 1

  std::size_t columns_ = 0, lasers_ = 0;
  std::vector<std::uint32_t> weights_;
  WorkShares shares_;
};

}  // namespace lisco
