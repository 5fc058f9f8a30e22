// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/ground_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "ground_scans.h"
#include "lisco/label_ground.h"

namespace lisco_test::ground_scans {
namespace {

/// A sensor 1.8 m above a plane, with a wall 2 m high all around it at `wall` metres.
Scan planeWithWall(std::size_t lasers, std::size_t columns, double wall) {
  Scan scan{lasers, columns, {}};
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column) {
      const double azimuth = 2.0 * M_PI * static_cast<double>(column) / static_cast<double>(columns);
      const double elevation = (2.0 - 26.0 * static_cast<double>(laser) / static_cast<double>(lasers)) * M_PI / 180.0;
      double rho = elevation < 0 ? -1.8 / std::tan(elevation) : 1e9;
      rho = std::min(rho, wall);
      const double z = rho * std::tan(elevation);
      scan.cells.push_back(z > 0.2
                               ? lisco::kNoReturn
                               : lisco::Return{static_cast<float>(rho * std::cos(azimuth)),
                                               static_cast<float>(rho * std::sin(azimuth)), static_cast<float>(z), 0});
    }
  return scan;
}

TEST(GroundFilter, FindsAPlaneAndLeavesAWall) {
  const Scan scan = planeWithWall(64, 1801, 30.0);
  const std::vector<std::uint8_t> ground = filterAll(scan);
  std::size_t plane = 0, missed = 0, wall = 0, lost = 0;
  for (std::size_t i = 0; i < scan.cells.size(); ++i) {
    const lisco::Return& cell = scan.cells[i];
    if (!lisco::isReturn(cell.x, cell.y, cell.z)) {
      EXPECT_EQ(ground[i], 0);
    } else if (cell.z < -1.799F) {
      ++plane;
      missed += ground[i] == 0;
    } else if (cell.z > -1.4F) {
      ++wall;
      lost += ground[i] == 1;
    }
  }
  EXPECT_GT(plane, 10000U);
  EXPECT_GT(wall, 1000U);
  EXPECT_EQ(missed, 0U);
  EXPECT_EQ(lost, 0U);
}

TEST(GroundFilter, BatchEqualsColumnByColumn) {
  const Scan scan = planeWithWall(32, 1003, 20.0);
  EXPECT_EQ(filterAll(scan), filterByColumns(scan));
}

TEST(GroundFilter, BatchEqualsColumnByColumnOnRandomReturns) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> coordinate(-30.0F, 30.0F);
  std::uniform_int_distribution<int> kind(0, 19);
  constexpr float kOdd[] = {
      std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30F, -3e38F, 0.0F, 1e-40F};
  for (std::size_t round = 0; round < 20; ++round) {
    Scan scan{1 + round * 7 % 130, 1 + round * 37 % 300, {}};
    for (std::size_t i = 0; i < scan.lasers * scan.columns; ++i) {
      lisco::Return cell{coordinate(random), coordinate(random), 0.1F * coordinate(random), 0};
      if (const int k = kind(random); k < 6) (k % 3 == 0 ? cell.x : k % 3 == 1 ? cell.y : cell.z) = kOdd[k];
      scan.cells.push_back(cell);
    }
    lisco::GroundParameters parameters;
    if (round % 2 == 1) parameters.sensor_height = 2.0F;
    EXPECT_EQ(filterAll(scan, parameters), filterByColumns(scan, parameters)) << "round " << round;
  }
}

TEST(GroundFilter, FindsSlopesOfFifteenDegrees) {
  for (const double degrees : {-15.0, -8.0, 8.0, 15.0}) {
    const double rise = std::tan(degrees * M_PI / 180.0);
    const Scan scan =
        scanOf(64, 1800, [&](double azimuth, double slope) { return meetsPlane(azimuth, slope, 1.8, rise); });
    lisco::GroundParameters parameters;
    parameters.sensor_height = 1.8F;
    EXPECT_GT(share(scan, filterAll(scan, parameters), all), 0.97) << degrees;
    EXPECT_GT(share(scan, filterAll(scan), all), 0.95) << degrees << ", height unknown";
  }
}

TEST(GroundFilter, FindsThePlaneOfAnyNumberOfLasersTurningEitherWay) {
  for (const std::size_t lasers : {16U, 32U, 64U, 128U})
    for (const double turn : {1.0, -1.0}) {
      const Scan scan =
          scanOf(lasers, 1500, [&](double azimuth, double slope) { return meetsPlane(azimuth, slope, 1.8); });
      Scan turned = scan;
      for (lisco::Return& cell : turned.cells) cell.y *= static_cast<float>(turn);
      EXPECT_GT(share(turned, filterAll(turned), all), 0.98) << lasers << " lasers, " << turn;
    }
}

TEST(GroundFilter, AcceptsRowsInAnyOrder) {
  const Scan scan = planeWithWall(64, 900, 25.0);
  std::vector<std::size_t> order(scan.lasers);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(3);
  std::shuffle(order.begin(), order.end(), random);
  Scan shuffled = scan;
  const std::vector<std::uint8_t> ground = filterAll(scan);
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column)
      shuffled.cells[laser * scan.columns + column] = scan.cells[order[laser] * scan.columns + column];
  const std::vector<std::uint8_t> shuffled_ground = filterAll(shuffled);
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column)
      ASSERT_EQ(shuffled_ground[laser * scan.columns + column], ground[order[laser] * scan.columns + column]);
}

TEST(GroundFilter, LeavesABridgeAndFindsTheGroundBeneath) {
  // A deck 4 m above the ground, from 15 m on; rays that rise end at it.
  const Scan scan = scanOf(64, 1800, [&](double azimuth, double slope) {
    if (slope > 0.0) return std::max(15.0, 2.2 / slope) < 60.0 ? std::max(15.0, 2.2 / slope) : -1.0;
    return meetsPlane(azimuth, slope, 1.8);
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return cell.z > 0.0F; }), 0.0);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return cell.z < -1.7F; }), 0.98);
}

TEST(GroundFilter, LeavesAWallWhoseFootIsHidden) {
  // Cars, 1.4 m high, 8 m away hide the foot of a wall 14 m away.
  const Scan scan = scanOf(64, 1800, [&](double azimuth, double slope) {
    const double rho = meetsPlane(azimuth, slope, 1.8);
    if (rho >= 0.0 && rho < 8.0) return rho;
    return 8.0 * slope < -0.4 ? 8.0 : 14.0;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_EQ(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.3F; }), 0.0);
}

TEST(GroundFilter, LeavesAHedge) {
  // From 9 m to 16 m away, up to 0.9 m high in front and 1.5 m behind; rays end anywhere in it.
  std::mt19937 random(7);
  std::exponential_distribution<double> depth(4.0);
  const Scan scan = scanOf(128, 1800, [&](double azimuth, double slope) {
    const double rho = meetsPlane(azimuth, slope, 1.8);
    if (rho >= 0.0 && rho < 9.0) return rho;
    // The ray is below the top, 0.09 m/m, from here on.
    const double top = slope * 9.0 < -0.9 ? 9.0 : (0.09 * 9.0 + 0.9) / (0.09 - std::min(slope, 0.0));
    const double leaf = top + depth(random);
    if (slope < 0.0 && leaf < 16.0) return rho >= 0.0 ? std::min(rho, leaf) : leaf;
    return rho;
  });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_LT(share(scan, ground, [](const lisco::Return& cell) { return cell.z > -1.3F; }), 0.01);
  EXPECT_GT(share(scan, ground, [](const lisco::Return& cell) { return std::hypot(cell.x, cell.y) < 8.9F; }), 0.98);
}

TEST(GroundFilter, IsNotMisledByReflectionsBelowTheGround) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> one_of(0, 29);
  Scan scan = scanOf(64, 1800, [&](double azimuth, double slope) { return meetsPlane(azimuth, slope, 1.8); });
  std::vector<bool> is_reflected;
  for (lisco::Return& cell : scan.cells) {
    is_reflected.push_back(cell.z < -1.0F && one_of(random) == 0);
    if (is_reflected.back()) {  // along its ray
      cell.x *= 1.7F;
      cell.y *= 1.7F;
      cell.z *= 1.7F;
    }
  }
  const std::vector<std::uint8_t> ground = filterAll(scan);
  double plane = 0, found = 0, reflections = 0, called = 0;
  for (std::size_t i = 0; i < scan.cells.size(); ++i) {
    if (is_reflected[i]) {
      ++reflections;
      called += ground[i];
    } else if (scan.cells[i].z < -1.7F) {
      ++plane;
      found += ground[i];
    }
  }
  EXPECT_GT(reflections, 1000);
  EXPECT_LT(called / reflections, 0.02);
  EXPECT_GT(found / plane, 0.97);
}

/// Leaves 0.9 m to 1.4 m away hide a plane, but where a sector is open.
Scan planeBehindPlants(double height, const std::function<bool(double azimuth)>& is_open) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> leaf(0.9, 1.4);
  return scanOf(32, 4000, [&, height, is_open](double azimuth, double slope) {
    return is_open(azimuth) ? meetsPlane(azimuth, slope, height) : leaf(random);
  });
}

TEST(GroundFilter, ForgetsAPlaneThatFewColumnsShow) {
  const Scan scan = planeBehindPlants(1.8, [](double azimuth) { return azimuth < 0.3 || azimuth > 6.0; });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  const auto azimuthOf = [](const lisco::Return& cell) {
    const float azimuth = std::atan2(cell.y, cell.x);
    return azimuth < 0.0F ? azimuth + 6.2831853F : azimuth;
  };
  EXPECT_EQ(share(scan, ground, [&](const auto& cell) { return azimuthOf(cell) < 0.29F && cell.z < -1.79F; }), 1.0);
  EXPECT_EQ(share(scan, ground, [&](const auto& cell) { return azimuthOf(cell) > 3.2F && azimuthOf(cell) < 6.1F; }),
            0.0);
}

TEST(GroundFilter, KeepsAPlaneThatAThirdOfTheColumnsShow) {
  const Scan scan = planeBehindPlants(1.8, [](double azimuth) { return std::fmod(azimuth, 0.6) < 0.2; });
  const std::vector<std::uint8_t> ground = filterAll(scan);
  EXPECT_GT(share(scan, ground, [](const auto& cell) { return cell.z < -1.79F; }), 0.95);
}

TEST(GroundFilter, TakesALowPlaneForATableWhereFewColumnsShowIt) {
  for (const double open : {0.12, 0.4}) {
    const Scan scan = planeBehindPlants(0.45, [=](double azimuth) { return std::fmod(azimuth, 0.6) < open; });
    const std::vector<std::uint8_t> ground = filterAll(scan);
    const auto isPlane = [](const lisco::Return& cell) {
      return std::fabs(cell.z + 0.45F) < 0.001F && std::hypot(cell.x, cell.y) > 1.5F && cell.y < -0.5F;
    };
    EXPECT_NEAR(share(scan, ground, isPlane), open > 0.2 ? 1.0 : 0.0, 0.001) << "open " << open << " of 0.6";
  }
}

TEST(GroundFilter, GoesOnAfterARotationWithoutAnotherBegin) {
  const Scan scan = planeWithWall(32, 1000, 20.0);
  lisco::GroundFilter filter;
  filter.begin({}, scan.lasers);
  std::vector<lisco::Return> cells(scan.lasers);
  std::size_t columns = 0, ground = 0, missed = 0;
  const auto visit = [&](std::size_t column, const std::uint8_t* decisions, std::size_t lasers) {
    EXPECT_EQ(column, columns++);
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      if (scan.cells[laser * scan.columns + column % scan.columns].z > -1.79F) continue;
      ++ground;
      missed += decisions[laser] == 0;
    }
  };
  for (std::size_t column = 0; column < 5 * scan.columns; ++column) {
    for (std::size_t laser = 0; laser < scan.lasers; ++laser)
      cells[laser] = scan.cells[laser * scan.columns + column % scan.columns];
    filter.addColumn(cells.data(), scan.lasers, visit);
    if (column == 1234) filter = lisco::GroundFilter(filter);  // a copy goes on
  }
  filter.finish(visit);
  EXPECT_EQ(columns, 5 * scan.columns);
  EXPECT_GT(ground, 10000U);
  EXPECT_EQ(missed, 0U);
}

// Whatever was decided last, and is still to be entered into the map, is each copy's own.
TEST(GroundFilter, CopiesGoOnIndependently) {
  const std::size_t lasers = 32, columns = 600;
  for (std::size_t common = 300; common < 316; ++common) {
    // Both are the same until one goes uphill.
    const auto scanRising = [&](double rise) {
      return scanOf(lasers, columns, [&](double azimuth, double slope) {
        const bool is_common = azimuth < 2.0 * M_PI * static_cast<double>(common) / static_cast<double>(columns) - 1e-9;
        return meetsPlane(azimuth, slope, 1.8, is_common ? 0.0 : rise);
      });
    };
    const Scan scans[2] = {scanRising(0.0), scanRising(-0.2)};
    std::vector<std::uint8_t> ground[2];
    for (auto& decisions : ground) decisions.assign(lasers * columns, 7);
    const auto visitorOf = [&](std::vector<std::uint8_t>& decisions) {
      return [&decisions, columns](std::size_t column, const std::uint8_t* decided, std::size_t count) {
        for (std::size_t laser = 0; laser < count; ++laser) decisions[laser * columns + column] = decided[laser];
      };
    };
    const auto columnOf = [&](const Scan& scan, std::size_t column) {
      std::vector<lisco::Return> cells;
      for (std::size_t laser = 0; laser < lasers; ++laser) cells.push_back(scan.cells[laser * columns + column]);
      return cells;
    };
    lisco::GroundFilter filters[2];
    filters[0].begin({}, lasers);
    for (std::size_t column = 0; column < common; ++column)
      filters[0].addColumn(columnOf(scans[0], column).data(), lasers, visitorOf(ground[0]));
    ground[1] = ground[0];
    filters[1] = filters[0];
    for (std::size_t column = common; column < columns; ++column)
      for (const std::size_t i : {0U, 1U})
        filters[i].addColumn(columnOf(scans[i], column).data(), lasers, visitorOf(ground[i]));
    for (const std::size_t i : {0U, 1U}) {
      filters[i].finish(visitorOf(ground[i]));
      EXPECT_EQ(ground[i], filterByColumns(scans[i])) << "copied after " << common << " columns, copy " << i;
    }
  }
}

TEST(GroundFilter, FindsNothingWithoutReturns) {
  Scan scan{16, 100, std::vector<lisco::Return>(1600, lisco::kNoReturn)};
  for (const std::uint8_t decision : filterAll(scan)) ASSERT_EQ(decision, 0);
  const Scan empty{0, 0, {}};
  EXPECT_TRUE(filterAll(empty).empty());
}

TEST(GroundFilter, EstimatesTheSensorsHeight) {
  const Scan scan = planeWithWall(64, 1800, 30.0);
  const auto cells = [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; };
  const lisco::GroundParameters estimated =
      lisco::estimateGround(scan.columns, scan.lasers, {0.0F, 0.0F, 0.0F}, lisco::CellSource(cells));
  EXPECT_NEAR(estimated.sensor_height, 1.8F, 0.05F);
  EXPECT_NEAR(estimated.slope[0], 0.0F, 0.02F);
  EXPECT_NEAR(estimated.slope[1], 0.0F, 0.02F);
}

TEST(GroundFilter, FiltersAScanByItsOwnEstimates) {
  const Scan scan = planeWithWall(64, 1800, 30.0);
  const auto cells = [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; };
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  const auto estimated = lisco::GroundFilter().filterScan({}, scan.columns, scan.lasers, cells, ground.data());
  EXPECT_NEAR(estimated.sensor_height, 1.8F, 0.05F);
  EXPECT_EQ(ground, filterAll(scan, estimated));
  lisco::GroundParameters given;
  given.sensor_height = 1.7F;
  const auto kept = lisco::GroundFilter().filterScan(given, scan.columns, scan.lasers, cells, ground.data());
  EXPECT_EQ(kept.sensor_height, 1.7F);
}

TEST(GroundFilter, GoesOnAfterAVisitorsException) {
  const Scan scan = planeWithWall(16, 200, 30.0);
  std::size_t visits = 0;
  std::vector<std::uint8_t> decided(scan.cells.size());
  const auto visit = [&](std::size_t column, const std::uint8_t* ground, std::size_t lasers) {
    for (std::size_t laser = 0; laser < lasers; ++laser) decided[laser * scan.columns + column] = ground[laser];
    if (++visits % 3 == 0) throw std::runtime_error("a visitor's");
  };
  lisco::GroundFilter filter;
  filter.begin({}, scan.lasers);
  std::vector<lisco::Return> cells(scan.lasers);
  for (std::size_t column = 0; column < scan.columns; ++column) {
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) cells[laser] = scan.cells[laser * scan.columns + column];
    try {
      filter.addColumn(cells.data(), cells.size(), visit);
    } catch (const std::runtime_error&) {
    }
  }
  for (std::size_t attempt = 0; attempt < scan.columns && visits < scan.columns; ++attempt) {
    try {
      filter.finish(visit);
    } catch (const std::runtime_error&) {
    }
  }
  EXPECT_EQ(decided, filterByColumns(scan));
}

TEST(GroundFilter, RejectsBadCallsAndParameters) {
  const auto ignore = [](std::size_t, const std::uint8_t*, std::size_t) {};
  const std::vector<lisco::Return> cells(5, lisco::kNoReturn);
  lisco::GroundFilter filter;
  EXPECT_THROW(filter.addColumn(cells.data(), 4, ignore), std::logic_error);
  filter.begin({}, 4);
  EXPECT_THROW(filter.addColumn(cells.data(), 5, ignore), std::invalid_argument);
  EXPECT_NO_THROW(filter.addColumn(cells.data(), 3, ignore));
  lisco::GroundParameters parameters;
  for (const float slope : {0.0F, 61.0F, -5.0F, std::numeric_limits<float>::quiet_NaN()}) {
    parameters.max_slope = slope;
    EXPECT_THROW(filter.begin(parameters, 4), std::invalid_argument) << slope;
  }
  parameters.max_slope = 20.0F;
  parameters.sensor_height = std::numeric_limits<float>::infinity();
  EXPECT_THROW(filter.begin(parameters, 4), std::invalid_argument);
  const auto cell_at = [](std::size_t, std::size_t) { return lisco::kNoReturn; };
  std::uint8_t ground = 7;
  EXPECT_THROW(filter.filterScan(parameters, 1, 1, cell_at, &ground), std::invalid_argument);
  for (const float coordinate : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    lisco::GroundParameters nowhere;
    nowhere.sensor.origin[1] = coordinate;
    EXPECT_THROW(filter.begin(nowhere, 4), std::invalid_argument) << coordinate;
    EXPECT_THROW(estimateGroundPlane(1, 1, nowhere, lisco::CellSource(cell_at)), std::invalid_argument) << coordinate;
  }
  for (const float slope : {10.1F, -1e30F, std::numeric_limits<float>::quiet_NaN()})
    for (const std::size_t axis : {0, 1}) {
      lisco::GroundParameters sloping, tilted;
      sloping.slope[axis] = tilted.sensor.tilt[axis] = slope;
      for (const lisco::GroundParameters& steep : {sloping, tilted}) {
        EXPECT_THROW(filter.begin(steep, 4), std::invalid_argument) << slope;
        EXPECT_THROW(estimateGroundPlane(1, 1, steep, lisco::CellSource(cell_at)), std::invalid_argument) << slope;
      }
    }
}

TEST(GroundFilter, NeedsABeginAfterAScan) {
  const auto ignore = [](std::size_t, const std::uint8_t*, std::size_t) {};
  const Scan with_ground = planeWithWall(32, 1000, 20.0);
  Scan without = with_ground;
  for (lisco::Return& cell : without.cells) cell = lisco::kNoReturn;
  lisco::GroundFilter filter;
  std::vector<std::uint8_t> ground(with_ground.cells.size());
  for (const Scan& scan : {with_ground, without}) {
    filter.begin({}, 32);
    filter.filterScan(
        {}, 1000, 32, [&](std::size_t laser, std::size_t column) { return scan.cells[laser * 1000 + column]; },
        ground.data());
    EXPECT_THROW(filter.addColumn(scan.cells.data(), 4, ignore), std::logic_error);
    filter.finish(ignore);
  }
}

TEST(LabelGround, SortsUnorganizedPoints) {
  const Scan scan = planeWithWall(32, 1000, 20.0);
  std::vector<std::array<float, 3>> points;
  for (const lisco::Return& cell : scan.cells) points.push_back({cell.x, cell.y, cell.z});
  std::mt19937 random(9);
  std::shuffle(points.begin(), points.end(), random);
  std::vector<std::uint8_t> ground(points.size(), 7);
  lisco::labelGround(points.data(), points.size(), sizeof points[0], {}, ground.data());
  std::size_t plane = 0, missed = 0, lost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float z = points[i][2];
    if (z == 0.0F) continue;
    plane += z < -1.799F;
    missed += z < -1.799F && ground[i] == 0;
    lost += z > -1.4F && ground[i] == 1;
  }
  EXPECT_GT(plane, 5000U);
  EXPECT_EQ(missed, 0U);
  EXPECT_EQ(lost, 0U);
}

TEST(LabelGround, FindsTheGroundOfUnorganizedPointsInAVehiclesFrame) {
  // The sensor is 1.8 m above the ground, where the vehicle's origin is, and 1.2 m in front of it.
  const Scan scan = planeWithWall(32, 1000, 20.0);
  std::vector<std::array<float, 3>> points;
  for (const lisco::Return& cell : scan.cells)
    if (lisco::isReturn(cell.x, cell.y, cell.z)) points.push_back({cell.x + 1.2F, cell.y, cell.z + 1.8F});
  std::vector<std::uint8_t> ground(points.size(), 7);
  lisco::labelGround(points.data(), points.size(), sizeof points[0], {}, ground.data());
  double plane = 0, found = 0, lost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    plane += points[i][2] < 0.001F;
    found += points[i][2] < 0.001F && ground[i] == 1;
    lost += points[i][2] > 0.4F && ground[i] == 1;
  }
  EXPECT_GT(plane, 5000);
  EXPECT_GT(found, 0.95 * plane);
  EXPECT_EQ(lost, 0);
}

TEST(LabelGround, KeepsTheTableOfUnorganizedPoints) {
  // The sensor is 0.1 m above a table that reaches 3 m around it, in a room of 6 m.
  const Scan scan = scanOf(40, 1000, [](double azimuth, double slope) {
    return slope < -0.1 / 3.0 ? -0.1 / slope : 6.0 + 0.5 * std::sin(20.0 * azimuth);
  });
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  lisco::labelGround(scan.cells.data(), scan.cells.size(), sizeof scan.cells[0], {}, ground.data());
  EXPECT_EQ(std::count(ground.begin(), ground.end(), 0), static_cast<std::ptrdiff_t>(ground.size()));
}

TEST(LabelGround, FindsNothingAmongPlants) {
  // Leaves 0.9 m to 1.4 m away hide the floor all around the sensor.
  for (const std::size_t lasers : {16U, 32U, 64U}) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> leaf(0.9, 1.4);
    const Scan scan = scanOf(lasers, 1024, [&](double /*azimuth*/, double /*slope*/) { return leaf(random); });
    std::vector<std::uint8_t> ground(scan.cells.size(), 7);
    lisco::LabelGroundParameters parameters;
    parameters.lasers = lasers;
    lisco::labelGround(scan.cells.data(), scan.cells.size(), sizeof scan.cells[0], parameters, ground.data());
    EXPECT_EQ(std::count(ground.begin(), ground.end(), 0), static_cast<std::ptrdiff_t>(ground.size())) << lasers;
  }
}

TEST(LabelGround, RejectsBadArguments) {
  float point[3] = {1.0F, 2.0F, 3.0F};
  std::uint8_t ground = 0;
  lisco::LabelGroundParameters parameters;
  EXPECT_THROW(lisco::labelGround(point, 1, 8, parameters, &ground), std::invalid_argument);
  EXPECT_THROW(lisco::labelGround(nullptr, 1, 12, parameters, &ground), std::invalid_argument);
  EXPECT_THROW(lisco::labelGround(point, 1, 12, parameters, nullptr), std::invalid_argument);
  EXPECT_NO_THROW(lisco::labelGround(nullptr, 0, 12, parameters, nullptr));
  for (const std::size_t axis : {0, 1, 2}) {
    parameters.origin[axis] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(lisco::labelGround(point, 1, 12, parameters, &ground), std::invalid_argument);
    EXPECT_THROW(lisco::labelGround(nullptr, 0, 12, parameters, nullptr), std::invalid_argument);
    parameters.origin[axis] = 0.0F;
  }
  parameters.lasers = 0;
  EXPECT_THROW(lisco::labelGround(point, 1, 12, parameters, &ground), std::invalid_argument);
}

}  // namespace
}  // namespace lisco_test::ground_scans
