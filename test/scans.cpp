// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "scans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Point noReturn(Random& random) {
  const std::array<Point, 6> kinds{{{0, 0, 0},
                                    {-0.0F, 0, 0},
                                    {kNan, kNan, kNan},
                                    {1.0F, kNan, 1.0F},
                                    {1.0F, 1.0F, kInfinity},
                                    {-kInfinity, kInfinity, 0}}};
  return random.oneOf(kinds);
}

/// How far the returns of one scan are from the sensor.
class Ranges {
 public:
  explicit Ranges(Random& random)
      : kind_(random.below(5)),
        base_(random.magnitude(0.05, 100.0)),
        step_(random.magnitude(0.001, 0.3)),
        lobes_(1 + random.below(4)) {}

  double at(Random& random, double azimuth, double elevation) const {
    switch (kind_) {
      case 0:
        return base_;  // a sphere
      case 1:
        return base_ * (1.0 + step_ * random.unit());  // a rough one
      case 2:
        return base_ * (1.5 + std::sin(azimuth * static_cast<double>(lobes_)));  // walls
      case 3:
        return random.magnitude(0.01, 100.0);  // no surface at all
      default:
        return base_ / std::max(0.05, std::fabs(std::sin(elevation)));  // floor and ceiling
    }
  }

 private:
  std::size_t kind_;
  double base_, step_;
  std::size_t lobes_;
};

/// Repeats and drops columns, as lost and repeated packets do.
Scan spoilColumns(const Scan& scan, Random& random) {
  std::vector<std::size_t> kept;
  for (std::size_t column = 0; column < scan.columns; ++column) {
    const std::size_t times = random.chance(0.1) ? 0 : (random.chance(0.1) ? 2 : 1);
    kept.insert(kept.end(), times, column);
  }
  if (kept.empty()) kept.push_back(0);
  Scan spoilt(kept.size(), scan.lasers);
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < kept.size(); ++column) {
      const lisco::Return& cell = scan.at(laser, kept[column]);
      spoilt.set(laser, column, {cell.x, cell.y, cell.z});
    }
  return spoilt;
}

}  // namespace

Scan::Scan(std::size_t column_count, std::size_t laser_count)
    : columns(column_count), lasers(laser_count), cells(column_count * laser_count) {
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = {kNan, kNan, kNan, static_cast<std::uint32_t>(i)};
}

void Scan::set(std::size_t laser, std::size_t column, const Point& point) {
  lisco::Return& cell = at(laser, column);
  cell.x = point.x;
  cell.y = point.y;
  cell.z = point.z;
}

std::vector<lisco::Return> Scan::column(std::size_t number) const {
  std::vector<lisco::Return> column_cells;
  for (std::size_t laser = 0; laser < lasers; ++laser) column_cells.push_back(at(laser, number));
  return column_cells;
}

std::vector<Point> Scan::points() const {
  std::vector<Point> points;
  points.reserve(cells.size());
  for (const lisco::Return& cell : cells) points.push_back({cell.x, cell.y, cell.z});
  return points;
}

Scan randomScan(Random& random, std::size_t max_cells) {
  const std::size_t lasers = random.chance(0.15) ? 1 : 1 + random.below(max_cells / 15);
  const std::size_t columns = random.chance(0.1) ? 1 : 1 + random.below(1 + max_cells / lasers);
  Scan scan(columns, lasers);

  const double direction = random.chance(0.5) ? 1.0 : -1.0;
  const double start = random.between(0.0, 2.0 * kPi);
  const std::array<double, 5> spans{1.0, 1.0, 380.0 / 360.0, 2.0, 0.1};  // turns
  const double column_step = 2.0 * kPi * random.oneOf(spans) / static_cast<double>(columns);
  const double lowest = random.chance(0.3) ? -kPi / 2.0 : random.between(-kPi / 2.0, 0.3);
  const double highest = random.chance(0.3) ? kPi / 2.0 : random.between(lowest, kPi / 2.0);
  const double stagger = random.chance(0.5) ? random.between(0.0, 0.6) : 0.0;
  const double sway = random.chance(0.3) ? random.between(0.0, 0.1) : 0.0;
  const double noise = random.chance(0.5) ? random.magnitude(1e-6, 0.05) : 0.0;
  const double dropout = random.chance(0.1) ? 1.0 : (random.chance(0.5) ? random.between(0.0, 0.8) : 0.0);
  const std::array<double, 8> scales{1.0, 1.0, 1.0, 1.0, 1e-3, 1e4, 1e-12, 1e12};
  const double scale = random.oneOf(scales);
  const double displacement = random.chance(0.2) ? random.magnitude(0.1, 1000.0) : 0.0;
  const Ranges ranges(random);

  std::vector<double> lag(lasers);
  for (double& l : lag) l = stagger * random.between(-1.0, 1.0);
  std::vector<std::size_t> row(lasers);
  std::iota(row.begin(), row.end(), std::size_t{0});
  if (random.chance(0.3)) random.shuffle(row);

  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column) {
      if (random.chance(dropout)) {
        scan.set(row[laser], column, noReturn(random));
        continue;
      }
      const double azimuth = start + direction * column_step * static_cast<double>(column) + lag[laser] +
                             noise * random.between(-1.0, 1.0);
      const double fraction = lasers > 1 ? static_cast<double>(laser) / static_cast<double>(lasers - 1) : 0.5;
      const double elevation =
          std::clamp(lowest + (highest - lowest) * fraction + sway * std::sin(2.0 * azimuth), -kPi / 2, kPi / 2);
      const double range = scale * ranges.at(random, azimuth, elevation);
      scan.set(row[laser], column,
               {static_cast<float>(range * std::cos(elevation) * std::cos(azimuth) + scale * displacement),
                static_cast<float>(range * std::cos(elevation) * std::sin(azimuth) - scale * displacement),
                static_cast<float>(range * std::sin(elevation))});
    }
  return random.chance(0.3) ? spoilColumns(scan, random) : scan;
}

Scan latticeScan(Random& random, float& spacing) {
  const std::array<int, 7> exponents{-40, -10, -3, 0, 2, 10, 40};
  spacing = static_cast<float>(std::ldexp(1.0, random.oneOf(exponents)));
  const std::size_t lasers = 1 + random.below(8);
  Scan scan(1 + random.below(20), lasers);
  const std::array<int, 3> offsets{0, 3, 1000};
  const int offset = random.oneOf(offsets);
  const auto coordinate = [&] { return spacing * static_cast<float>(static_cast<int>(random.below(7)) - 3 + offset); };
  for (lisco::Return& cell : scan.cells) {
    cell.x = coordinate();
    cell.y = coordinate();
    cell.z = coordinate();
  }
  return scan;
}

Scan extremeScan(Random& random) {
  constexpr float kMax = std::numeric_limits<float>::max();
  constexpr float kDenormal = std::numeric_limits<float>::denorm_min();
  const std::array<float, 14> magnitudes{0.0F,  kDenormal, 3 * kDenormal, 1e-40F, 1e-38F, 1e-23F, 1e-20F,
                                         1e-3F, 1.0F,      1e10F,         1e19F,  1e30F,  3e38F,  kMax};
  Scan scan(1 + random.below(16), 1 + random.below(6));
  const bool similar = random.chance(0.5);  // all of about one size, so that there are neighbours
  const float base = random.oneOf(magnitudes);
  const auto coordinate = [&]() -> float {
    const float size = similar && random.chance(0.9) ? base : random.oneOf(magnitudes);
    const auto factor = static_cast<float>(random.chance(0.5) ? 1.0 : random.between(0.99, 1.0));
    return (random.chance(0.5) ? size : -size) * factor;
  };
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column)
      scan.set(laser, column, random.chance(0.1) ? noReturn(random) : Point{coordinate(), coordinate(), coordinate()});
  return scan;
}

Scan largeScan(Random& random) {
  const std::array<std::size_t, 6> laser_choices{2, 3, 5, 16, 32, 64};
  const std::size_t lasers = random.oneOf(laser_choices);
  const std::size_t columns = 8192 / lasers + random.below(300);
  const double kept = random.chance(0.7) ? random.between(0.02, 0.2) : 1.0;
  const double lag = random.chance(0.5) ? random.between(0.0, 30.0) : 0.0;
  const double start = random.between(0.0, 6.28);
  const bool clockwise = random.chance(0.5);
  const double turns = random.chance(0.7) ? 1.0 : random.between(0.5, 1.5);
  Scan scan(columns, lasers);
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column) {
      if (!random.chance(kept)) continue;
      const double azimuth = start + (clockwise ? -6.283185307179586 : 6.283185307179586) * turns *
                                         (static_cast<double>(column) + lag * static_cast<double>(laser % 4)) /
                                         static_cast<double>(columns);
      const double elevation = 0.2 - 0.5 * static_cast<double>(laser) / static_cast<double>(lasers);
      double rho = 4.0 + 3.0 * std::sin(5.0 * azimuth) + random.magnitude(0.01, 3.0);
      if (elevation < -0.01) rho = std::min(rho, -1.8 / elevation);
      scan.set(laser, column,
               {static_cast<float>(rho * std::cos(azimuth)), static_cast<float>(rho * std::sin(azimuth)),
                static_cast<float>(rho * std::tan(elevation))});
    }
  return scan;
}

Scan widened(Random& random, const Scan& scan, std::size_t columns) {
  Scan wide(std::max(columns, scan.columns), scan.lasers);
  std::size_t empty = wide.columns - scan.columns;
  std::size_t to = random.chance(0.3) ? random.below(empty + 1) : wide.columns;
  const bool is_scattered = to == wide.columns;
  if (is_scattered) to = 0;
  for (std::size_t from = 0; from < scan.columns; ++from, ++to) {
    while (is_scattered && random.below(wide.columns - to) < empty) {
      ++to;
      --empty;
    }
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      const lisco::Return& cell = scan.at(laser, from);
      wide.set(laser, to, {cell.x, cell.y, cell.z});
    }
  }
  return wide;
}

Scan sometimesWide(Random& random, const Scan& scan) {
  constexpr std::size_t kSortedColumns = 256;
  if (!random.chance(0.25)) return scan;
  return widened(random, scan, kSortedColumns + (random.chance(0.5) ? 0 : random.below(100)));
}

float criticalTolerance(Random& random, const Scan& scan) {
  std::vector<Point> valid = scan.points();
  valid.erase(std::remove_if(valid.begin(), valid.end(), [](const Point& p) { return !isValid(p); }), valid.end());
  if (valid.size() < 2) return 0.5F;
  const Point from = random.oneOf(valid);
  std::vector<double> distances;
  for (const Point& to : valid) {
    const auto apart = [](float a, float b) { return static_cast<double>(a) - static_cast<double>(b); };
    distances.push_back(std::hypot(apart(from.x, to.x), apart(from.y, to.y), apart(from.z, to.z)));
  }
  std::sort(distances.begin(), distances.end());
  const double distance = distances[1 + random.below(std::min<std::size_t>(6, distances.size() - 1))];
  auto tolerance = static_cast<float>(std::clamp(distance, 1e-44, 3e38));
  const std::array<int, 6> ulps{-1, 0, 0, 1, 2, 3};
  const int steps = random.oneOf(ulps);
  for (int i = 0; i < std::abs(steps); ++i) tolerance = std::nextafter(tolerance, steps > 0 ? kInfinity : 0.0F);
  if (random.chance(0.4)) tolerance *= static_cast<float>(random.between(0.5, 3.0));
  return tolerance;
}

}  // namespace lisco_test
