// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Scans of simple scenes for the ground filter.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lisco/ground_filter.h"

namespace lisco_test::ground_scans {

/// An organized scan: cell (laser, column) is cells[laser * columns + column].
struct Scan {
  std::size_t lasers, columns;
  std::vector<lisco::Return> cells;
};

/// What a ray hits: its horizontal distance, or a negative one for nothing.
using Distance = std::function<double(double azimuth, double slope)>;

/// What a sensor at the origin measures in a direction.
inline lisco::Return returnOf(double azimuth, double slope, const Distance& distance) {
  const double rho = distance(azimuth, slope);
  if (rho < 0.0) return lisco::kNoReturn;
  return {static_cast<float>(rho * std::cos(azimuth)), static_cast<float>(rho * std::sin(azimuth)),
          static_cast<float>(rho * slope), 0};
}

/// A scan of a sensor at the origin, elevations from 10 degrees down to -25.
inline Scan scanOf(std::size_t lasers, std::size_t columns, const Distance& distance) {
  Scan scan{lasers, columns, {}};
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column) {
      const double azimuth = 2.0 * M_PI * static_cast<double>(column) / static_cast<double>(columns);
      const double slope =
          std::tan((10.0 - 35.0 * static_cast<double>(laser) / static_cast<double>(lasers)) * M_PI / 180.0);
      scan.cells.push_back(returnOf(azimuth, slope, distance));
    }
  return scan;
}

/// Where a ray of this slope meets the plane z = rise * x - height, within 100 m; -1: nowhere.
inline double meetsPlane(double azimuth, double slope, double height, double rise = 0.0) {
  const double descent = rise * std::cos(azimuth) - slope;
  const double rho = descent > 0.0 ? height / descent : -1.0;
  return rho < 100.0 ? rho : -1.0;
}

/// Shares of the returns called ground: of those for which `chosen` holds.
template <typename Chosen>
double share(const Scan& scan, const std::vector<std::uint8_t>& ground, Chosen&& chosen) {
  double count = 0, called = 0;
  for (std::size_t i = 0; i < scan.cells.size(); ++i) {
    const lisco::Return& cell = scan.cells[i];
    if (!lisco::isReturn(cell.x, cell.y, cell.z) || !chosen(cell)) continue;
    ++count;
    called += ground[i];
  }
  EXPECT_GT(count, 100);
  return called / count;
}

inline bool all(const lisco::Return& /*cell*/) {
  return true;
}

/// The decisions on a whole scan.
inline std::vector<std::uint8_t> filterAll(const Scan& scan, const lisco::GroundParameters& parameters = {}) {
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  lisco::GroundFilter filter;
  filter.filter(
      parameters, scan.columns, scan.lasers,
      [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; }, ground.data());
  return ground;
}

/// The same, column by column.
inline std::vector<std::uint8_t> filterByColumns(const Scan& scan, const lisco::GroundParameters& parameters = {}) {
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

}  // namespace lisco_test::ground_scans
