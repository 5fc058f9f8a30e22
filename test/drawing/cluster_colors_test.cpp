// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/cluster_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace lisco_apps {
namespace {

constexpr std::size_t kPrimary = 7;
constexpr std::size_t kColors = 12;

/// A picture of round spots of points, one cluster each.
PointMap spots(unsigned seed, std::size_t clusters, std::vector<std::uint32_t>& labels) {
  std::mt19937 random(seed);
  PointMap map{300, 200, 2, 3, std::vector<std::int64_t>(300 * 200, PointMap::kNoPoint)};
  labels.clear();
  for (std::uint32_t cluster = 0; cluster < clusters; ++cluster) {
    const int column = static_cast<int>(random() % 300);
    const int row = static_cast<int>(random() % 200);
    const int radius = 1 + static_cast<int>(random() % 6);
    for (int y = std::max(0, row - radius); y < std::min(200, row + radius); ++y)
      for (int x = std::max(0, column - radius); x < std::min(300, column + radius); ++x) {
        map.points[map.cellAt(y, x)] = static_cast<std::int64_t>(labels.size());
        labels.push_back(cluster + 1);
      }
  }
  return map;
}

TEST(ClusterColors, DifferBetweenNeighbours) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<std::uint32_t> labels;
    const PointMap map = spots(seed, 150, labels);
    const std::vector<std::size_t> colors = colorNeighbours(150, {{map, labels}}, kPrimary, kColors);
    ASSERT_EQ(colors.size(), 150U);
    const auto clusterAt = [&](int row, int column) {
      const std::int64_t point = map.points[map.cellAt(row, column)];
      return point == PointMap::kNoPoint ? 0 : labels[static_cast<std::size_t>(point)];
    };
    const int reach_x = static_cast<int>(kNearPixels / map.cell_width);
    const int reach_y = static_cast<int>(kNearPixels / map.cell_height);
    int pairs = 0;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column) {
        const std::uint32_t cluster = clusterAt(row, column);
        if (cluster == 0) continue;
        for (int y = row; y < std::min(map.rows, row + reach_y); ++y)
          for (int x = std::max(0, column - reach_x + 1); x < std::min(map.columns, column + reach_x); ++x) {
            const std::uint32_t other = clusterAt(y, x);
            if (other == 0 || other == cluster) continue;
            ++pairs;
            ASSERT_NE(colors[cluster - 1], colors[other - 1]) << "seed " << seed << ", " << cluster << ", " << other;
          }
      }
    EXPECT_GT(pairs, 100);
  }
}

TEST(ClusterColors, OfFewNeighboursArePrimary) {
  std::vector<std::uint32_t> labels;
  const PointMap map = spots(3, 40, labels);
  for (const std::size_t color : colorNeighbours(40, {{map, labels}}, kPrimary, kColors)) EXPECT_LT(color, kPrimary);
}

TEST(ClusterColors, TakeMoreNeighboursThanColors) {
  PointMap map{40, 1, 1, 1, {}};
  std::vector<std::uint32_t> labels;
  for (int column = 0; column < 40; ++column) {
    map.points.push_back(column);
    labels.push_back(static_cast<std::uint32_t>(column + 1));
  }
  const std::vector<std::size_t> colors = colorNeighbours(40, {{map, labels}}, kPrimary, kColors);
  for (const std::size_t color : colors) EXPECT_LT(color, kColors);
  for (std::size_t color = 0; color < kColors; ++color)
    EXPECT_GE(std::count(colors.begin(), colors.end(), color), 1) << color;
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (std::size_t k = i + 1; k <= std::min<std::size_t>(colors.size() - 1, i + 4); ++k)
      EXPECT_NE(colors[i], colors[k]) << i << " and " << k << " touch";
}

TEST(ClusterColors, OfNothingAreNone) {
  const PointMap map{1, 1, 1, 1, {PointMap::kNoPoint}};
  EXPECT_TRUE(colorNeighbours(0, {{map, {}}}, kPrimary, kColors).empty());
}

}  // namespace
}  // namespace lisco_apps
