// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Whether a cloud gets a view, and from where it is seen.
#include "lisco/scan_survey.h"

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

lisco::Parameters survey(const Scan& scan, const Origin& sensor = kHere) {
  return lisco::surveyScan(scan.columns, scan.lasers, sensor,
                           [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); });
}

bool hasNoView(const lisco::Parameters& parameters) {
  return parameters.view.steps_per_turn == 0;
}

TEST(ScanSurvey, ARotationIsSeenFromItsSensor) {
  const lisco::Parameters parameters = survey(rotation());
  EXPECT_EQ(parameters.view.origin, kHere);
  EXPECT_EQ(parameters.view.steps_per_turn, static_cast<int>(kColumns));
  EXPECT_FALSE(parameters.view.clockwise);
  EXPECT_NEAR(parameters.view.far_distance, 10.0F, 0.1F);
  EXPECT_NEAR(parameters.view.elevation_step, 0.03F, 0.01F);
  EXPECT_EQ(parameters.expected_returns, kColumns * kLasers);
}

TEST(ScanSurvey, AnUnorganizedCloudIsNoView) {
  Scan scan = rotation();
  scan.columns *= scan.lasers;
  scan.lasers = 1;
  EXPECT_TRUE(hasNoView(survey(scan)));
  Random random(1);
  random.shuffle(scan.cells);
  EXPECT_TRUE(hasNoView(survey(scan)));
}

TEST(ScanSurvey, FromFarAwayThereIsNoView) {
  EXPECT_TRUE(hasNoView(survey(rotation({10000.0F, 0.0F, 0.0F}))));
}

TEST(ScanSurvey, ADisplacedSensorIsUsedIfTheCloudTells) {
  const Origin sensor{10000.0F, -500.0F, 30.0F};
  const lisco::Parameters parameters = survey(rotation(sensor), sensor);
  EXPECT_EQ(parameters.view.steps_per_turn, static_cast<int>(kColumns));
  EXPECT_EQ(parameters.view.origin, sensor);
}

TEST(ScanSurvey, ASensorThatIsNoNumberIsNotUsed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const Origin& sensor : {Origin{nan, nan, nan}, Origin{10000.0F, nan, 0.0F}, Origin{infinity, 0.0F, 0.0F}})
    EXPECT_TRUE(hasNoView(survey(rotation({10000.0F, 0.0F, 0.0F}), sensor)));
}

// As a sensor leaves them that measures at every other step: no return has another right beside it.
TEST(ScanSurvey, EveryOtherColumnIsEmpty) {
  const Scan full = rotation();
  Scan scan(1024, kLasers);  // all columns that are looked at are even ones
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; column += 2) {
      const lisco::Return& cell = full.at(laser, column);
      scan.set(laser, column, {cell.x, cell.y, cell.z});
    }
  const lisco::Parameters parameters = survey(scan);
  EXPECT_EQ(parameters.view.origin, kHere);
  EXPECT_GT(parameters.view.far_distance, 0.0F);
}

// Runs are as short where most returns have none beside them as where ranges jump.
TEST(ScanSurvey, ThinThingsAreRough) {
  Scan scan = rotation();
  EXPECT_LT(survey(scan).view.roughness, 0.1F);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 0; column < kColumns; ++column)
      if (column % 10 > 5) scan.set(laser, column, {0.0F, 0.0F, 0.0F});
  EXPECT_LT(survey(scan).view.roughness, 0.1F);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t column = 1; column < kColumns; column += 2) scan.set(laser, column, {0.0F, 0.0F, 0.0F});
  EXPECT_GT(survey(scan).view.roughness, 1e6F);
}

TEST(ScanSurvey, NothingToLookAt) {
  EXPECT_TRUE(hasNoView(survey(Scan(0, 4))));
  EXPECT_TRUE(hasNoView(survey(Scan(1, 1))));
  EXPECT_TRUE(hasNoView(survey(Scan(300, 16))));  // no returns
}

TEST(ScanSurvey, WithoutLasers) {
  EXPECT_TRUE(hasNoView(survey(Scan(0, 0))));
  EXPECT_TRUE(hasNoView(survey(Scan(4, 0))));
}

}  // namespace
}  // namespace lisco_test
