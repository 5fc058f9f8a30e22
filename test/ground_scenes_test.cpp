// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The ground filter on simple scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/ground/unevenness.h"
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
    EXPECT_GT(share(scan, filterAll(scan, parameters), all), 0.985) << degrees;
  }
}

// The lines of the ground, drawn on to beneath the sensor, end half a metre below it.
TEST(GroundScenes, EstimateThePlaneOfAHollowWhereItsLinesBegin) {
  const Scan scan =
      scanOfSurface([](double x, double y) { return 0.15 * std::clamp(std::hypot(x, y) - 3.0, 0.0, 12.0) - kHeight; });
  const auto cells = [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; };
  std::vector<std::uint8_t> ground(scan.cells.size());
  const auto estimated = lisco::GroundFilter().filterScan({}, scan.columns, scan.lasers, cells, ground.data());
  EXPECT_NEAR(static_cast<double>(estimated.sensor_height), kHeight, 0.2);
  EXPECT_GT(share(scan, ground, all), 0.98);
}

/// 12 m x 8 m and 3.2 m high, with a table 1 m wide; the sensor is 1 m above the floor.
Scan room(std::size_t lasers) {
  const auto isTable = [](double x, double y) { return std::fabs(x - 3.0) < 0.5 && std::fabs(y) < 1.0; };
  return scanOf(lasers, kColumns, [&](double azimuth, double slope) {
    const auto inside = [&](double x, double y) {
      if (std::fabs(x) > 6.0 || std::fabs(y) > 4.0) return 10.0;
      return isTable(x, y) ? -0.25 : -1.0;
    };
    const double rho = meetsSurface(azimuth, slope, inside);
    return slope > 0.0 ? std::min(rho, 2.2 / slope) : rho;
  });
}

bool isFloorOfRoom(const lisco::Return& cell) {
  return cell.z < -0.99F;
}

TEST(GroundScenes, FindsTheFloorOfARoom) {
  const Scan scan = room(kLasers);
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_GT(share(scan, ground, isFloorOfRoom), 0.97);  // the first columns face the table
  EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -0.8F; }), 0.005);
}

struct Table {
  double half_length, below;  ///< metres, below the sensor in its middle
};

/// A room of 12 m x 8 m with a box in it, 1 m wide and 0.3 m high.
/// \param height of the sensor above the floor, metres
Scan lowRoom(std::size_t lasers, double height, const Table& table = {0.0, 0.0}) {
  return scanOf(lasers, kColumns, [&](double azimuth, double slope) {
    return meetsSurface(azimuth, slope, [&](double x, double y) {
      if (std::fabs(x) > 6.0 || std::fabs(y) > 4.0) return 10.0;
      if (std::fabs(x) < table.half_length && std::fabs(y) < 0.7 * table.half_length) return -table.below;
      return (std::fabs(x + 3.0) < 0.5 && std::fabs(y) < 0.5 ? 0.3 : 0.0) - height;
    });
  });
}

TEST(GroundScenes, FindTheFloorBeneathALowRobot) {
  for (const std::size_t lasers : {16U, 32U, 64U})
    for (const double height : {0.13, 0.18, 0.25, 0.4}) {
      const Scan scan = lowRoom(lasers, height);
      const auto isFloor = [&](const lisco::Return& cell) { return static_cast<double>(cell.z) < 0.001 - height; };
      const std::vector<std::uint8_t> ground = filterAll(scan);
      EXPECT_GT(share(scan, ground, isFloor), 0.97) << lasers << " lasers, " << height;
      EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > 0.1F; }), 0.01) << height;
    }
}

TEST(GroundScenes, LeaveATableAroundTheSensor) {
  for (const std::size_t lasers : {32U, 64U, 128U})
    for (const Table& table : {Table{0.6, 0.15}, Table{1.6, 0.4}}) {
      const Scan scan = lowRoom(lasers, 0.9, table);
      const auto isTable = [&](const lisco::Return& cell) {
        return std::fabs(static_cast<double>(cell.z) + table.below) < 0.001;
      };
      const auto isFloor = [](const lisco::Return& cell) { return cell.z < -0.899F; };
      const std::vector<std::uint8_t> ground = filterAll(scan);
      EXPECT_EQ(share(scan, ground, isTable), 0.0) << lasers << " lasers, " << table.below;
      EXPECT_GT(share(scan, ground, isFloor), 0.98) << lasers << " lasers, " << table.below;
    }
}

lisco::GroundParameters estimated(const Scan& scan) {
  const auto cells = [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; };
  return lisco::estimateGround(scan.columns, scan.lasers, {0, 0, 0}, lisco::CellSource(cells));
}

TEST(GroundScenes, AreEstimatedInRooms) {
  for (const std::size_t lasers : {16U, 32U, 64U, 128U}) {
    const Scan scan = room(lasers);
    const lisco::GroundParameters parameters = estimated(scan);
    EXPECT_NEAR(parameters.sensor_height, 1.0F, 0.05F) << lasers;
    const std::vector<std::uint8_t> ground = filterAll(scan, parameters);
    EXPECT_GT(share(scan, ground, isFloorOfRoom), 0.98) << lasers;
    EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -0.8F; }), 0.005) << lasers;
  }
}

/// What a sensor with two returns gives: a row for each laser's first return, then one for its last. Of each fifth ray
/// the first return is a leaf or a thread at half the distance.
/// \param repeats whether a ray with one return gives it twice
Scan withTwoReturns(const Scan& last, bool repeats) {
  std::mt19937 random(8);
  std::uniform_int_distribution<int> one_of(0, 4);
  Scan scan{2 * last.lasers, last.columns, std::vector<lisco::Return>(2 * last.cells.size(), lisco::kNoReturn)};
  for (std::size_t laser = 0; laser < last.lasers; ++laser)
    for (std::size_t column = 0; column < last.columns; ++column) {
      const lisco::Return& cell = last.cells[laser * last.columns + column];
      lisco::Return& first = scan.cells[2 * laser * last.columns + column];
      lisco::Return& second = scan.cells[(2 * laser + 1) * last.columns + column];
      if (one_of(random) == 0) {
        first = {0.5F * cell.x, 0.5F * cell.y, 0.5F * cell.z, 0};
        second = cell;
      } else {
        first = cell;
        if (repeats) second = cell;
      }
    }
  return scan;
}

TEST(GroundScenes, HaveTwoReturnsOfEachRay) {
  for (const bool repeats : {true, false})
    for (const std::size_t lasers : {16U, 32U, 64U}) {
      SCOPED_TRACE(testing::Message() << lasers << " lasers, each return twice: " << repeats);
      const Scan outside = withTwoReturns(
          scanOf(lasers, kColumns, [](double azimuth, double slope) { return meetsPlane(azimuth, slope, kHeight); }),
          repeats);
      const Scan inside = withTwoReturns(room(lasers), repeats);
      const auto isFloor = [](const lisco::Return& cell) { return cell.z < 0.01F - static_cast<float>(kHeight); };
      EXPECT_NEAR(estimated(outside).sensor_height, kHeight, 0.05);
      EXPECT_NEAR(estimated(inside).sensor_height, 1.0, 0.05);
      EXPECT_GT(share(outside, filterAll(outside), isFloor), 0.95);
      EXPECT_GT(share(outside, filterAll(outside, estimated(outside)), isFloor), 0.95);
      EXPECT_GT(share(inside, filterAll(inside), isFloorOfRoom), 0.95);
      EXPECT_GT(share(inside, filterAll(inside, estimated(inside)), isFloorOfRoom), 0.95);
    }
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

/// 48 lasers, each of which is 1.8 degrees of azimuth further on than the one below, up to every eighth: these eight
/// chains have few lasers that look steeply down.
Scan chainsOf(const Distance& distance) {
  constexpr std::size_t kChains = 8;
  constexpr std::array<double, kChains> kLowest = {25.0, 19.6, 15.6, 13.6, 11.3, 9.8, 8.8, 8.0};
  Scan scan{48, 1600, {}};
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const double below = laser < kChains ? kLowest[laser] : 7.5 - 0.35 * static_cast<double>(laser - kChains);
      const double slope = -std::tan(below * M_PI / 180.0);
      const double azimuth = 2.0 * M_PI * static_cast<double>(column + laser % kChains * 8) / 1600.0;
      scan.cells.push_back(returnOf(azimuth, slope, distance));
    }
  return scan;
}

TEST(GroundScenes, LeavesMostOfBoxesThatHideTheGroundFromChainsOfLasers) {
  // Eight flat boxes, 0.45 m high, from 7 m to 11 m away: many chains of lasers see no ground in front of them.
  const auto surface = [](double x, double y) {
    const double away = std::hypot(x, y), turn = std::atan2(y, x) * 4.0 / M_PI;
    return away > 7.0 && away < 11.0 && turn - std::floor(turn) < 0.5 ? 0.45 - kHeight : -kHeight;
  };
  const Scan scan = chainsOf([&](double azimuth, double slope) { return meetsSurface(azimuth, slope, surface); });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.4F; }), 0.4);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -1.79F; }), 0.99);
}

TEST(GroundScenes, FindsMostOfAnUnevenField) {
  const auto field = [](double x, double y) {
    const double hills = std::sin(0.21 * x + 0.5) + std::sin(0.21 * (0.3 * x - 0.95 * y) + 4.0);
    const double bumps = std::sin(0.48 * (0.8 * x + 0.6 * y) + 1.0) + std::sin(1.05 * (0.5 * x - 0.87 * y));
    return 0.4 * hills + 0.1 * bumps - 1.6 - kHeight;
  };
  const Scan scan = chainsOf([&](double azimuth, double slope) { return meetsSurface(azimuth, slope, field); });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_GT(share(scan, ground, all), 0.928);
}

TEST(Unevenness, FollowsTheChangesOfSlope) {
  const auto unit = static_cast<std::int32_t>(lisco::ground::Unevenness::kUnit);
  lisco::ground::Unevenness unevenness;
  EXPECT_EQ(unevenness.value(), 0.0F);
  unevenness.add(unit / 10, 1);
  EXPECT_EQ(unevenness.value(), 0.0F) << "one stretch of a kerb";
  for (int block = 0; block < 64; ++block) unevenness.add(unit, 10);
  EXPECT_EQ(unevenness.value(), 1.0F);
  for (int block = 0; block < 100000; ++block) unevenness.add(0, 0);
  EXPECT_EQ(unevenness.value(), 1.0F) << "no ground in view";
  for (int block = 0; block < 256; ++block) unevenness.add(unit / 10, 10);
  EXPECT_EQ(unevenness.value(), 0.0F);
}

TEST(GroundScenes, BeginsAtTheGroundNearby) {
  // Beyond a step down of 1.7 m, 7.5 m away, the ground rises by 8 %, as if from 4.1 m beneath the sensor.
  const auto surface = [](double x, double y) {
    const double away = std::hypot(x, y);
    return away < 7.5 ? -kHeight : std::min(-kHeight, -4.1 + 0.08 * away);
  };
  const Scan scan = scanOfSurface(surface);
  EXPECT_GT(share(scan, filterAll(scan), [](const lisco::Return& cell) { return cell.z > -1.81F; }), 0.98);
}

TEST(GroundScenes, ForgetsTheGroundBelowARampThatTheFirstColumnsFaced) {
  // The ramp falls by 20 %, so that lasers that look steeply down meet it 8 m away; beyond, the ground is level.
  const Scan scan = scanOfSurface([](double x, double) { return -kHeight - 0.2 * std::clamp(x, 0.0, 7.5); });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.x < 0.0F; }), 0.97);
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

TEST(GroundScenes, LeavesWallsFromTheirFeetOn) {
  // A courtyard of 14 m x 9 m, whose walls the lasers meet each 6 cm to 9 cm.
  const Scan scan = scanOf(64, kColumns, [](double azimuth, double slope) {
    const double wall = std::min(7.0 / std::fabs(std::cos(azimuth)), 4.5 / std::fabs(std::sin(azimuth)));
    const double rho = meetsPlane(azimuth, slope, kHeight);
    return rho < 0.0 ? wall : std::min(rho, wall);
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.74F && cell.z < -1.4F; }), 0.0);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.4F; }), 0.0);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -1.799F; }), 0.98);
}

TEST(GroundScenes, RemembersTheGroundThatAVanHid) {
  // To the left, 9 m away, a fence 1.2 m high with a van in it, 2.3 m high. Beyond, the ground is 0.5 m higher; only
  // two lasers see it there over the fence, none over the van.
  const Scan scan = scanOf(64, kColumns, [](double azimuth, double slope) {
    return meetsSurface(azimuth, slope, [](double x, double y) {
      if (y > 26.0) return 5.0;
      if (y > 9.0 && y < 9.3 && x > 1.2 && x < 2.6) return 2.3 - kHeight;
      if (y > 9.0 && y < 9.3 && std::fabs(x) < 4.0) return 1.2 - kHeight;
      return 0.5 * std::clamp((y - 9.0) / 4.0, 0.0, 1.0) - kHeight;
    });
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  const auto isBeyond = [](const lisco::Return& cell) {
    return cell.y > 13.0F && cell.y < 25.9F && cell.z < -1.29F && std::fabs(cell.x / cell.y) < 4.0F / 9.3F;
  };
  EXPECT_GT(share(scan, ground, isBeyond), 0.95);
}

TEST(GroundScenes, FindsTheContinuationOfASlopeBehindAFence) {
  // Up to 88 degrees, the ground begins to rise 4 m away, and is seen up to 10 m. Then a fence 5 m away hides it, over
  // which two lasers see where it goes on.
  const auto surface = [](double x, double y) { return 0.08 * std::max(0.0, std::hypot(x, y) - 4.0) - kHeight; };
  const auto isFence = [](double degrees) { return degrees > 88.0 && degrees < 100.0; };
  const Scan scan = scanOf(64, kColumns, [&](double azimuth, double slope) {
    const double degrees = azimuth * 180.0 / M_PI;
    if (degrees < 60.0 || degrees > 100.0) return meetsPlane(azimuth, slope, kHeight);
    const double rho = meetsSurface(azimuth, slope, surface);
    if (!isFence(degrees)) return rho < 10.0 ? rho : -1.0;
    if (rho > 5.0 && rho < 11.5) return 5.0;
    return rho < 13.9 ? rho : -1.0;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  const auto isBehindFence = [&](const lisco::Return& cell) {
    const double degrees = std::atan2(static_cast<double>(cell.y), static_cast<double>(cell.x)) * 180.0 / M_PI;
    return isFence(degrees) && distanceOf(cell) > 11.0;
  };
  EXPECT_GT(share(scan, ground, isBehindFence), 0.9);
}

TEST(GroundScenes, LeavesAPlatformBehindAWall) {
  // The ground is seen up to 7 m. From 90 to 150 degrees a wall, 0.6 m high, begins there, over which lasers see a
  // platform 0.7 m high, 18 m away.
  constexpr double kWallTop = 0.6 - kHeight, kPlatform = 0.7 - kHeight;
  const auto isBehindWall = [](double azimuth) { return azimuth > 0.5 * M_PI && azimuth < 5.0 * M_PI / 6.0; };
  const Scan scan = scanOf(128, kColumns, [&](double azimuth, double slope) {
    const double rho = meetsPlane(azimuth, slope, kHeight);
    if (rho > 0.0 && rho < 7.0) return rho;
    if (!isBehindWall(azimuth)) return -1.0;
    if (slope * 7.0 < kWallTop) return 7.0;
    return slope * 18.0 > kPlatform && slope * 22.0 < kPlatform ? kPlatform / slope : -1.0;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return distanceOf(cell) > 17.0; }), 0.0);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return distanceOf(cell) < 6.9; }), 0.98);
}

TEST(GroundScenes, ForgetATerraceThatRaysPassBeneath) {
  // Up to 85 degrees, the ground rises to a terrace 1.2 m high, 18 m away. Then a wet road begins, which is seen up to
  // 9 m only: first with a wall 32 m away, from 88 degrees on with the bed of a trailer, as high as the terrace.
  constexpr double kBed = 1.2 - kHeight;
  const auto degreesOf = [](double azimuth) { return azimuth * 180.0 / M_PI; };
  const auto onTerrace = [](double x, double y) {
    return 1.2 * std::clamp((std::hypot(x, y) - 10.0) / 8.0, 0.0, 1.0) - kHeight;
  };
  const Scan scan = scanOf(128, 1801, [&](double azimuth, double slope) {
    const double degrees = degreesOf(azimuth);
    if (degrees < 85.0) return meetsSurface(azimuth, slope, onTerrace);
    const double road = meetsPlane(azimuth, slope, kHeight);
    if (degrees > 112.0 || (road > 0.0 && road < 9.0)) return road;
    if (degrees > 88.0) return slope * 18.0 > kBed && slope * 22.0 < kBed ? kBed / slope : -1.0;
    return slope * 32.0 > -kHeight ? 32.0 : -1.0;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  const auto isTerrace = [&](const lisco::Return& cell) {
    return cell.x > 2.0F && cell.y > 0.0F && cell.z > -0.61F && distanceOf(cell) < 30.0;
  };
  const auto isBed = [&](const lisco::Return& cell) {
    const double degrees = degreesOf(std::atan2(static_cast<double>(cell.y), static_cast<double>(cell.x)));
    return degrees > 88.0 && degrees < 112.0 && distanceOf(cell) > 18.0 && distanceOf(cell) < 22.1;
  };
  EXPECT_GT(share(scan, ground, isTerrace), 0.95);
  EXPECT_EQ(share(scan, ground, isBed), 0.0);
}

TEST(GroundScenes, FindsASlopeThatBeginsBehindABus) {
  // It rises by 12 degrees to the right, where the sensor looks last. A bus hides what is between.
  const double rise = -std::tan(12.0 * M_PI / 180.0), bus = 220.0 * M_PI / 180.0;
  const Scan scan = scanOf(kLasers, kColumns, [&](double azimuth, double slope) {
    if (std::fabs(azimuth - bus) < 20.0 * M_PI / 180.0) return 1.5 / std::cos(azimuth - bus);
    const double descent = rise * std::sin(azimuth) - slope;
    return descent > kHeight / 100.0 ? kHeight / descent : -1.0;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.y > 0.0F; }), 0.98);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.y < -1.8F * std::fabs(cell.x); }), 0.98);
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
