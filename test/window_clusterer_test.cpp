// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/window_clusterer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "engine.h"
#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

Clustering trueClustersOfColumns(const Scan& scan, std::size_t first, std::size_t end, float tolerance) {
  std::vector<Point> points = scan.points();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i % scan.columns < first || i % scan.columns >= end) points[i] = {0, 0, 0};
  return trueClusters(points, tolerance);
}

void expectEachWindowExact(lisco::WindowClusterer& clusterer, Random& random, const Scan& scan, float tolerance) {
  const std::size_t hop = 1 + random.below(random.chance(0.1) ? 80 : 8);
  const std::size_t window = hop * (1 + random.below(8));
  clusterer.begin({tolerance, window, hop, scan.lasers});
  for (std::size_t column = 0; column < scan.columns; ++column) {
    const bool ends = clusterer.addColumn(scan.column(column).data(), scan.lasers);
    ASSERT_EQ(ends, (column + 1) % hop == 0);
    if (!ends) continue;
    const std::size_t first = column + 1 - std::min(window, column + 1);
    EXPECT_EQ(clusterer.columnCount(), column + 1 - first);
    ASSERT_EQ(difference(trueClustersOfColumns(scan, first, column + 1, tolerance), clustersOf(clusterer)), "")
        << "window of " << window << ", hop of " << hop << ", column " << column;
  }
}

TEST(WindowClusterer, EachWindowIsExact) {
  lisco::WindowClusterer clusterer;
  for (std::uint64_t seed = 1; seed <= timesEffort(1500); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = random.chance(0.2) ? randomScan(random, 1500) : randomScan(random);
    expectEachWindowExact(clusterer, random, scan, criticalTolerance(random, scan));
    if (HasFailure()) return;
  }
}

TEST(WindowClusterer, WindowsOfLatticesAndExtremesAreExact) {
  lisco::WindowClusterer clusterer;
  for (std::uint64_t seed = 1; seed <= timesEffort(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    float spacing = 0;
    const Scan lattice = latticeScan(random, spacing);
    expectEachWindowExact(clusterer, random, lattice, spacing * (random.chance(0.5) ? 1.0F : 1.0000001F));
    const Scan extreme = extremeScan(random);
    expectEachWindowExact(clusterer, random, extreme, criticalTolerance(random, extreme));
    if (HasFailure()) return;
  }
}

TEST(WindowClusterer, VisitsPlacesWithoutSourceIndices) {
  lisco::WindowClusterer keeping, clusterer;
  for (std::uint64_t seed = 5000; seed < 5000 + timesEffort(100); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = random.chance(0.2) ? randomScan(random, 1500) : randomScan(random);
    const std::size_t hop = 1 + random.below(80);
    lisco::WindowParameters parameters{criticalTolerance(random, scan), hop * (1 + random.below(4)), hop};
    keeping.begin(parameters);
    parameters.keep_source_indices = false;
    clusterer.begin(parameters);
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const bool ends = keeping.addColumn(scan.column(column).data(), scan.lasers);
      ASSERT_EQ(clusterer.addColumn(scan.column(column).data(), scan.lasers), ends);
      if (!ends) continue;
      ASSERT_EQ(placesOf(clusterer), placesOf(keeping));
    }
    EXPECT_THROW(clusterer.forEachRun([](const std::uint32_t*, std::size_t, std::uint32_t) {}), std::logic_error);
  }
}

TEST(WindowClusterer, RejectsWrongCalls) {
  lisco::WindowClusterer clusterer;
  const lisco::Return cells[3] = {{1, 0, 0, 0}, {1, 0, 1, 1}, {1, 0, 2, 2}};
  EXPECT_THROW(clusterer.addColumn(cells, 1), std::logic_error);
  EXPECT_THROW(clusterer.begin({0.4F, 10, 0}), std::invalid_argument);
  EXPECT_THROW(clusterer.begin({0.4F, 0, 1}), std::invalid_argument);
  EXPECT_THROW(clusterer.begin({0.4F, 10, 3}), std::invalid_argument);
  clusterer.begin({0.4F, 2, 1, 2});
  EXPECT_THROW(clusterer.addColumn(cells, 3), std::invalid_argument);
  EXPECT_TRUE(clusterer.addColumn(cells, 2));
  EXPECT_EQ(clusterer.subclusterCount(), 2U);
  constexpr std::size_t kMany = std::size_t{1} << 30;
  clusterer.begin({0.4F, kMany, kMany});
  EXPECT_THROW(clusterer.addColumn(cells, 2), std::invalid_argument);
  EXPECT_FALSE(clusterer.addColumn(cells, 1));
}

}  // namespace
}  // namespace lisco_test
