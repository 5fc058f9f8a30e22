// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The engine against the oracle, on thousands of small scans with all faults of real sensors.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "engine.h"
#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Calls check(random, clusterer) for many seeds, with one clusterer for all: each scan starts afresh. Ends at the
/// first seed that fails.
template <typename Check>
void forSeeds(std::uint64_t first, std::uint64_t count, Check&& check) {
  lisco::ColumnClusterer clusterer;
  for (std::uint64_t seed = first; seed < first + timesEffort(count); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    check(random, clusterer);
    if (testing::Test::HasFailure()) return;
  }
}

/// In four parts that run side by side.
class RandomScans : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomScans, EqualTheOracle) {
  forSeeds(GetParam() * 10'000'000, 3000, [](Random& random, lisco::ColumnClusterer& clusterer) {
    const Scan scan = sometimesWide(random, randomScan(random));
    expectExact(clusterer, scan, criticalTolerance(random, scan));
  });
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomScans, testing::Range<std::uint64_t>(1, 5));

// Large enough for many sectors, and masks of several lasers.
TEST(LargerScans, EqualTheOracle) {
  forSeeds(80'000'000, 60, [](Random& random, lisco::ColumnClusterer& clusterer) {
    const Scan scan = sometimesWide(random, randomScan(random, 3000));
    expectExact(clusterer, scan, criticalTolerance(random, scan));
    expectExact(clusterer, scan, 10.0F * criticalTolerance(random, scan));
  });
}

TEST(AdversarialScans, SeparateALatticeAtExactlyTheTolerance) {
  forSeeds(100'000'000, 1000, [](Random& random, lisco::ColumnClusterer& clusterer) {
    float spacing = 0.0F;
    const Scan scan = sometimesWide(random, latticeScan(random, spacing));
    // At the spacing only equal points are neighbours; one ulp above, the whole lattice is connected.
    expectExact(clusterer, scan, spacing);
    expectExact(clusterer, scan, std::nextafter(spacing, kInfinity));
    expectExact(clusterer, scan, std::nextafter(std::sqrt(2.0F) * spacing, random.chance(0.5) ? 0.0F : kInfinity));
  });
}

TEST(AdversarialScans, EqualTheOracleWhereFloatsEnd) {
  forSeeds(200'000'000, 1000, [](Random& random, lisco::ColumnClusterer& clusterer) {
    const Scan scan = sometimesWide(random, extremeScan(random));
    expectExact(clusterer, scan, criticalTolerance(random, scan));
    const std::array<float, 8> tolerances{1e-44F, 1e-22F, 1e-20F, 1e-3F, 1e10F, 1.8e19F, 1e30F, kInfinity};
    expectExact(clusterer, scan, random.oneOf(tolerances));
  });
}

TEST(AdversarialScans, EqualTheOracleAtAnyTolerance) {
  forSeeds(300'000'000, 60, [](Random& random, lisco::ColumnClusterer& clusterer) {
    const Scan scan = sometimesWide(random, randomScan(random));
    for (const float tolerance : {0.0F, -0.0F, -0.5F, kNan, kInfinity, -kInfinity, 1e-30F, 1e30F, 1e-20F, 3e38F})
      expectExact(clusterer, scan, tolerance);
  });
}

TEST(AdversarialScans, MayHaveManyReturnsNearerThanTheTolerance) {
  forSeeds(400'000'000, 200, [](Random& random, lisco::ColumnClusterer& clusterer) {
    Scan scan(random.chance(0.25) ? 256 : 1 + random.below(40), 1 + random.below(6));
    const double tolerance = random.between(0.1, 1.0);
    for (lisco::Return& cell : scan.cells) {
      // Most lie around the sensor; the others at a few tolerances, where the mask must still cover them.
      const double reach = random.chance(0.7) ? 1.2 * tolerance : 4.0 * tolerance;
      cell.x = static_cast<float>(random.between(-reach, reach));
      cell.y = static_cast<float>(random.between(-reach, reach));
      cell.z = static_cast<float>(random.between(-reach, reach));
    }
    expectExact(clusterer, scan, static_cast<float>(tolerance * random.magnitude(0.05, 1.0)));
  });
}

// Two rings of points above the sensor, around the vertical: any azimuth lies within the mask.
TEST(AdversarialScans, MaySurroundTheZenith) {
  forSeeds(500'000'000, 200, [](Random& random, lisco::ColumnClusterer& clusterer) {
    Scan scan(random.chance(0.25) ? 256 : 1 + random.below(40), 2);
    const double height = random.magnitude(0.1, 50.0) * (random.chance(0.5) ? 1.0 : -1.0);
    const double radius = random.magnitude(1e-6, 1.0);
    for (std::size_t i = 0; i < scan.cells.size(); ++i) {
      const double azimuth = random.between(0.0, 6.3);
      const double rho = random.chance(0.1) ? 0.0 : radius * random.between(0.5, 1.5);
      scan.cells[i].x = static_cast<float>(rho * std::cos(azimuth));
      scan.cells[i].y = static_cast<float>(rho * std::sin(azimuth));
      scan.cells[i].z = static_cast<float>(height);
    }
    expectExact(clusterer, scan, criticalTolerance(random, scan));
  });
}

// The same return many times: cliques of equal boxes, and distances of zero.
TEST(AdversarialScans, MayRepeatReturns) {
  forSeeds(600'000'000, 200, [](Random& random, lisco::ColumnClusterer& clusterer) {
    Scan scan = sometimesWide(random, randomScan(random));
    for (lisco::Return& cell : scan.cells)
      if (random.chance(0.7)) {
        const lisco::Return& other = random.oneOf(scan.cells);
        cell = {other.x, other.y, other.z, cell.source_index};
      }
    expectExact(clusterer, scan, criticalTolerance(random, scan));
    expectExact(clusterer, scan, 1e-22F);
  });
}

// Two long sheets just over the tolerance apart: all comparisons of their segments fail but for one pair.
TEST(AdversarialScans, JoinTwoSheetsByOneBridge) {
  forSeeds(700'000'000, 150, [](Random& random, lisco::ColumnClusterer& clusterer) {
    Scan scan(40, 4);
    const double spacing = 0.1;
    for (std::size_t laser = 0; laser < 4; ++laser)
      for (std::size_t column = 0; column < 40; ++column)
        scan.set(laser, column,
                 {static_cast<float>(laser < 2 ? 5.0 : 5.0 + 1.0001 * spacing),
                  static_cast<float>((static_cast<double>(column) - 20.0) * 0.9 * spacing),
                  static_cast<float>(static_cast<double>(laser % 2) * 0.9 * spacing)});
    if (random.chance(0.5)) {
      lisco::Return& bridge = scan.at(2 + random.below(2), random.below(40));
      bridge.x = static_cast<float>(5.0 + 0.9999 * spacing);
    }
    expectExact(clusterer, sometimesWide(random, scan), static_cast<float>(spacing));
  });
}

TEST(AdversarialScans, MayHaveNoColumnsOrNoReturns) {
  lisco::ColumnClusterer clusterer;
  expectExact(clusterer, Scan(0, 0), 0.5F);
  expectExact(clusterer, Scan(5, 0), 0.5F);
  expectExact(clusterer, Scan(0, 5), 0.5F);
  expectExact(clusterer, Scan(5, 5), 0.5F);
  EXPECT_EQ(clusterer.returnCount(), 0U);
}

}  // namespace
}  // namespace lisco_test
