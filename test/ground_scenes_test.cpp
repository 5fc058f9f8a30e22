// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The ground filter on simple scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "ground_scans.h"
#include "lisco/simd.h"

namespace lisco_test::ground_scans {
namespace {

constexpr std::size_t kLasers = 48, kColumns = 901;
constexpr double kHeight = 1.8;  // of the sensor, metres

/// Distance to where a ray meets a surface z = height (x, y), within 60 m; -1: nowhere.
template <typename Height>
double meetsSurface(double azimuth, double slope, Height&& height) {
  const double east = std::cos(azimuth), north = std::sin(azimuth);
  double before = 0.3;
  while (before < 60.0) {
    double beyond = before * 1.005 + 0.01;
    if (slope * beyond <= height(beyond * east, beyond * north)) {
      for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (before + beyond);
        (slope * middle <= height(middle * east, middle * north) ? beyond : before) = middle;
      }
      return beyond;
    }
    before = beyond;
  }
  return -1.0;
}

template <typename Height>
Scan scanOfSurface(Height&& height) {
  return scanOf(kLasers, kColumns, [&](double azimuth, double slope) { return meetsSurface(azimuth, slope, height); });
}

Scan plane() {
  return scanOf(kLasers, kColumns, [](double azimuth, double slope) { return meetsPlane(azimuth, slope, kHeight); });
}

double distanceOf(const lisco::Return& cell) {
  return std::hypot(static_cast<double>(cell.x), static_cast<double>(cell.y));
}

TEST(GroundScenes, FindsARoadAndThePavementsBehindItsKerbs) {
  const Scan scan = scanOfSurface([](double, double y) { return std::fabs(y) < 4.0 ? -kHeight : 0.14 - kHeight; });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  const auto isRoad = [](const lisco::Return& cell) { return std::fabs(cell.y) < 3.9F; };
  const auto isPavement = [](const lisco::Return& cell) { return std::fabs(cell.y) > 4.1F; };
  EXPECT_GT(share(scan, ground, isRoad), 0.99);
  EXPECT_GT(share(scan, ground, isPavement), 0.97);
}

TEST(GroundScenes, FindsMostOfTheGutterBelowAKerb) {
  // The road falls by 0.1 m to the gutter, from which the kerb rises as much; lasers 0.4 degrees apart.
  const auto road = [](double y) { return -0.1 * std::clamp((std::fabs(y) - 7.0) / 0.8, 0.0, 1.0) - kHeight; };
  const auto surface = [&](double, double y) { return std::fabs(y) < 8.0 ? road(y) : -kHeight; };
  const Scan scan =
      scanOf(88, kColumns, [&](double azimuth, double slope) { return meetsSurface(azimuth, slope, surface); });
  const auto isGutter = [&](const lisco::Return& cell) {
    return std::fabs(cell.y) > 7.8F && static_cast<double>(cell.z) < -kHeight - 0.09 && distanceOf(cell) < 12.0;
  };
  EXPECT_GT(share(scan, filterAll(scan), isGutter), 0.78);
}

TEST(GroundScenes, FindsRampsUpAndDown) {
  for (const double degrees : {-15.0, -7.0, 7.0, 11.0, 15.0}) {
    const double rise = std::tan(degrees * M_PI / 180.0);
    const Scan scan = scanOfSurface([&](double x, double) { return rise * std::clamp(x - 7.0, 0.0, 10.0) - kHeight; });
    const auto cells = [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; };
    const auto parameters = lisco::estimateGround(scan.columns, scan.lasers, {0, 0, 0}, lisco::CellSource(cells));
    EXPECT_GT(share(scan, filterAll(scan, parameters), all), 0.99) << degrees;
  }
}

TEST(GroundScenes, FindsTheFloorOfARoom) {
  // 12 m x 8 m and 3.2 m high, with a table 1 m wide; the sensor is 1 m above the floor.
  const auto isTable = [](double x, double y) { return std::fabs(x - 3.0) < 0.5 && std::fabs(y) < 1.0; };
  const Scan scan = scanOf(kLasers, kColumns, [&](double azimuth, double slope) {
    const auto inside = [&](double x, double y) {
      if (std::fabs(x) > 6.0 || std::fabs(y) > 4.0) return 10.0;
      return isTable(x, y) ? -0.25 : -1.0;
    };
    const double rho = meetsSurface(azimuth, slope, inside);
    return slope > 0.0 ? std::min(rho, 2.2 / slope) : rho;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -0.99F; }), 0.98);
  EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -0.8F; }), 0.005);
}

TEST(GroundScenes, LeavesItsOwnVehicle) {
  // Its roof ends 0.4 m below the sensor, its bonnet 0.9 m.
  const Scan scan = scanOfSurface([](double x, double y) {
    if (std::fabs(y) > 0.9 || x < -2.5 || x > 2.2) return -kHeight;
    return x < 1.0 ? -0.4 : -0.9;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.0F && distanceOf(cell) < 3.0; }),
            0.0);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -1.79F; }), 0.98);
}

TEST(GroundScenes, FindsTheGroundUnderATree) {
  // Its crown, 4 m in radius, hangs 2.5 m above the ground; the trunk is 0.4 m thick.
  const double crown = 2.5 - kHeight;
  const Scan scan = scanOf(kLasers, kColumns, [&](double azimuth, double slope) {
    const double east = std::cos(azimuth), north = std::sin(azimuth);
    const auto isWithin = [&](double rho, double radius) { return std::hypot(rho * east - 9.0, rho * north) < radius; };
    for (double rho = 8.8; rho < 9.3; rho += 0.02)
      if (isWithin(rho, 0.2) && slope * rho > -kHeight) return rho;
    if (slope > 0.0 && isWithin(crown / slope, 4.0)) return crown / slope;
    return meetsPlane(azimuth, slope, kHeight);
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.5F; }), 0.0);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -1.79F; }), 0.98);
}

TEST(GroundScenes, FindsTheGroundAroundWater) {
  // A pond reflects each second ray to a wall 16 m away, which seems to be below the ground; the others are lost.
  const Scan scan = scanOf(kLasers, kColumns, [](double azimuth, double slope) {
    const double rho = meetsPlane(azimuth, slope, kHeight);
    const double x = rho * std::cos(azimuth), y = rho * std::sin(azimuth);
    if (rho < 0.0 || x < 5.0 || x > 9.0 || std::fabs(y) > 5.0) return rho;
    return static_cast<int>(azimuth * 1e4) % 2 == 0 ? 16.0 / std::cos(azimuth) : -1.0;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -2.4F; }), 0.02);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.81F; }), 0.98);
}

TEST(GroundScenes, FindsTheGroundWithARollingAndPitchingSensor) {
  Scan scan = plane();
  for (std::size_t column = 0; column < scan.columns; ++column) {
    const double phase = 2.0 * M_PI * static_cast<double>(column) / static_cast<double>(scan.columns);
    const double along = 0.05 * std::sin(phase), across = 0.05 * std::cos(2.0 * phase);  // 3 degrees
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      lisco::Return& cell = scan.cells[laser * scan.columns + column];
      cell.z += static_cast<float>(along * static_cast<double>(cell.x) + across * static_cast<double>(cell.y));
    }
  }
  EXPECT_GT(share(scan, filterAll(scan), all), 0.97);
}

TEST(GroundScenes, FindsTheGroundOfStaggeredLasers) {
  // Each fourth laser is 2.4, 4.8 and 7.2 degrees ahead of the first one.
  const Scan scan = plane();
  Scan staggered = scan;
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column)
      staggered.cells[laser * scan.columns + column] =
          scan.cells[laser * scan.columns + (column + laser % 4 * 6) % scan.columns];
  EXPECT_GT(share(staggered, filterAll(staggered), all), 0.98);
}

TEST(GroundScenes, FindsTheGroundWithoutSomeRowsColumnsAndReturns) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> one_of(0, 9);
  Scan scan = plane();
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const bool is_lost = laser % 7 == 3 || (column > 300 && column < 400) || one_of(random) < 3;
      if (is_lost) scan.cells[laser * scan.columns + column] = lisco::kNoReturn;
    }
  EXPECT_GT(share(scan, filterAll(scan), all), 0.98);
}

TEST(GroundScenes, AreDecidedAlikeAtEachLevelOfVectorInstructions) {
  std::mt19937 random(6);
  std::normal_distribution<float> noise(0.0F, 0.15F);
  Scan scan = scanOfSurface([](double x, double y) {
    const double wall = std::fabs(x - 12.0) < 0.5 && std::fabs(y) < 6.0 ? 2.0 : 0.0;
    return 0.3 * std::sin(0.4 * x) + 0.2 * std::cos(0.5 * y) + wall - kHeight;
  });
  for (lisco::Return& cell : scan.cells)
    if (distanceOf(cell) > 8.0) cell.z += noise(random);
  const std::vector<std::uint8_t> ground = filterAll(scan);
  for (const std::string& level : lisco::simdLevels()) {
    ASSERT_TRUE(lisco::useSimdLevel(level));
    EXPECT_EQ(filterAll(scan), ground) << level;
  }
  EXPECT_TRUE(lisco::useSimdLevel(""));
}

}  // namespace
}  // namespace lisco_test::ground_scans
