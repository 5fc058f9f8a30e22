// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/far/laser_ranks.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/far/constants.h"

namespace lisco {

void LaserRanks::clear() {
  rank_of_.clear();
  laser_at_.clear();
  slope_.clear();
  known_count_ = 0;
}

void LaserRanks::addUpTo(std::size_t count) {
  sorted_.reserve(count);
  for (std::size_t laser = rank_of_.size(); laser < count; ++laser) {
    rank_of_.push_back(static_cast<std::uint32_t>(laser));
    laser_at_.push_back(static_cast<std::uint32_t>(laser));
    slope_.push_back(std::numeric_limits<float>::quiet_NaN());
  }
}

void LaserRanks::setSlope(std::size_t laser, float slope) {
  if (!isKnown(laser)) ++known_count_;
  slope_[laser] = slope;
}

bool LaserRanks::areUnsorted() const {
  if (known_count_ < 2) return false;
  float least = std::numeric_limits<float>::infinity();
  float most = -least;
  for (const float slope : slope_) {
    if (slope < least) least = slope;
    if (slope > most) most = slope;
  }
  // Of lasers that are nearer to each other, either may be above the other.
  const float margin = 0.5F * (most - least) / static_cast<float>(known_count_ - 1);
  const std::size_t unsorted = std::min(countUnsorted(1.0F, margin), countUnsorted(-1.0F, margin));
  return unsorted * kFewUnsorted > known_count_;
}

/// The number of lasers with a clearly lower one before, and of those with a clearly higher one behind.
/// \param direction 1 for lasers from top to bottom, -1 from bottom to top
std::size_t LaserRanks::countUnsorted(float direction, float margin) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::size_t count = laser_at_.size();
  std::size_t unsorted = 0;
  float lowest_before = kInfinity;
  for (std::size_t rank = 0; rank < count; ++rank) {
    const float slope = direction * slope_[laser_at_[rank]];
    if (slope > lowest_before + margin) ++unsorted;
    if (slope < lowest_before) lowest_before = slope;
  }
  float highest_behind = -kInfinity;
  for (std::size_t rank = count; rank-- > 0;) {
    const float slope = direction * slope_[laser_at_[rank]];
    if (slope < highest_behind - margin) ++unsorted;
    if (slope > highest_behind) highest_behind = slope;
  }
  return unsorted;
}

const std::vector<std::uint32_t>& LaserRanks::sorted() {
  sorted_ = laser_at_;
  const auto unknown =
      std::partition(sorted_.begin(), sorted_.end(), [this](std::uint32_t laser) { return isKnown(laser); });
  std::sort(sorted_.begin(), unknown, [this](std::uint32_t a, std::uint32_t b) {
    return slope_[a] != slope_[b] ? slope_[a] > slope_[b] : a < b;
  });
  return sorted_;
}

void LaserRanks::swap(std::size_t a, std::size_t b) {
  std::swap(laser_at_[a], laser_at_[b]);
  rank_of_[laser_at_[a]] = static_cast<std::uint32_t>(a);
  rank_of_[laser_at_[b]] = static_cast<std::uint32_t>(b);
}

}  // namespace lisco
