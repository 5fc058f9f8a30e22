// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// When a cloud gets hints, and of which sensor.
#include "lisco/sensor_hints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

using Origin = std::array<float, 3>;

constexpr std::size_t kColumns = 900;
constexpr std::size_t kLasers = 16;
constexpr Origin kHere{0.0F, 0.0F, 0.0F};

/// A rotation within round walls.
Scan rotation(const Origin& sensor = kHere) {
  Scan scan(kColumns, kLasers);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double azimuth = 6.283185307179586 * static_cast<double>(column) / static_cast<double>(kColumns);
      scan.set(laser, column,
               {static_cast<float>(10.0 * std::cos(azimuth)) + sensor[0],
                static_cast<float>(10.0 * std::sin(azimuth)) + sensor[1],
                0.3F * (static_cast<float>(laser) - 8.0F) + sensor[2]});
    }
  return scan;
}

lisco::SensorHints estimate(const Scan& scan, const Origin& sensor = kHere, const lisco::SensorHints& former = {}) {
  const auto cell_at = [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); };
  return lisco::estimateSensor(scan.columns, scan.lasers, sensor, lisco::CellSource(cell_at), former);
}

bool isUnknown(const lisco::SensorHints& hints) {
  return hints.steps_per_turn == 0;
}

TEST(SensorEstimator, FindsTheSensorOfARotation) {
  const lisco::SensorHints hints = estimate(rotation());
  EXPECT_EQ(hints.origin, kHere);
  EXPECT_EQ(hints.steps_per_turn, static_cast<int>(kColumns));
  EXPECT_FALSE(hints.clockwise);
  EXPECT_NEAR(hints.far_distance, 10.0F, 0.1F);
  EXPECT_NEAR(hints.elevation_step, 0.03F, 0.01F);
}

TEST(SensorEstimator, GivesNoHintsForUnorganizedClouds) {
  Scan scan = rotation();
  scan.columns *= scan.lasers;
  scan.lasers = 1;
  EXPECT_TRUE(isUnknown(estimate(scan)));
  Random random(1);
  random.shuffle(scan.cells);
  EXPECT_TRUE(isUnknown(estimate(scan)));
}

/// The pose of a sensor in the frame of its cloud.
struct Mounting {
  std::array<double, 3> origin{};
  double pitch = 0;  ///< radians
};

/// A rotation in a hall with uneven walls and a floor.
/// \param wrong share of returns with a wrong range or height
Scan mountedRotation(const Mounting& mounting, double wrong = 0.0) {
  Random random(7);
  Scan scan(kColumns, kLasers);
  const double cosine = std::cos(mounting.pitch);
  const double sine = std::sin(mounting.pitch);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double azimuth = 6.283185307179586 * static_cast<double>(column) / static_cast<double>(kColumns);
      const double slope = 0.03 * (static_cast<double>(laser) - 10.0);
      double rho = 12.0 + 5.0 * std::sin(3.0 * azimuth) + 3.0 * std::sin(7.0 * azimuth);
      if (slope < 0) rho = std::min(rho, -1.8 / slope);
      if (random.chance(wrong)) rho *= random.between(0.3, 1.5);
      const double x = rho * std::cos(azimuth);
      const double z = rho * (slope + (random.chance(wrong) ? random.between(-0.1, 0.1) : 0.0));
      scan.set(laser, column,
               {static_cast<float>(mounting.origin[0] + cosine * x + sine * z),
                static_cast<float>(mounting.origin[1] + rho * std::sin(azimuth)),
                static_cast<float>(mounting.origin[2] - sine * x + cosine * z)});
    }
  return scan;
}

void expectFound(const Mounting& mounting, const lisco::SensorHints& hints, double metres) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(static_cast<double>(hints.origin[axis]), mounting.origin[axis], metres) << "axis " << axis;
  EXPECT_NEAR(static_cast<double>(hints.tilt[0]), -std::tan(mounting.pitch), 0.003);
  EXPECT_NEAR(static_cast<double>(hints.tilt[1]), 0.0, 0.003);
  EXPECT_NEAR(hints.steps_per_turn, static_cast<int>(kColumns), 2);
}

TEST(SensorEstimator, FindsTheSensorInTheFrameOfAVehicle) {
  for (const double pitch : {0.0, 0.01, -0.05})
    for (const double wrong : {0.0, 0.1}) {
      SCOPED_TRACE("pitch " + std::to_string(pitch) + ", wrong " + std::to_string(wrong));
      const Mounting mounting{{-2.5, 0.4, 1.7}, pitch};
      expectFound(mounting, estimate(mountedRotation(mounting, wrong)), 0.15);
      expectFound(mounting, estimate(mountedRotation(mounting, wrong), {50.0F, 0.0F, 0.0F}), 0.15);
    }
}

TEST(SensorEstimator, FindsTheSensorInMapCoordinates) {
  const Mounting mounting{{500000.0, 540000.0, 310.0}, 0.0};
  expectFound(mounting, estimate(mountedRotation(mounting)), 0.3);
}

// From the origin of the cloud, all returns of the ground have the slope 0.
TEST(SensorEstimator, FindsTheSensorAboveFlatGround) {
  for (const double above : {0.5, 1.8, 3.0}) {
    SCOPED_TRACE("above " + std::to_string(above));
    Random random(3);
    Scan scan(kColumns, kLasers);
    for (std::size_t laser = 0; laser < kLasers; ++laser)
      for (std::size_t column = 0; column < kColumns; ++column) {
        const double azimuth = 6.283185307179586 * static_cast<double>(column) / static_cast<double>(kColumns);
        const double slope = 0.03 * (static_cast<double>(laser) - 14.5);
        const bool is_ground = slope < 0 && -above / slope < 80;
        if (!is_ground && random.chance(0.5)) continue;
        const double rho = (is_ground ? -above / slope : 20.0) + random.between(-0.02, 0.02);
        scan.set(laser, column,
                 {static_cast<float>(1.2 + rho * std::cos(azimuth)), static_cast<float>(rho * std::sin(azimuth)),
                  static_cast<float>(above + rho * slope)});
      }
    const lisco::SensorHints hints = estimate(scan);
    expectFound({{1.2, 0.0, above}, 0.0}, hints, 0.1);
    expectFound({{1.2, 0.0, above}, 0.0}, estimate(scan, {1.2F, 0.0F, static_cast<float>(above)}), 0.001);
  }
}

TEST(SensorEstimator, KeepsTheFrameOfTheCloudBefore) {
  const Mounting mounting{{-2.5, 0.4, 1.7}, 0.01};
  const lisco::SensorHints first = estimate(mountedRotation(mounting, 0.1));
  EXPECT_GT(first.slope_spread, 0.0F);
  lisco::SensorHints former = first;
  former.origin[0] += 0.01F;  // as no estimate of the cloud itself
  for (int cloud = 0; cloud < 3; ++cloud) {
    const lisco::SensorHints hints = estimate(mountedRotation(mounting, 0.1), kHere, former);
    EXPECT_EQ(hints.origin, former.origin);
    EXPECT_EQ(hints.tilt, former.tilt);
    EXPECT_EQ(hints.slope_spread, former.slope_spread);
    EXPECT_EQ(hints.steps_per_turn, first.steps_per_turn);
    EXPECT_NEAR(hints.elevation_step, first.elevation_step, 1e-4F);
    former = hints;
  }
}

TEST(SensorEstimator, DropsAFrameThatDoesNotFit) {
  const Mounting before{{-2.5, 0.4, 1.7}, 0.0};
  const Mounting now{{1.0, -0.6, 0.9}, 0.02};
  expectFound(now, estimate(mountedRotation(now), kHere, estimate(mountedRotation(before))), 0.15);
  EXPECT_EQ(estimate(rotation(), kHere, estimate(mountedRotation(before))).origin, kHere);
  // One that no sensor may have, or that was measured on a cloud that fits nowhere.
  for (const float spread : {0.5F, 100.0F, std::numeric_limits<float>::infinity()}) {
    lisco::SensorHints former = estimate(mountedRotation(before));
    former.slope_spread = spread;
    for (const float x :
         {2.0F, 1e6F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
      former.origin[0] = x;
      expectFound(now, estimate(mountedRotation(now), kHere, former), 0.15);
    }
  }
}

TEST(SensorEstimator, KeepsAnExactOrigin) {
  EXPECT_EQ(estimate(mountedRotation({})).origin, kHere);
  EXPECT_EQ(estimate(mountedRotation({})).tilt, (std::array<float, 2>{0.0F, 0.0F}));
  EXPECT_EQ(estimate(mountedRotation({}, 0.1)).origin, kHere);
  const Origin declared{-2.5F, 0.5F, 1.75F};
  EXPECT_EQ(estimate(mountedRotation({{-2.5, 0.5, 1.75}, 0.0}), declared).origin, declared);
}

TEST(SensorEstimator, KeepsTheOriginUnlessAnotherIsClearlyBetter) {
  Scan scan(kColumns, kLasers);
  Random random(3);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; ++column)
      scan.set(laser, column,
               {static_cast<float>(random.between(-9.0, 9.0)), static_cast<float>(random.between(-9.0, 9.0)),
                static_cast<float>(random.between(-9.0, 9.0))});
  EXPECT_EQ(estimate(scan).origin, kHere);
  EXPECT_EQ(estimate(scan).tilt, (std::array<float, 2>{0.0F, 0.0F}));
}

TEST(SensorEstimator, FindsASensorFarFromTheOrigin) {
  const lisco::SensorHints hints = estimate(rotation({10000.0F, 0.0F, 0.0F}));
  EXPECT_EQ(hints.steps_per_turn, static_cast<int>(kColumns));
  EXPECT_NEAR(hints.origin[0], 10000.0F, 0.1F);
  EXPECT_NEAR(hints.origin[1], 0.0F, 0.1F);
}

TEST(SensorEstimator, UsesTheOriginGivenByTheCloud) {
  const Origin sensor{10000.0F, -500.0F, 30.0F};
  const lisco::SensorHints hints = estimate(rotation(sensor), sensor);
  EXPECT_EQ(hints.steps_per_turn, static_cast<int>(kColumns));
  EXPECT_EQ(hints.origin, sensor);
}

TEST(SensorEstimator, IgnoresANonFiniteOrigin) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const Origin& sensor : {Origin{nan, nan, nan}, Origin{10000.0F, nan, 0.0F}, Origin{infinity, 0.0F, 0.0F}})
    EXPECT_NEAR(estimate(rotation({10000.0F, 0.0F, 0.0F}), sensor).origin[0], 10000.0F, 0.1F);
}

TEST(SensorEstimator, MeasuresTheJitterOfAzimuths) {
  EXPECT_LT(estimate(rotation()).jitter, 0.01F);
  // Two returns per firing, in successive columns.
  Scan twice(2 * kColumns, kLasers);
  const Scan once = rotation();
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < twice.columns; ++column) {
      const lisco::Return& cell = once.at(laser, column / 2);
      twice.set(laser, column, {cell.x, cell.y, cell.z});
    }
  EXPECT_NEAR(estimate(twice).jitter, 1.0F, 0.01F);
  EXPECT_EQ(estimate(twice).steps_per_turn, static_cast<int>(2 * kColumns));
}

/// A rotation of a sensor that moves along x, in the frame of its start, between walls at two distances.
/// \param way in a rotation, metres
Scan movingRotation(double way) {
  Scan scan(kColumns, kLasers);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double part = static_cast<double>(column) / static_cast<double>(kColumns);
      const double azimuth = 6.283185307179586 * part;
      const double range = column % 100 < 50 ? 10.0 : 5.0;
      scan.set(
          laser, column,
          {static_cast<float>(range * std::cos(azimuth) + way * part), static_cast<float>(range * std::sin(azimuth)),
           0.03F * static_cast<float>(range) * (static_cast<float>(laser) - 8.0F)});
    }
  return scan;
}

TEST(SensorEstimator, MeasuresTheDriftOfAzimuths) {
  EXPECT_LT(estimate(movingRotation(0.0)).drift, 0.05F);
  const float slow = estimate(movingRotation(1.0)).drift;
  EXPECT_GT(slow, 1.0F);
  EXPECT_GT(estimate(movingRotation(3.0)).drift, slow);
}

// Rows in the order in which lasers fire, which is not that of their elevations. Of few lasers all are sampled, most of
// them twice; of many, some are.
TEST(SensorEstimator, MeasuresTheElevationStepOfUnsortedLasers) {
  for (const std::size_t lasers : {6U, 8U, 12U, 16U, 32U, 128U}) {
    SCOPED_TRACE(std::to_string(lasers) + " lasers");
    const auto stepWith = [&](const std::vector<std::size_t>& row_of) {
      Scan scan(kColumns, lasers);
      for (std::size_t laser = 0; laser < lasers; ++laser)
        for (std::size_t column = 0; column < kColumns; ++column) {
          const double azimuth = 6.283185307179586 * static_cast<double>(column) / static_cast<double>(kColumns);
          scan.set(row_of[laser], column,
                   {static_cast<float>(10.0 * std::cos(azimuth)), static_cast<float>(10.0 * std::sin(azimuth)),
                    0.1F * (static_cast<float>(laser) - 0.5F * static_cast<float>(lasers))});
        }
      const lisco::SensorHints hints = estimate(scan);
      EXPECT_EQ(hints.steps_per_turn, static_cast<int>(kColumns));
      return hints.elevation_step;
    };
    std::vector<std::size_t> row_of(lasers);
    std::iota(row_of.begin(), row_of.end(), std::size_t{0});
    EXPECT_NEAR(stepWith(row_of), 0.01F, 0.001F);
    for (std::size_t row = 0; row < lasers; ++row) row_of[(row % 2) * lasers / 2 + row / 2] = row;
    EXPECT_GT(stepWith(row_of), 0.005F);
    EXPECT_LT(stepWith(row_of), lasers < 16 ? 0.031F : 0.015F);
    Random random(1);
    for (int i = 0; i < 10; ++i) {
      random.shuffle(row_of);
      const float step = stepWith(row_of);
      EXPECT_GT(step, 0.003F);
      EXPECT_LT(step, 0.031F);
    }
  }
}

// As from a sensor that measures at every other step: no two returns are adjacent.
TEST(SensorEstimator, AcceptsEmptyEveryOtherColumn) {
  const Scan full = rotation();
  Scan scan(1024, kLasers);  // all columns that are sampled are even ones
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; column += 2) {
      const lisco::Return& cell = full.at(laser, column);
      scan.set(laser, column, {cell.x, cell.y, cell.z});
    }
  const lisco::SensorHints hints = estimate(scan);
  EXPECT_EQ(hints.origin, kHere);
  EXPECT_GT(hints.far_distance, 0.0F);
}

// Rows of second returns lie between those of the first ones, whichever of them are sampled.
TEST(SensorEstimator, FindsTheSensorWhereFewRaysHaveTwoReturns) {
  for (const std::size_t lasers : {16U, 20U, 32U, 40U, 64U, 128U}) {
    Scan scan(kColumns, 2 * lasers);
    for (std::size_t laser = 0; laser < lasers; ++laser)
      for (std::size_t column = 0; column < kColumns; ++column) {
        const double azimuth = 6.283185307179586 * static_cast<double>(column) / static_cast<double>(kColumns);
        const float x = static_cast<float>(10.0 * std::cos(azimuth)), y = static_cast<float>(10.0 * std::sin(azimuth));
        const float z = 0.1F * (static_cast<float>(laser) - 8.0F);
        scan.set(2 * laser, column, {x, y, z});
        if ((laser + column) % 30 == 0) scan.set(2 * laser + 1, column, {2.0F * x, 2.0F * y, 2.0F * z});
      }
    EXPECT_EQ(estimate(scan).steps_per_turn, static_cast<int>(kColumns)) << lasers;
  }
}

// Runs are as short where most returns are isolated as where ranges jump.
TEST(SensorEstimator, TakesThinObjectsForRough) {
  Scan scan = rotation();
  EXPECT_LT(estimate(scan).roughness, 0.1F);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; ++column)
      if (column % 10 > 5) scan.set(laser, column, {0.0F, 0.0F, 0.0F});
  EXPECT_LT(estimate(scan).roughness, 0.1F);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 1; column < kColumns; column += 2) scan.set(laser, column, {0.0F, 0.0F, 0.0F});
  EXPECT_GT(estimate(scan).roughness, 1e6F);
}

TEST(SensorEstimator, GivesNoHintsWithoutReturns) {
  EXPECT_TRUE(isUnknown(estimate(Scan(0, 4))));
  EXPECT_TRUE(isUnknown(estimate(Scan(1, 1))));
  EXPECT_TRUE(isUnknown(estimate(Scan(300, 16))));  // no returns
}

TEST(SensorEstimator, GivesNoHintsWithoutLasers) {
  EXPECT_TRUE(isUnknown(estimate(Scan(0, 0))));
  EXPECT_TRUE(isUnknown(estimate(Scan(4, 0))));
}

}  // namespace
}  // namespace lisco_test
