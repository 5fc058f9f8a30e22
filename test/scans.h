// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <vector>

#include "lisco/return.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {

/// A small rotation: cells laser by laser; a return's source index is the number of its cell.
struct Scan {
  std::size_t columns = 0;
  std::size_t lasers = 0;
  std::vector<lisco::Return> cells;

  Scan(std::size_t column_count, std::size_t laser_count);
  lisco::Return& at(std::size_t laser, std::size_t column) { return cells[laser * columns + column]; }
  const lisco::Return& at(std::size_t laser, std::size_t column) const { return cells[laser * columns + column]; }
  void set(std::size_t laser, std::size_t column, const Point& point);
  std::vector<Point> points() const;
  std::vector<lisco::Return> column(std::size_t number) const;
};

/// A scan with any number of these faults, in any strength: the sensor turns either way from any azimuth, over less or
/// more than a turn; lasers are staggered, rings sway, rows are shuffled, columns are missing or come twice; elevations
/// reach to straight up; returns are nearer than any tolerance, or at random ranges; cells are NaN, infinite or (0, 0,
/// 0); the scan has any size and position.
/// \param max_cells maximum number of cells, roughly
Scan randomScan(Random& random, std::size_t max_cells = 150);

/// Points on a lattice whose spacing is a power of two, so that distances are exact.
/// \param spacing receives it
Scan latticeScan(Random& random, float& spacing);

/// Coordinates where floats end: 3e38, 1e30, denormals, and everything in between.
Scan extremeScan(Random& random);

/// A rotation of at least as many cells as several threads need, of which few or most are returns.
Scan largeScan(Random& random);

/// The scan's columns in their order among empty ones, anywhere or one after the other.
/// \param columns in all, at least the scan's
Scan widened(Random& random, const Scan& scan, std::size_t columns);

/// In one of four cases the scan widened to 256 columns and more: added at once, their returns are sorted.
Scan sometimesWide(Random& random, const Scan& scan);

/// A tolerance near some distances of the scan, often within one ulp; positive and finite.
float criticalTolerance(Random& random, const Scan& scan);

}  // namespace lisco_test
