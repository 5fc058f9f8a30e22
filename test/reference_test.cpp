// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The reference implementations: the voxel grid is exact, and the paper's algorithms miss exactly the neighbours that
// Algorithm 2's mask misses.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "oracle.h"
#include "random.h"
#include "reference/paper_lisco.h"
#include "reference/voxel_grid.h"
#include "scans.h"

namespace lisco_test {
namespace {

using lisco_reference::getNeighborMask;
using lisco_reference::NeighborMask;
using lisco_reference::NominalSensor;
using lisco_reference::PaperLisco;
using lisco_reference::VoxelGrid;

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The clusters given by a number per point; points with number `none` are in none.
Clustering byNumber(const std::vector<std::uint32_t>& number_of, std::uint32_t none = PaperLisco::kNoCluster) {
  std::map<std::uint32_t, Cluster> clusters;
  for (std::uint32_t i = 0; i < number_of.size(); ++i) {
    if (number_of[i] == none) continue;
    Cluster& cluster = clusters[number_of[i]];
    cluster.members.push_back(i);
    ++cluster.reported_size;
  }
  Clustering result;
  for (const auto& entry : clusters) result.push_back(entry.second);
  return inOrder(result);
}

std::vector<lisco::Return> returnsOf(const std::vector<Point>& points) {
  std::vector<lisco::Return> returns;
  for (const Point& p : points) returns.push_back({p.x, p.y, p.z, static_cast<std::uint32_t>(returns.size())});
  return returns;
}

// --- The voxel grid ------------------------------------------------------------------------------------------------

/// Whether the grid may refuse a scan: too many cells and returns, or a tolerance with a square at the limits of float.
bool mayRefuse(const std::vector<Point>& points, float tolerance) {
  const double eps = std::fabs(static_cast<double>(tolerance));
  if (!(eps > 1e-18 && eps < 1e18)) return true;
  double bits = std::log2(static_cast<double>(points.size()));
  for (float Point::*axis : {&Point::x, &Point::y, &Point::z}) {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -lo;
    for (const Point& p : points) {
      lo = std::min(lo, static_cast<double>(p.*axis));
      hi = std::max(hi, static_cast<double>(p.*axis));
    }
    const double axis_bits = std::log2((hi - lo) / eps * 1.7321 + 8);
    if (axis_bits > 36) return true;
    bits += axis_bits;
  }
  return bits > 60;
}

/// \return whether the grid accepted the scan
bool expectGridExact(VoxelGrid& grid, const std::vector<Point>& all, float tolerance) {
  std::vector<Point> points;
  std::copy_if(all.begin(), all.end(), std::back_inserter(points), isValid);
  Clustering found;
  try {
    found = byNumber(grid.cluster(returnsOf(points), tolerance));
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(mayRefuse(points, tolerance)) << error.what() << " (tolerance " << tolerance << ")";
    return false;
  }
  EXPECT_EQ(difference(trueClusters(points, tolerance), found), "") << "tolerance " << tolerance;
  return true;
}

void expectGridExact(const std::vector<Point>& points, float tolerance) {
  VoxelGrid grid;
  EXPECT_TRUE(expectGridExact(grid, points, tolerance));
}

TEST(VoxelGrid, IsExactOnRandomScans) {
  VoxelGrid grid;  // one for all scans: it keeps only its memory
  std::size_t taken = 0;
  constexpr std::uint64_t kScans = 1500;
  for (std::uint64_t seed = 0; seed < kScans; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random);
    taken += expectGridExact(grid, scan.points(), criticalTolerance(random, scan)) ? 1 : 0;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(taken, kScans * 9 / 10);
}

TEST(VoxelGrid, IsExactOnLattices) {
  VoxelGrid grid;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    float spacing = 0;
    const Scan scan = latticeScan(random, spacing);
    for (const float factor : {1.0F, std::sqrt(2.0F), std::sqrt(3.0F), 2.0F}) {
      const float tolerance = spacing * factor;
      for (const float near : {std::nextafter(tolerance, 0.0F), tolerance, std::nextafter(tolerance, kInfinity)})
        expectGridExact(grid, scan.points(), near);
    }
    if (testing::Test::HasFailure()) return;
  }
}

TEST(VoxelGrid, IsExactOrRefusesAtTheLimitsOfFloat) {
  VoxelGrid grid;
  std::size_t taken = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = extremeScan(random);
    taken += expectGridExact(grid, scan.points(), criticalTolerance(random, scan)) ? 1 : 0;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(taken, 100U);
}

TEST(VoxelGrid, IsExactOnClumpsAndPlanes) {
  VoxelGrid grid;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Point> points;
    const auto coordinate = [&](double size) { return static_cast<float>(random.between(-size, size)); };
    // Clumps far smaller than a cell, planes of many cells a tolerance or so apart, and dust between them.
    for (int clump = 0; clump < 8; ++clump) {
      const Point center{coordinate(3), coordinate(3), coordinate(3)};
      for (int i = 0; i < 20; ++i)
        points.push_back({center.x + coordinate(0.01), center.y + coordinate(0.01), center.z + coordinate(0.01)});
    }
    for (int plane = 0; plane < 3; ++plane)
      for (int i = 0; i < 60; ++i) points.push_back({coordinate(1), coordinate(1), 0.3F * static_cast<float>(plane)});
    for (int i = 0; i < 60; ++i) points.push_back({coordinate(3), coordinate(3), coordinate(3)});
    random.shuffle(points);
    for (const float tolerance : {0.001F, 0.1F, 0.2999F, 0.3F, 0.3001F, 1.0F, 30.0F})
      expectGridExact(grid, points, tolerance);
  }
}

// Neighbours in every direction, up to two cells apart along each axis, with the cell border at any position between.
TEST(VoxelGrid, FindsNeighboursInEveryDirection) {
  VoxelGrid grid;
  Random random(1);
  constexpr float kTolerance = 1.0F;
  for (int i = 0; i < 20000; ++i) {
    const Point first{0.1F, 0.1F, 0.1F};  // fixes the cells' origin for the other two
    const auto place = [&] { return static_cast<float>(random.between(20.0, 21.0)); };
    const Point a{place(), place(), place()};
    // Along an axis, a diagonal of a plane or of space, or anywhere: almost a tolerance away.
    const auto direction = [&] { return random.chance(0.4) ? 0.0 : random.chance(0.6) ? 1.0 : random.unit(); };
    double step[3] = {direction(), direction(), direction()};
    const double length = std::hypot(step[0], step[1], step[2]);
    if (length == 0) continue;
    for (double& s : step) s *= (random.chance(0.5) ? 1 : -1) * random.between(0.97, 1.02) / length;
    const Point b{a.x + static_cast<float>(step[0]), a.y + static_cast<float>(step[1]),
                  a.z + static_cast<float>(step[2])};
    expectGridExact(grid, {first, a, b}, kTolerance);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(VoxelGrid, PointsExactlyAtTheToleranceAreApart) {
  const std::vector<Point> row{{1, 1, 1}, {1.5F, 1, 1}, {2, 1, 1}};
  VoxelGrid grid;
  EXPECT_EQ(byNumber(grid.cluster(returnsOf(row), 0.5F)).size(), 3U);
  EXPECT_EQ(byNumber(grid.cluster(returnsOf(row), std::nextafter(0.5F, 1.0F))).size(), 1U);
}

TEST(VoxelGrid, UsesTheAbsoluteValueOfANegativeTolerance) {
  expectGridExact({{1, 1, 1}, {1.4F, 1, 1}, {2, 1, 1}}, -0.5F);
}

TEST(VoxelGrid, ToleranceThatJoinsNothingGivesSingletons) {
  // The last one is so small that its square is 0.
  for (const float tolerance : {0.0F, -0.0F, 1e-30F}) expectGridExact({{1, 1, 1}, {1, 1, 1}, {2, 1, 1}}, tolerance);
  VoxelGrid grid;
  EXPECT_EQ(byNumber(grid.cluster(returnsOf({{1, 1, 1}, {1, 1, 1}}), kNan)).size(), 2U);
}

TEST(VoxelGrid, JoinsDuplicates) {
  std::vector<Point> points;
  for (int i = 0; i < 300; ++i) points.push_back({1.0F + static_cast<float>(i % 3), 1, 1});
  expectGridExact(points, 0.001F);
  expectGridExact(points, 1.0F);
  expectGridExact(points, 1.001F);
}

TEST(VoxelGrid, AcceptsNoPointsAndOnePoint) {
  VoxelGrid grid;
  EXPECT_TRUE(grid.cluster({}, 0.5F).empty());
  EXPECT_EQ(grid.cluster({{1, 2, 3, 0}}, 0.5F).size(), 1U);
  EXPECT_TRUE(grid.cluster({}, 0.5F).empty());
  EXPECT_TRUE(grid.cluster({}, 0.0F).empty());
}

TEST(VoxelGrid, StartsEachScanAfresh) {
  VoxelGrid grid;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random, seed % 2 == 0 ? 400 : 15);
    std::vector<Point> points;
    for (const Point& p : scan.points())
      if (isValid(p)) points.push_back(p);
    const float tolerance = criticalTolerance(random, scan);
    if (mayRefuse(points, tolerance)) continue;
    VoxelGrid fresh;
    EXPECT_EQ(grid.cluster(returnsOf(points), tolerance), fresh.cluster(returnsOf(points), tolerance));
  }
}

TEST(VoxelGrid, RefusesMoreCellsThanItCanNumber) {
  VoxelGrid grid;
  const std::vector<Point> far{{-1e9F, -1e9F, -1e9F}, {1e9F, 1e9F, 1e9F}};
  EXPECT_THROW(grid.cluster(returnsOf(far), 0.001F), std::runtime_error);
  // Few enough along each axis, but 31 bits for each of three.
  EXPECT_THROW(grid.cluster(returnsOf({{0.1F, 0, 0}, {1e6F, 1e6F, 1e6F}}), 0.001F), std::runtime_error);
  // The next scan is clustered again.
  expectGridExact(grid, {{1, 1, 1}, {1.4F, 1, 1}, {2, 1, 1}}, 0.5F);
}

// One axis, so long that distinct cells at its near end are equal in double: refused or right.
TEST(VoxelGrid, SeparatesCellsOfALongAxis) {
  for (const float far : {-1e6F, -1e9F, -1e10F, -1e11F, -1e12F, -1e14F, -1e16F, -1e17F, -3e17F}) {
    SCOPED_TRACE(far);
    VoxelGrid grid;
    std::vector<Point> points{{far, 1, 1}};
    for (int i = 0; i < 40; ++i) points.push_back({1.1F * static_cast<float>(i), 1, 1});
    expectGridExact(grid, points, 1.0F);
    EXPECT_EQ(trueClusters(points, 1.0F).size(), 41U);
  }
}

// --- The paper's mask ----------------------------------------------------------------------------------------------

TEST(PaperMask, IsWhatAlgorithm2Says) {
  // By hand: asin (1 / 10) = 5.739 degrees; 6 steps of 1 degree, 3 lasers of 2 degrees.
  NeighborMask mask = getNeighborMask(10.0, 1.0, {1.0 * kDegree, 2.0 * kDegree});
  EXPECT_EQ(mask.sigma, 6U);
  EXPECT_EQ(mask.lambda, 3U);
  // asin (0.3 / 5) = 3.4398 degrees; an HDL-64E: 0.1728 and 0.4 degrees: 19.906 and 8.599.
  mask = getNeighborMask(5.0, 0.3, {0.1728 * kDegree, 0.4 * kDegree});
  EXPECT_EQ(mask.sigma, 20U);
  EXPECT_EQ(mask.lambda, 9U);
  // asin (1 / 2) = 30 degrees: 15.0003 steps of 1.99996, 5.00003 of 5.99996.
  mask = getNeighborMask(2.0, 1.0, {1.99996 * kDegree, 5.99996 * kDegree});
  EXPECT_EQ(mask.sigma, 16U);
  EXPECT_EQ(mask.lambda, 6U);
  // 14.9997 of 2.00004, 4.99997 of 6.00004.
  mask = getNeighborMask(2.0, 1.0, {2.00004 * kDegree, 6.00004 * kDegree});
  EXPECT_EQ(mask.sigma, 15U);
  EXPECT_EQ(mask.lambda, 5U);
  // Any angle, however small, takes a step.
  mask = getNeighborMask(1000.0, 0.001, {1.0 * kDegree, 2.0 * kDegree});
  EXPECT_EQ(mask.sigma, 1U);
  EXPECT_EQ(mask.lambda, 1U);
}

TEST(PaperMask, IsEverythingNearerThanEps) {
  constexpr std::size_t kEverything = std::size_t{1} << 31U;
  const NeighborMask mask = getNeighborMask(0.5, std::nextafter(0.5, 1.0), {1.0 * kDegree, 2.0 * kDegree});
  EXPECT_EQ(mask.sigma, kEverything);
  EXPECT_EQ(mask.lambda, kEverything);
  // At eps the arcsine is 90 degrees: 89.1 steps of 1.01 degrees, 44.1 of 2.04.
  const NeighborMask quarter = getNeighborMask(0.5, 0.5, {1.01 * kDegree, 2.04 * kDegree});
  EXPECT_EQ(quarter.sigma, 90U);
  EXPECT_EQ(quarter.lambda, 45U);
}

TEST(PaperMask, IsEverythingWhereRowsDoNotDiffer) {
  constexpr std::size_t kEverything = std::size_t{1} << 31U;
  EXPECT_EQ(getNeighborMask(10.0, 1.0, {1.0 * kDegree, 0.0}).lambda, kEverything);
  EXPECT_EQ(getNeighborMask(10.0, 0.0, {1.0 * kDegree, 0.0}).lambda, kEverything);  // 0 / 0
  EXPECT_EQ(getNeighborMask(10.0, 0.0, {1.0 * kDegree, 0.0}).sigma, 0U);
}

// --- The paper's Lisco ---------------------------------------------------------------------------------------------

/// M, step by step.
std::vector<Point> matrixOf(const Scan& scan) {
  std::vector<Point> matrix;
  for (std::size_t step = 0; step < scan.columns; ++step)
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      const lisco::Return& cell = scan.at(laser, step);
      matrix.push_back({cell.x, cell.y, cell.z});
    }
  return matrix;
}

double distanceOf(const Point& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

std::size_t apart(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

/// The pairs that the paper's method compares, by its definitions: p with the points in its mask in the same and the
/// steps before, and around the end of the rotation in the first steps.
class LiteralMask {
 public:
  LiteralMask(std::size_t lasers, std::size_t steps, const NominalSensor& sensor, float tolerance)
      : lasers_(lasers), steps_(steps), sensor_(sensor), eps_(std::fabs(static_cast<double>(tolerance))) {}

  /// \param p, q numbers of cells
  bool compares(const std::vector<Point>& matrix, std::size_t p, std::size_t q) const {
    const std::size_t p_step = p / lasers_;
    const std::size_t q_step = q / lasers_;
    if (p_step < q_step) return compares(matrix, q, p);
    const auto shows = [&](std::size_t from) {
      const double distance = distanceOf(matrix[from]);
      if (distance < eps_) return true;
      const double angle = std::asin(eps_ / distance);
      const std::size_t steps = p_step - q_step;
      return static_cast<double>(std::min(steps, steps_ - steps)) <= std::ceil(angle / sensor_.delta_alpha) &&
             static_cast<double>(apart(p % lasers_, q % lasers_)) <= std::ceil(angle / sensor_.delta_theta);
    };
    return shows(p) || (p_step == q_step && shows(q));
  }

 private:
  std::size_t lasers_, steps_;
  NominalSensor sensor_;
  double eps_;
};

/// Components of the points under these edges, point by point.
Clustering components(const std::vector<Point>& points,
                      const std::function<bool(std::size_t a, std::size_t b)>& joined) {
  std::vector<std::uint32_t> number_of(points.size(), PaperLisco::kNoCluster);
  for (std::uint32_t seed = 0; seed < points.size(); ++seed) {
    if (!isValid(points[seed]) || number_of[seed] != PaperLisco::kNoCluster) continue;
    std::vector<std::size_t> open{seed};
    number_of[seed] = seed;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (std::size_t other = 0; other < points.size(); ++other) {
        if (number_of[other] != PaperLisco::kNoCluster || !isValid(points[other]) || !joined(at, other)) continue;
        number_of[other] = seed;
        open.push_back(other);
      }
    }
  }
  return byNumber(number_of);
}

Clustering byThePaper(const Scan& scan, const NominalSensor& sensor, float tolerance) {
  PaperLisco paper;
  return byNumber(paper.cluster(returnsOf(matrixOf(scan)), scan.lasers, sensor, tolerance));
}

/// A rotation of a regular sensor near the horizon, as in the paper.
class RegularSensor {
 public:
  RegularSensor(std::size_t steps, std::size_t lasers, double delta_theta)
      : steps_(steps), lasers_(lasers), nominal_{2 * kPi / static_cast<double>(steps), delta_theta} {}

  const NominalSensor& nominal() const { return nominal_; }
  Scan empty() const { return Scan(steps_, lasers_); }
  Point at(std::size_t laser, std::size_t step, double distance) const {
    const double azimuth = nominal_.delta_alpha * static_cast<double>(step);
    const double elevation =
        nominal_.delta_theta * (static_cast<double>(lasers_ - 1) / 2.0 - static_cast<double>(laser));
    return {static_cast<float>(distance * std::cos(elevation) * std::cos(azimuth)),
            static_cast<float>(distance * std::cos(elevation) * std::sin(azimuth)),
            static_cast<float>(distance * std::sin(elevation))};
  }

 private:
  std::size_t steps_, lasers_;
  NominalSensor nominal_;
};

/// Compares the clusters with the oracle's, after checking that the mask covers all neighbours.
void expectPaperExact(const Scan& scan, const NominalSensor& sensor, float tolerance) {
  const std::vector<Point> matrix = matrixOf(scan);
  const LiteralMask mask(scan.lasers, scan.columns, sensor, tolerance);
  for (std::size_t p = 0; p < matrix.size(); ++p)
    for (std::size_t q = 0; q < p; ++q) {
      if (!isValid(matrix[p]) || !isValid(matrix[q]) || !areNeighbours(matrix[p], matrix[q], tolerance)) continue;
      ASSERT_TRUE(mask.compares(matrix, p, q)) << "the test's scan is not regular enough";
    }
  EXPECT_EQ(difference(trueClusters(matrix, tolerance), byThePaper(scan, sensor, tolerance)), "");
}

TEST(PaperLisco, IsExactOnRegularScans) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RegularSensor sensor(30 + random.below(90), 1 + random.below(5), random.between(0.3, 1.0) * kDegree);
    Scan scan = sensor.empty();
    // Objects of some columns, with the background behind them, drop-outs, and whole columns lost.
    std::size_t until = 0;
    double range = 0;
    for (std::size_t step = 0; step < scan.columns; ++step) {
      if (step >= until) {
        until = step + 1 + random.below(10);
        range = random.magnitude(0.2, 20.0);
      }
      if (random.chance(0.1)) continue;
      for (std::size_t laser = 0; laser < scan.lasers; ++laser)
        if (!random.chance(0.1)) scan.set(laser, step, sensor.at(laser, step, range * random.between(0.98, 1.02)));
    }
    for (const float tolerance : {0.05F, 0.3F, 1.0F, 3.0F}) expectPaperExact(scan, sensor.nominal(), tolerance);
    expectPaperExact(scan, sensor.nominal(), criticalTolerance(random, scan));
  }
}

// step    0     1  ...  34    35
//         a     b       c     d        one object, cut in two by the end of the rotation: b - a | d - c
TEST(PaperLisco, JoinsAcrossTheSeam) {
  const RegularSensor sensor(36, 2, 1.0 * kDegree);
  for (const std::size_t gap : {0, 1, 2}) {
    SCOPED_TRACE("gap " + std::to_string(gap));
    Scan scan = sensor.empty();
    for (const std::size_t step : {std::size_t{0}, std::size_t{1}, 34 - gap, 35 - gap})
      scan.set(step % 2, step, sensor.at(step % 2, step, 5.0));
    // 10 degrees at 5 m are 0.872 m, 20 degrees 1.737 m, 30 degrees 2.588 m.
    const float tolerance = 0.9F + 0.85F * static_cast<float>(gap);
    expectPaperExact(scan, sensor.nominal(), tolerance);
    EXPECT_EQ(byThePaper(scan, sensor.nominal(), tolerance).size(), 1U);
  }
  // Only the last step reaches the first one; without it there are two clusters.
  Scan scan = sensor.empty();
  for (const std::size_t step : {0, 1, 33, 34}) scan.set(0, step, sensor.at(0, step, 5.0));
  EXPECT_EQ(byThePaper(scan, sensor.nominal(), 0.9F).size(), 2U);
}

TEST(PaperLisco, ComparesPointsNearerThanEpsToTheSensorWithAll) {
  const RegularSensor sensor(36, 3, 1.0 * kDegree);
  Scan scan = sensor.empty();
  scan.set(0, 3, sensor.at(0, 3, 0.4));
  scan.set(2, 21, sensor.at(2, 21, 0.5));  // on the other side of the sensor, 0.9 m away
  scan.set(1, 12, sensor.at(1, 12, 1.5));  // sideways, and 1.6 m from both
  EXPECT_EQ(byThePaper(scan, sensor.nominal(), 1.0F).size(), 2U);
  expectPaperExact(scan, sensor.nominal(), 1.0F);
  EXPECT_EQ(byThePaper(scan, sensor.nominal(), 0.89F).size(), 3U);
}

TEST(PaperLisco, AcceptsEmptyColumnsAndScans) {
  const RegularSensor sensor(36, 2, 1.0 * kDegree);
  Scan scan = sensor.empty();
  EXPECT_TRUE(byThePaper(scan, sensor.nominal(), 1.0F).empty());
  scan.set(0, 7, {0, 0, 0});
  EXPECT_TRUE(byThePaper(scan, sensor.nominal(), 1.0F).empty());
  scan.set(1, 7, sensor.at(1, 7, 5.0));
  EXPECT_EQ(byThePaper(scan, sensor.nominal(), 1.0F).size(), 1U);
  PaperLisco paper;
  EXPECT_TRUE(paper.cluster({}, 4, sensor.nominal(), 1.0F).empty());
}

TEST(PaperLisco, ToleranceZeroGivesSingletons) {
  const RegularSensor sensor(36, 2, 1.0 * kDegree);
  Scan scan = sensor.empty();
  for (std::size_t step = 0; step < 36; ++step) scan.set(step % 2, step, {1, 2, 3});
  EXPECT_EQ(byThePaper(scan, sensor.nominal(), 0.0F).size(), 36U);
  EXPECT_EQ(byThePaper(scan, {0.1, 0.0}, 0.0F).size(), 36U);
  EXPECT_EQ(byThePaper(scan, sensor.nominal(), -0.5F).size(), 1U);
}

// --- Algorithm 4's four cases, on one laser whose mask covers everything -------------------------------------------

/// The cluster numbers of points on a line, one per step.
std::vector<std::uint32_t> onALine(const std::vector<double>& places) {
  std::vector<lisco::Return> matrix;
  for (const double place : places)
    matrix.push_back({10.0F, static_cast<float>(place), 0.0F, static_cast<std::uint32_t>(matrix.size())});
  PaperLisco paper;
  return paper.cluster(matrix, 1, {1e-6, 1e-6}, 1.0F);
}
using Numbers = std::vector<std::uint32_t>;

TEST(PaperLisco, StartsASubclusterNamedByItsEarlierPoint) {
  EXPECT_EQ(onALine({0, 5, 0.5}), Numbers({0, 1, 0}));
}

TEST(PaperLisco, JoinsTheNewPoint) {
  EXPECT_EQ(onALine({0, 0.5, 1.2}), Numbers({0, 0, 0}));
}

TEST(PaperLisco, JoinsTheOlderPoint) {
  // The last point joins the first two, then the third joins it.
  EXPECT_EQ(onALine({0, 0.5, 2.2, 1.3}), Numbers({0, 0, 0, 0}));
}

TEST(PaperLisco, MergesTheSmallerIntoTheLarger) {
  // The last point lies between the two subclusters and is compared with the earlier one first.
  EXPECT_EQ(onALine({0, 0.5, 1.0, 2.5, 3.0, 1.8}), Numbers({0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(onALine({0, 0.5, 2.0, 2.5, 3.0, 3.5, 1.3}), Numbers({2, 2, 2, 2, 2, 2, 2}));
}

TEST(PaperLisco, MergesSubclustersOfManyArrays) {
  for (const int larger : {0, 1, 2}) {
    std::vector<double> places;
    for (int cluster = 0; cluster < 3; ++cluster)
      for (int i = 0; i < (cluster == larger ? 300 : 130 + cluster); ++i) places.push_back(3.0 * cluster + 0.002 * i);
    for (const double bridge : {1.5, 0.8, 2.3, 4.5, 3.8, 5.3}) places.push_back(bridge);
    EXPECT_EQ(byNumber(onALine(places)).size(), 1U);
  }
}

TEST(PaperLisco, StartsEachScanAfresh) {
  PaperLisco paper;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random, seed % 2 == 0 ? 300 : 15);
    const float tolerance = criticalTolerance(random, scan);
    const auto matrix = returnsOf(matrixOf(scan));
    PaperLisco fresh;
    EXPECT_EQ(paper.cluster(matrix, scan.lasers, {0.05, 0.05}, tolerance),
              fresh.cluster(matrix, scan.lasers, {0.05, 0.05}, tolerance));
  }
}

// On any scan: the components of the pairs that the mask covers.
void expectWhatTheMaskShows(const Scan& scan, const NominalSensor& sensor, float tolerance) {
  const std::vector<Point> matrix = matrixOf(scan);
  const LiteralMask mask(scan.lasers, scan.columns, sensor, tolerance);
  const Clustering expected = components(matrix, [&](std::size_t a, std::size_t b) {
    return areNeighbours(matrix[a], matrix[b], tolerance) && mask.compares(matrix, a, b);
  });
  const Clustering found = byThePaper(scan, sensor, tolerance);
  EXPECT_EQ(difference(expected, found), "") << "tolerance " << tolerance;
  // Each cluster lies in one of the true ones.
  std::map<std::uint32_t, std::size_t> true_cluster;
  const Clustering right = trueClusters(matrix, tolerance);
  for (std::size_t i = 0; i < right.size(); ++i)
    for (const std::uint32_t member : right[i].members) true_cluster[member] = i;
  for (const Cluster& cluster : found)
    for (const std::uint32_t member : cluster.members)
      EXPECT_EQ(true_cluster.at(member), true_cluster.at(cluster.members.front()));
}

NominalSensor someSensor(Random& random, std::size_t steps) {
  return {random.chance(0.5) ? 2 * kPi / static_cast<double>(steps) : random.magnitude(1e-3, 0.5),
          random.chance(0.1) ? 0.0 : random.magnitude(1e-3, 0.5)};
}

TEST(PaperLisco, MissesExactlyWhatItsMaskMisses) {
  std::size_t wrong = 0;
  constexpr std::uint64_t kScans = 1500;
  for (std::uint64_t seed = 0; seed < kScans; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random, 100);
    const NominalSensor sensor = someSensor(random, scan.columns);
    const float tolerance = criticalTolerance(random, scan);
    expectWhatTheMaskShows(scan, sensor, tolerance);
    wrong += difference(trueClusters(matrixOf(scan), tolerance), byThePaper(scan, sensor, tolerance)).empty() ? 0 : 1;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(wrong, kScans / 50);  // and it misses some
}

TEST(PaperLisco, MissesNothingElseAtTheLimitsOfFloat) {
  std::size_t taken = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = extremeScan(random);
    // p_d is a float.
    const std::vector<Point> points = scan.points();
    const auto too_far = [](const Point& p) { return isValid(p) && distanceOf(p) > std::numeric_limits<float>::max(); };
    if (std::any_of(points.begin(), points.end(), too_far)) continue;
    ++taken;
    expectWhatTheMaskShows(scan, someSensor(random, scan.columns), criticalTolerance(random, scan));
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(taken, 500U);
}

// Two returns behind one another, apart by the tolerance up to the last bits.
TEST(PaperLisco, FindsNeighboursDespiteRoundedRanges) {
  Random random(1);
  std::size_t neighbours = 0;
  for (int i = 0; i < 20000; ++i) {
    const double azimuth = random.between(0, 2 * kPi);
    const double elevation = random.between(-0.5, 0.5);
    const double range = random.between(5, 50);
    constexpr float kTolerance = 0.3F;
    const auto at = [&](double distance) -> Point {
      return {static_cast<float>(distance * std::cos(elevation) * std::cos(azimuth)),
              static_cast<float>(distance * std::cos(elevation) * std::sin(azimuth)),
              static_cast<float>(distance * std::sin(elevation))};
    };
    Scan scan(1, 2);
    scan.set(0, 0, at(range));
    scan.set(1, 0, at(range + 0.3));
    if (!areNeighbours(at(range), at(range + 0.3), kTolerance)) continue;
    ++neighbours;
    EXPECT_EQ(byThePaper(scan, {0.1, 0.1}, kTolerance).size(), 1U);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(neighbours, 5000U);
}

// --- The neighbours that the paper's mask misses --------------------------------------------------------------------

Point polar(double distance, double azimuth, double elevation) {
  return {static_cast<float>(distance * std::cos(elevation * kDegree) * std::cos(azimuth * kDegree)),
          static_cast<float>(distance * std::cos(elevation * kDegree) * std::sin(azimuth * kDegree)),
          static_cast<float>(distance * std::sin(elevation * kDegree))};
}

struct Cell {
  std::size_t laser, step;
};

struct Counterexample {
  const char* why;
  std::size_t steps, lasers;
  NominalSensor sensor;
  float eps;
  Cell p;
  Point at_p;
  Cell q;
  Point at_q;
  Cell q_regular;  ///< where q would be in the mask
};

const std::vector<Counterexample>& counterexamples() {
  static const std::vector<Counterexample> all{
      {"60 degrees up, azimuths 10 steps apart lie within eps, but sigma is 6: it takes d for the horizontal distance",
       360,
       32,
       {1 * kDegree, 2 * kDegree},
       1.0F,
       {3, 100},
       polar(10, 100, 60),
       {3, 110},
       polar(10, 110, 60),
       {3, 106}},
      {"at the zenith a whole turn lies within eps, and sigma is still 6",
       360,
       32,
       {1 * kDegree, 2 * kDegree},
       1.0F,
       {0, 10},
       polar(10, 10, 89),
       {0, 190},
       polar(10, 190, 89),
       {0, 4}},
      {"a capture of 380 degrees sees one place twice, 360 steps apart, and the mask wraps around at 380",
       380,
       4,
       {1 * kDegree, 2 * kDegree},
       0.5F,
       {1, 10},
       polar(10, 10, 0),
       {1, 370},
       polar(10.01, 370, 0),
       {1, 7}},
      {"3 columns came twice before the seam: 6 degrees are 9 steps, and sigma is 7",
       363,
       4,
       {1 * kDegree, 2 * kDegree},
       1.05F,
       {1, 356},
       polar(10, 356, 0),
       {1, 2},
       polar(10, 2, 0),
       {1, 0}},
      {"laser 1 lags by 12 columns behind laser 0 above it, and sigma is 6",
       720,
       2,
       {0.5 * kDegree, 1 * kDegree},
       0.5F,
       {0, 300},
       polar(10, 150, 0),
       {1, 312},
       polar(10, 150, -1),
       {1, 306}},
      {"the next lower row comes 7 rows later, and lambda is 3",
       360,
       8,
       {1 * kDegree, 1 * kDegree},
       0.5F,
       {0, 50},
       polar(10, 50, 0),
       {7, 50},
       polar(10, 50, -1),
       {3, 50}}};
  return all;
}

TEST(PaperLisco, MissesTheCounterexamples) {
  for (const Counterexample& example : counterexamples()) {
    SCOPED_TRACE(example.why);
    Scan scan(example.steps, example.lasers);
    scan.set(example.p.laser, example.p.step, example.at_p);
    scan.set(example.q.laser, example.q.step, example.at_q);
    EXPECT_EQ(trueClusters(matrixOf(scan), example.eps).size(), 1U);
    EXPECT_EQ(byThePaper(scan, example.sensor, example.eps).size(), 2U);
    VoxelGrid grid;
    EXPECT_TRUE(expectGridExact(grid, matrixOf(scan), example.eps));
  }
}

// The same two returns at the end of the mask.
TEST(PaperLisco, JoinsTheCounterexamplesWhereItsMaskEnds) {
  for (const Counterexample& example : counterexamples()) {
    SCOPED_TRACE(example.why);
    Scan scan(example.steps, example.lasers);
    scan.set(example.p.laser, example.p.step, example.at_p);
    scan.set(example.q_regular.laser, example.q_regular.step, example.at_q);
    EXPECT_EQ(byThePaper(scan, example.sensor, example.eps).size(), 1U);
  }
}

}  // namespace
}  // namespace lisco_test
