// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The engine during a rotation: subclusters at any time, and columns in any portions.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

lisco::Parameters withTolerance(const Setting& setting, float tolerance) {
  lisco::Parameters parameters = setting.parameters;
  parameters.tolerance = tolerance;
  return parameters;
}

/// The oracle's clusters of the first columns; later columns count as no returns.
Clustering trueClustersUpTo(const Scan& scan, std::size_t columns, float tolerance) {
  std::vector<Point> points = scan.points();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i % scan.columns >= columns) points[i] = {0, 0, 0};
  return trueClusters(points, tolerance);
}

/// Calls check(random, scan, tolerance, setting) for many scans, with each setting in turn.
template <typename Check>
void forScans(std::uint64_t first, std::uint64_t count, Check&& check) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const Setting& setting = allSettings()[seed % allSettings().size()];
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + setting.name);
    Random random(seed);
    const Scan scan = randomScan(random);
    check(random, scan, criticalTolerance(random, scan), setting);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Stream, SubclustersAreExactAfterEveryColumn) {
  lisco::ColumnClusterer clusterer;
  forScans(1, 300, [&](Random&, const Scan& scan, float tolerance, const Setting& setting) {
    clusterer.begin(withTolerance(setting, tolerance));
    for (std::size_t column = 0; column < scan.columns; ++column) {
      clusterer.addColumn(scan.column(column).data(), scan.lasers);
      ASSERT_EQ(difference(trueClustersUpTo(scan, column + 1, tolerance), clustersOf(clusterer)), "")
          << "column " << column;
    }
  });
}

TEST(Stream, SubclustersAreExactNowAndThen) {
  lisco::ColumnClusterer clusterer;
  forScans(1000, 600, [&](Random& random, const Scan& scan, float tolerance, const Setting& setting) {
    clusterer.begin(withTolerance(setting, tolerance));
    for (std::size_t column = 0; column < scan.columns; ++column) {
      clusterer.addColumn(scan.column(column).data(), scan.lasers);
      if (!random.chance(0.1)) continue;
      ASSERT_EQ(difference(trueClustersUpTo(scan, column + 1, tolerance), clustersOf(clusterer)), "")
          << "column " << column;
    }
    EXPECT_EQ(difference(trueClusters(scan.points(), tolerance), clustersOf(clusterer)), "");
  });
}

TEST(Stream, TakesColumnsInAnyPortions) {
  lisco::ColumnClusterer clusterer;
  forScans(2000, 800, [&](Random& random, const Scan& scan, float tolerance, const Setting& setting) {
    clusterer.begin(withTolerance(setting, tolerance));
    for (std::size_t first = 0; first < scan.columns;) {
      const std::size_t count = std::min(scan.columns - first, 1 + random.below(40));
      if (count == 1 && random.chance(0.5))
        clusterer.addColumn(scan.column(first).data(), scan.lasers);
      else
        clusterer.addColumns(count, scan.lasers,
                             [&](std::size_t laser, std::size_t column) { return scan.at(laser, first + column); });
      first += count;
      if (random.chance(0.1)) clusterer.addColumn(nullptr, 0);  // a step without measurements
    }
    EXPECT_EQ(difference(trueClusters(scan.points(), tolerance), clustersOf(clusterer)), "");
  });
}

// Columns may have different numbers of lasers, with their returns in any order.
TEST(Stream, TakesColumnsOfAnyLengthAndOrder) {
  lisco::ColumnClusterer clusterer;
  forScans(4000, 400, [&](Random& random, const Scan& scan, float tolerance, const Setting& setting) {
    clusterer.begin(withTolerance(setting, tolerance));
    for (std::size_t column = 0; column < scan.columns; ++column) {
      std::vector<lisco::Return> cells = scan.column(column);
      random.shuffle(cells);
      while (!cells.empty() && !lisco::isReturn(cells.back().x, cells.back().y, cells.back().z)) cells.pop_back();
      clusterer.addColumn(cells.data(), cells.size());
    }
    EXPECT_EQ(difference(trueClusters(scan.points(), tolerance), clustersOf(clusterer)), "");
  });
}

TEST(Stream, UpdateTwiceOrWithoutColumnsChangesNothing) {
  lisco::ColumnClusterer clusterer;
  clusterer.update();
  EXPECT_TRUE(clustersOf(clusterer).empty());
  Random random(9);
  const Scan scan = randomScan(random);
  const Clustering once = cluster(clusterer, scan, 0.5F, allSettings().front());
  clusterer.update();
  EXPECT_EQ(difference(once, clustersOf(clusterer)), "");
}

TEST(Stream, BeginForgetsAnAbortedRotation) {
  lisco::ColumnClusterer clusterer;
  forScans(5000, 200, [&](Random& random, const Scan& scan, float tolerance, const Setting& setting) {
    const Scan lost = randomScan(random);
    clusterer.begin(withTolerance(random.oneOf(allSettings()), tolerance));
    for (std::size_t column = 0; column < random.below(lost.columns + 1); ++column)
      clusterer.addColumn(lost.column(column % lost.columns).data(), lost.lasers);
    EXPECT_EQ(difference(trueClusters(scan.points(), tolerance), cluster(clusterer, scan, tolerance, setting)), "");
  });
}

TEST(Stream, CountsItsReturns) {
  Random random(11);
  lisco::ColumnClusterer clusterer;
  for (int i = 0; i < 50; ++i) {
    const Scan scan = randomScan(random);
    const std::vector<Point> points = scan.points();
    const auto valid = static_cast<std::size_t>(std::count_if(points.begin(), points.end(), isValid));
    cluster(clusterer, scan, 0.1F, random.oneOf(allSettings()));
    EXPECT_EQ(clusterer.returnCount(), valid);
  }
}

// In any portions of columns: the engine keeps them in blocks.
TEST(Stream, GivesTheSubclusterOfACell) {
  lisco::ColumnClusterer clusterer;
  EXPECT_EQ(clusterer.subclusterAt(0, 0), lisco::ColumnClusterer::kNone);
  forScans(7000, 400, [&](Random& random, const Scan& scan, float tolerance, const Setting& setting) {
    clusterer.begin(withTolerance(setting, tolerance));
    EXPECT_EQ(clusterer.subclusterAt(0, 0), lisco::ColumnClusterer::kNone);
    feed(clusterer, random, scan);
    clusterer.update();
    std::vector<std::uint32_t> subclusters(scan.cells.size(), lisco::ColumnClusterer::kNone);
    clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
      for (std::size_t i = 0; i < count; ++i) subclusters[source_indices[i]] = subcluster;
    });
    clusterer.forEachRun([&](std::uint32_t laser, std::uint32_t column, std::size_t count, std::uint32_t subcluster) {
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(subclusters[laser * scan.columns + column + i], subcluster)
            << "laser " << laser << " from " << column;
    });
    for (std::size_t laser = 0; laser < scan.lasers + 2; ++laser)
      for (std::size_t column = 0; column < scan.columns + 70; ++column)
        ASSERT_EQ(clusterer.subclusterAt(laser, column), laser < scan.lasers && column < scan.columns
                                                             ? subclusters[laser * scan.columns + column]
                                                             : lisco::ColumnClusterer::kNone)
            << "laser " << laser << ", column " << column;
  });
}

TEST(Stream, VisitsPlacesWithoutSourceIndices) {
  lisco::ColumnClusterer clusterer;
  lisco::ColumnClusterer keeping;
  forScans(7400, 200, [&](Random& random, const Scan& scan, float tolerance, const Setting& setting) {
    lisco::Parameters parameters = withTolerance(setting, tolerance);
    const Random state = random;
    keeping.begin(parameters);
    feed(keeping, random, scan);
    keeping.update();
    parameters.keep_source_indices = false;
    random = state;
    clusterer.begin(parameters);
    feed(clusterer, random, scan);
    clusterer.update();
    ASSERT_EQ(placesOf(clusterer), placesOf(keeping));
    ASSERT_EQ(clusterer.subclusterAt(0, 0), keeping.subclusterAt(0, 0));
    EXPECT_THROW(clusterer.forEachRun([](const std::uint32_t*, std::size_t, std::uint32_t) {}), std::logic_error);
  });
}

TEST(Stream, RejectsWrongCalls) {
  lisco::ColumnClusterer clusterer;
  const lisco::Return cells[2] = {{1, 0, 0, 0}, {1, 0, 1, 1}};
  EXPECT_THROW(clusterer.addColumn(cells, 2), std::logic_error);
  lisco::Parameters parameters;
  parameters.tolerance = 2;
  parameters.lasers = 1;
  clusterer.begin(parameters);
  EXPECT_THROW(clusterer.addColumn(cells, 2), std::invalid_argument);
  clusterer.addColumn(cells, 1);
  const auto none = [](std::size_t, std::size_t) { return lisco::kNoReturn; };
  for (const std::size_t columns : {lisco::ColumnClusterer::kMaxCells, ~std::size_t{0}})
    EXPECT_THROW(clusterer.addColumns(columns, 1, none), std::invalid_argument);
  clusterer.addColumns(2, 1, none);
  clusterer.update();
  EXPECT_EQ(clusterer.returnCount(), 1U);
}

}  // namespace
}  // namespace lisco_test
