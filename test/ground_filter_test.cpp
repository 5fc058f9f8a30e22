// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/ground_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace {

constexpr double kPi = 3.14159265358979323846;

/// An organized scan: cell (laser, column) is cells[laser * columns + column].
struct Scan {
  std::size_t lasers, columns;
  std::vector<lisco::Return> cells;
};

/// A sensor 1.8 m above a plane, with a wall 2 m high all around it at `wall` metres.
Scan planeWithWall(std::size_t lasers, std::size_t columns, double wall) {
  Scan scan{lasers, columns, {}};
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column) {
      const double azimuth = 2.0 * kPi * static_cast<double>(column) / static_cast<double>(columns);
      const double elevation = (2.0 - 26.0 * static_cast<double>(laser) / static_cast<double>(lasers)) * kPi / 180.0;
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

std::vector<std::uint8_t> filterAll(const Scan& scan, const lisco::GroundParameters& parameters = {}) {
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  lisco::GroundFilter filter;
  filter.filter(
      parameters, scan.columns, scan.lasers,
      [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; }, ground.data());
  return ground;
}

std::vector<std::uint8_t> filterByColumns(const Scan& scan, const lisco::GroundParameters& parameters = {}) {
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  std::size_t decided = 0;
  const auto visit = [&](std::size_t column, const std::uint8_t* decisions, std::size_t lasers) {
    EXPECT_EQ(decided++, column);
    for (std::size_t laser = 0; laser < lasers; ++laser) ground[laser * scan.columns + column] = decisions[laser];
  };
  lisco::GroundFilter filter;
  filter.begin(parameters, scan.lasers);
  std::vector<lisco::Return> cells(scan.lasers);
  for (std::size_t column = 0; column < scan.columns; ++column) {
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) cells[laser] = scan.cells[laser * scan.columns + column];
    filter.addColumn(cells.data(), scan.lasers, visit);
    EXPECT_LE(column, decided + lisco::GroundFilter::kMaxDelay);
  }
  filter.finish(visit);
  EXPECT_EQ(decided, scan.columns);
  return ground;
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

}  // namespace
