// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// When a cloud gets hints, and of which sensor.
#include "lisco/sensor_hints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

lisco::SensorHints estimate(const Scan& scan, const Origin& sensor = kHere) {
  const auto cell_at = [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); };
  return lisco::estimateSensor(scan.columns, scan.lasers, sensor, lisco::CellSource(cell_at));
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

TEST(SensorEstimator, GivesNoHintsForDistantClouds) {
  EXPECT_TRUE(isUnknown(estimate(rotation({10000.0F, 0.0F, 0.0F}))));
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
    EXPECT_TRUE(isUnknown(estimate(rotation({10000.0F, 0.0F, 0.0F}), sensor)));
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
