// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The order of lasers by their slopes.
#include "core/far/laser_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "random.h"

namespace lisco_test {
namespace {

lisco::LaserRanks ranksOf(const std::vector<float>& slopes) {
  lisco::LaserRanks ranks;
  ranks.addUpTo(slopes.size());
  for (std::size_t laser = 0; laser < slopes.size(); ++laser) ranks.setSlope(laser, slopes[laser]);
  return ranks;
}

/// Of lasers from bottom to top.
std::vector<float> rising(std::size_t lasers) {
  std::vector<float> slopes;
  for (std::size_t laser = 0; laser < lasers; ++laser) slopes.push_back(0.02F * static_cast<float>(laser) - 0.3F);
  return slopes;
}

TEST(LaserRanks, LasersAreSortedFromTopToBottomAndFromBottomToTop) {
  std::vector<float> slopes = rising(16);
  EXPECT_FALSE(ranksOf(slopes).areUnsorted());
  std::reverse(slopes.begin(), slopes.end());
  EXPECT_FALSE(ranksOf(slopes).areUnsorted());
  std::swap(slopes[5], slopes[6]);
  EXPECT_FALSE(ranksOf(slopes).areUnsorted());
}

TEST(LaserRanks, FewLasersAreNeverUnsorted) {
  EXPECT_FALSE(ranksOf({}).areUnsorted());
  EXPECT_FALSE(ranksOf({1.0F}).areUnsorted());
  lisco::LaserRanks unknown;
  unknown.addUpTo(64);
  EXPECT_FALSE(unknown.areUnsorted());
}

// Which of two lasers is above the other is noise.
TEST(LaserRanks, NoiseBelowHalfAStepLeavesLasersSorted) {
  Random random(1);
  std::vector<float> slopes = rising(64);
  for (std::size_t i = 0; i < slopes.size(); i += 2)  // as of two returns per ray
    slopes[i] = slopes[i + 1] + static_cast<float>(random.between(-0.004, 0.004));
  EXPECT_FALSE(ranksOf(slopes).areUnsorted());
}

TEST(LaserRanks, OneLaserAmongDistantOnesMakesMasksOfManyWide) {
  std::vector<float> slopes = rising(32);
  std::rotate(slopes.begin(), slopes.begin() + 1, slopes.end());  // the lowest one behind the highest one
  EXPECT_TRUE(ranksOf(slopes).areUnsorted());
  slopes = rising(32);
  std::rotate(slopes.rbegin(), slopes.rbegin() + 1, slopes.rend());  // and the other way round
  EXPECT_TRUE(ranksOf(slopes).areUnsorted());
}

// First returns in some rows, second ones in as many more.
TEST(LaserRanks, BlocksOfRowsAreUnsorted) {
  std::vector<float> slopes = rising(32);
  const std::vector<float> second = slopes;
  slopes.insert(slopes.end(), second.begin(), second.end());
  EXPECT_TRUE(ranksOf(slopes).areUnsorted());
}

TEST(LaserRanks, SortsByKnownSlopes) {
  Random random(2);
  std::vector<float> slopes = rising(40);
  random.shuffle(slopes);
  lisco::LaserRanks ranks;
  ranks.addUpTo(slopes.size());
  const auto isKnown = [](std::size_t laser) { return laser % 5 != 0; };
  for (std::size_t laser = 0; laser < slopes.size(); ++laser)
    if (isKnown(laser)) ranks.setSlope(laser, slopes[laser]);
  EXPECT_EQ(ranks.knownCount(), 32U);
  EXPECT_TRUE(ranks.areUnsorted());
  const std::vector<std::uint32_t> sorted = ranks.sorted();
  ASSERT_EQ(sorted.size(), slopes.size());
  for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
    EXPECT_EQ(isKnown(sorted[rank]), rank < 32) << rank;
    if (rank > 0 && rank < 32) {
      EXPECT_LT(slopes[sorted[rank]], slopes[sorted[rank - 1]]) << rank;
    }
    ranks.swap(rank, ranks.rankOf(sorted[rank]));
  }
  EXPECT_EQ(ranks.lasers(), sorted);
  for (std::size_t rank = 0; rank < sorted.size(); ++rank) EXPECT_EQ(ranks.rankOf(ranks.laserAt(rank)), rank);
  EXPECT_FALSE(ranks.areUnsorted());
}

}  // namespace
}  // namespace lisco_test
