// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lisco {

/// An order of lasers, and the rank of each there: at first its number. Lasers are unsorted if many of them have a
/// lower one before or a higher one behind.
class LaserRanks {
 public:
  void clear();
  /// Adds lasers behind the last ones, up to a number. Their slopes are unknown.
  void addUpTo(std::size_t count);
  std::size_t rankOf(std::size_t laser) const { return rank_of_[laser]; }
  std::size_t laserAt(std::size_t rank) const { return laser_at_[rank]; }

  /// Sets the slope at which a laser measures, about.
  void setSlope(std::size_t laser, float slope);
  /// Number of lasers whose slopes are known.
  std::size_t knownCount() const { return known_count_; }
  /// Whether the lasers of known slopes are unsorted, from top to bottom and from bottom to top.
  bool areUnsorted() const;
  /// The lasers by rank.
  const std::vector<std::uint32_t>& lasers() const { return laser_at_; }
  /// The lasers from top to bottom, then those of unknown slopes; until the next call.
  const std::vector<std::uint32_t>& sorted();

  /// Exchanges the lasers at two ranks.
  void swap(std::size_t a, std::size_t b);

 private:
  bool isKnown(std::size_t laser) const { return slope_[laser] == slope_[laser]; }
  std::size_t countUnsorted(float direction, float margin) const;

  std::vector<std::uint32_t> rank_of_;   ///< by laser
  std::vector<std::uint32_t> laser_at_;  ///< by rank
  std::vector<float> slope_;             ///< by laser; NaN: unknown
  std::vector<std::uint32_t> sorted_;    ///< see sorted (); kept for its memory
  std::size_t known_count_ = 0;
};

}  // namespace lisco
