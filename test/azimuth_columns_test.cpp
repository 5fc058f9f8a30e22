// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/azimuth_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "core/pi.h"

namespace lisco_test {
namespace {

using lisco::StridedPoints;
using lisco::ground::AzimuthColumns;
using Point = std::array<float, 3>;

AzimuthColumns sorted(const std::vector<Point>& points, const Point& origin = {}) {
  AzimuthColumns columns;
  columns.sort(StridedPoints::sideBySide(points.data(), sizeof(Point)), points.size(), origin);
  return columns;
}

/// Returns of all azimuths about an origin, `lasers` at each, in random order.
std::vector<Point> turn(std::size_t columns, std::size_t lasers, const Point& origin) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> range(2.0, 60.0);
  std::vector<Point> points;
  for (std::size_t column = 0; column < columns; ++column)
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const double azimuth = 2.0 * lisco::kPi * (static_cast<double>(column) + 0.5) / static_cast<double>(columns);
      const double slope = -0.4 + 0.5 * static_cast<double>(laser) / static_cast<double>(lasers);
      const double rho = range(random);
      points.push_back({origin[0] + static_cast<float>(rho * std::cos(azimuth)),
                        origin[1] + static_cast<float>(rho * std::sin(azimuth)),
                        origin[2] + static_cast<float>(rho * slope)});
    }
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

double slopeOf(const Point& point, const Point& origin) {
  return static_cast<double>(point[2] - origin[2]) /
         std::hypot(static_cast<double>(point[0] - origin[0]), static_cast<double>(point[1] - origin[1]));
}

/// How often each point is in a cell.
std::vector<int> countCells(const AzimuthColumns& columns, std::size_t points) {
  std::vector<int> counts(points, 0);
  for (std::size_t column = 0; column < columns.columns(); ++column)
    for (std::size_t row = 0; row < columns.rows(); ++row)
      if (const std::uint32_t point = columns.pointAt(row, column); point != AzimuthColumns::kNone) ++counts.at(point);
  return counts;
}

TEST(AzimuthColumns, HaveEachReturnOnceAndNothingElse) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kMax = std::numeric_limits<float>::max(), kMin = std::numeric_limits<float>::denorm_min();
  std::vector<Point> points = turn(300, 20, {});
  const std::size_t returns = points.size();
  // Finite coordinates are returns, wherever they are.
  const std::vector<Point> extreme{{kMax, kMax, kMax}, {-kMax, kMax, -kMax}, {0.0F, 0.0F, 5.0F},  {0.0F, -kMin, 0.0F},
                                   {kMin, kMin, kMin}, {-1.0F, 0.0F, 0.0F},  {-1.0F, -0.0F, kMax}};
  const std::vector<Point> none{{0.0F, 0.0F, 0.0F}, {kNan, 1.0F, 1.0F}, {1.0F, kInfinity, 1.0F}, {1.0F, 1.0F, kNan}};
  points.insert(points.end(), extreme.begin(), extreme.end());
  points.insert(points.end(), none.begin(), none.end());
  for (const Point& origin : {Point{}, Point{5.0F, -3.0F, 1.0F}, Point{-kMax, kMax, 0.0F}}) {
    const std::vector<int> counts = countCells(sorted(points, origin), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(counts[i], i < returns + extreme.size() ? 1 : 0) << i << " of " << points.size();
  }
}

TEST(AzimuthColumns, HaveABoundedNumberOfRows) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> along(0.0F, 100.0F);
  std::vector<Point> points;
  for (int i = 0; i < 20000; ++i)  // as seen from the origin of a map, all of one azimuth
    points.push_back({500000.0F + along(random), 4000000.0F + along(random), along(random)});
  const AzimuthColumns columns = sorted(points);
  EXPECT_EQ(columns.rows(), 1024U);
  EXPECT_LT(columns.columns(), 30U);
  EXPECT_EQ(countCells(columns, points.size()), std::vector<int>(points.size(), 1));
}

TEST(AzimuthColumns, HaveOneAzimuthAndRisingRows) {
  const Point origin{12.0F, -7.0F, 2.0F};
  const std::vector<Point> points = turn(900, 32, origin);
  const AzimuthColumns columns = sorted(points, origin);
  EXPECT_GE(columns.rows(), 32U);
  EXPECT_LE(columns.rows(), 80U);
  std::vector<double> lowest(columns.rows(), 1e9), highest(columns.rows(), -1e9);
  for (std::size_t column = 0; column < columns.columns(); ++column) {
    double below = -1e9;
    double first = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t row = 0; row < columns.rows(); ++row) {
      const std::uint32_t i = columns.pointAt(row, column);
      if (i == AzimuthColumns::kNone) continue;
      const double azimuth =
          std::atan2(static_cast<double>(points[i][1] - origin[1]), static_cast<double>(points[i][0] - origin[0]));
      if (std::isnan(first)) first = azimuth;
      // Bins are 2 pi / 512 wide, which is where most of them are followed by one with returns.
      EXPECT_NEAR(azimuth, first, 2.0 * lisco::kPi / 512.0 + 1e-4);
      EXPECT_GE(slopeOf(points[i], origin), below - 1e-5);
      below = slopeOf(points[i], origin);
      lowest[row] = std::min(lowest[row], below);
      highest[row] = std::max(highest[row], below);
    }
  }
  for (std::size_t row = 0; row < columns.rows(); ++row) EXPECT_LT(highest[row] - lowest[row], 0.1) << "row " << row;
}

TEST(AzimuthColumns, ForgetThePointsBefore) {
  const std::vector<Point> many = turn(900, 32, {}), few = turn(100, 7, {});
  AzimuthColumns columns = sorted(many);
  columns.sort(StridedPoints::sideBySide(few.data(), sizeof(Point)), few.size(), {});
  const std::vector<int> counts = countCells(columns, few.size());
  EXPECT_EQ(std::count(counts.begin(), counts.end(), 1), static_cast<std::ptrdiff_t>(few.size()));
}

TEST(AzimuthColumns, OfNoReturnsAreEmpty) {
  EXPECT_EQ(sorted({}).columns(), 0U);
  EXPECT_EQ(sorted({{0.0F, 0.0F, 0.0F}}).columns(), 0U);
}

}  // namespace
}  // namespace lisco_test
