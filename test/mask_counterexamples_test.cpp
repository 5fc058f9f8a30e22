// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Neighbours that the paper's mask (Algorithm 2), taken literally, misses, and that Lisco must join.
//
// The literal mask of a return at distance d: sigma = ceil(asin(eps/d)/dAlpha) steps to either side and
// lambda = ceil(asin(eps/d)/dTheta) lasers up and down, with the nominal dAlpha and dTheta of the sensor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "engine.h"
#include "oracle.h"
#include "scans.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;

struct Cell {
  std::size_t laser, step;
};

/// What Algorithm 2 is given of a sensor.
struct NominalSensor {
  std::size_t steps;
  double delta_alpha, delta_theta;
};

/// Whether q's cell is within the literal mask of p, whose steps wrap around at the end of the rotation.
bool literalMaskShows(const NominalSensor& sensor, double p_distance, double eps, const Cell& p, const Cell& q) {
  const double angle = std::fabs(std::asin(eps / p_distance));
  const auto sigma = static_cast<std::size_t>(std::ceil(angle / sensor.delta_alpha));
  const auto lambda = static_cast<std::size_t>(std::ceil(angle / sensor.delta_theta));
  const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  const std::size_t steps = apart(p.step, q.step);
  return std::min(steps, sensor.steps - steps) <= sigma && apart(p.laser, q.laser) <= lambda;
}

Point polar(double distance, double azimuth, double elevation) {
  return {static_cast<float>(distance * std::cos(elevation) * std::cos(azimuth)),
          static_cast<float>(distance * std::cos(elevation) * std::sin(azimuth)),
          static_cast<float>(distance * std::sin(elevation))};
}

double distanceOf(const Point& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

/// A rotation with only these two returns: neighbours, not in each other's literal mask, and one cluster.
void expectMissedByTheLiteralMaskOnly(const NominalSensor& sensor, std::size_t lasers, float eps, const Cell& p,
                                      const Point& at_p, const Cell& q, const Point& at_q) {
  EXPECT_TRUE(areNeighbours(at_p, at_q, eps));
  EXPECT_FALSE(literalMaskShows(sensor, distanceOf(at_p), static_cast<double>(eps), p, q));
  EXPECT_FALSE(literalMaskShows(sensor, distanceOf(at_q), static_cast<double>(eps), q, p));
  Scan scan(sensor.steps, lasers);
  scan.set(p.laser, p.step, at_p);
  scan.set(q.laser, q.step, at_q);
  lisco::ColumnClusterer clusterer;
  expectExact(clusterer, scan, eps);
  for (const Setting& setting : allSettings())
    EXPECT_EQ(cluster(clusterer, scan, eps, setting).size(), 1U) << setting.name;
}

// (a) Off the horizon, steps lie closer together than the distance d suggests: at elevation e, two returns at one
// distance d and azimuths A apart are only 2 d cos(e) sin(A/2) from each other. asin(eps/d) bounds the angle
// between the rays; the angle between their azimuths is bounded by asin(eps/rho).
//
//   from above:   q   p         from the side:        p
//                  \ / rho                           /|
//                   o                             d / |       at e = 60 degrees, rho is d/2:
//                                                  /e |       twice as many steps as sigma
//              A is wide                          o---+
//                                                  rho
TEST(MaskCounterexample, JoinsOffTheHorizon) {
  const NominalSensor sensor{360, 1.0 * kDegree, 2.0 * kDegree};
  constexpr double kDistance = 10.0;
  constexpr float kEps = 1.0F;  // sigma = ceil(5.74) = 6
  const double elevation = 60.0 * kDegree;
  expectMissedByTheLiteralMaskOnly(sensor, 32, kEps, {3, 100}, polar(kDistance, 100 * kDegree, elevation), {3, 110},
                                   polar(kDistance, 110 * kDegree, elevation));
}

// The same at the zenith, where a whole turn of steps may lie within eps.
TEST(MaskCounterexample, JoinsAcrossTheZenith) {
  const NominalSensor sensor{360, 1.0 * kDegree, 2.0 * kDegree};
  const double elevation = 89.0 * kDegree;
  expectMissedByTheLiteralMaskOnly(sensor, 32, 1.0F, {0, 10}, polar(10.0, 10 * kDegree, elevation), {0, 190},
                                   polar(10.0, 190 * kDegree, elevation));
}

// (b) The seam. The mask wraps around at S steps, but a capture is not S nominal steps: this one covers 380
// degrees, so its last columns repeat its first ones, S - 20 steps later.
//
//   step  0    10    20  ...  350   360   370   380 = S
//         |-----p-----|--------|-----|-----q-----|
//         azimuth 10                 azimuth 370 = 10:  the same place, but 360 steps from p, or 20 around
TEST(MaskCounterexample, JoinsAcrossTheSeamOfMoreThanATurn) {
  const NominalSensor sensor{380, 1.0 * kDegree, 2.0 * kDegree};
  expectMissedByTheLiteralMaskOnly(sensor, 4, 0.5F, {1, 10}, polar(10.0, 10 * kDegree, 0.0), {1, 370},
                                   polar(10.01, 370 * kDegree, 0.0));
}

// Repeated packets just before the seam: 3 columns come twice, so that steps no longer count degrees.
//
//   azimuth  356 357 357 358 358 359 359 | 0   1   2
//   step     356 357 358 359 360 361 362 | 0   1   2
//             p                                    q      6 degrees apart, but 9 columns; sigma = 7
TEST(MaskCounterexample, JoinsAcrossTheSeamWithRepeatedColumns) {
  const NominalSensor sensor{363, 1.0 * kDegree, 2.0 * kDegree};
  expectMissedByTheLiteralMaskOnly(sensor, 4, 1.05F, {1, 356}, polar(10.0, 356 * kDegree, 0.0), {1, 2},
                                   polar(10.0, 2 * kDegree, 0.0));
}

// (c) Staggered lasers: laser 1 fires when the sensor has turned by 6 more degrees, so a column holds several
// azimuths. Adjacent returns are 12 columns apart.
//
//   laser 0:   . . . . . . p . . . . . . . . . .
//   laser 1:   . . . . . . . . . . . . . . . . . . q      one below the other in the world:  p
//              columns ->                                                                     q
TEST(MaskCounterexample, JoinsStaggeredLasers) {
  const NominalSensor sensor{720, 0.5 * kDegree, 1.0 * kDegree};
  constexpr double kStagger = 6.0 * kDegree;
  constexpr std::size_t kColumn = 300;
  constexpr std::size_t kLag = 12;  // columns
  const auto azimuth = [&](const Cell& cell) {
    return sensor.delta_alpha * static_cast<double>(cell.step) - (cell.laser == 1 ? kStagger : 0.0);
  };
  const Cell p{0, kColumn};
  const Cell q{1, kColumn + kLag};
  ASSERT_NEAR(azimuth(p), azimuth(q), 1e-12);
  // eps 0.5 at 10 m: sigma = 6 columns.
  expectMissedByTheLiteralMaskOnly(sensor, 2, 0.5F, p, polar(10.0, azimuth(p), 0.0), q,
                                   polar(10.0, azimuth(q), -1.0 * kDegree));
}

// Rows in another order than their elevations: lambda counts rows.
//
//   row 0:  elevation  0 degrees   p
//   row 1:  elevation -8           .        lambda = 3 rows
//   row 2:  elevation -4           .
//   ...
//   row 7:  elevation -1           q  <- just below p
TEST(MaskCounterexample, JoinsUnsortedRows) {
  const NominalSensor sensor{360, 1.0 * kDegree, 1.0 * kDegree};
  expectMissedByTheLiteralMaskOnly(sensor, 8, 0.5F, {0, 50}, polar(10.0, 50 * kDegree, 0.0), {7, 50},
                                   polar(10.0, 50 * kDegree, -1.0 * kDegree));
}

// The literal mask covers ideal columns and rings.
TEST(MaskCounterexample, CoversAnIdealNeighbour) {
  const NominalSensor sensor{360, 1.0 * kDegree, 2.0 * kDegree};
  EXPECT_TRUE(literalMaskShows(sensor, 10.0, 1.0, {3, 100}, {3, 105}));
  EXPECT_TRUE(literalMaskShows(sensor, 10.0, 1.0, {3, 100}, {5, 95}));
  EXPECT_TRUE(literalMaskShows(sensor, 10.0, 1.0, {3, 358}, {3, 2}));
  EXPECT_FALSE(literalMaskShows(sensor, 10.0, 1.0, {3, 100}, {3, 107}));
  EXPECT_FALSE(literalMaskShows(sensor, 10.0, 1.0, {3, 100}, {7, 100}));
}

}  // namespace
}  // namespace lisco_test
