// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Which mask a cloud gets, and from where it is seen.
#include "lisco/scan_survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

using Mask = lisco::Parameters::Mask;
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

TEST(ScanSurvey, ARotationIsSeenFromItsSensor) {
  const lisco::Parameters parameters = survey(rotation());
  EXPECT_EQ(parameters.mask, Mask::kView);
  EXPECT_EQ(parameters.view.origin, kHere);
  EXPECT_NEAR(parameters.view.azimuth_step, 6.2832F / static_cast<float>(kColumns), 1e-4F);
  EXPECT_NEAR(parameters.view.elevation_step, 0.03F, 0.01F);
  EXPECT_EQ(parameters.expected_returns, kColumns * kLasers);
}

TEST(ScanSurvey, ShuffledPointsAreNoView) {
  Scan scan = rotation();
  Random random(1);
  random.shuffle(scan.cells);
  EXPECT_EQ(survey(scan).mask, Mask::kGrid);
  scan.columns *= scan.lasers;
  scan.lasers = 1;
  const lisco::Parameters unorganized = survey(scan);
  EXPECT_EQ(unorganized.mask, Mask::kGrid);
  EXPECT_EQ(unorganized.open_columns, std::numeric_limits<std::size_t>::max());
}

TEST(ScanSurvey, FromFarAwayThereIsNoView) {
  EXPECT_EQ(survey(rotation({10000.0F, 0.0F, 0.0F})).mask, Mask::kGrid);
}

TEST(ScanSurvey, ADisplacedSensorIsUsedIfTheCloudTells) {
  const Origin sensor{10000.0F, -500.0F, 30.0F};
  const lisco::Parameters parameters = survey(rotation(sensor), sensor);
  EXPECT_EQ(parameters.mask, Mask::kView);
  EXPECT_EQ(parameters.view.origin, sensor);
}

TEST(ScanSurvey, ASensorThatIsNoNumberIsNotUsed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const Origin& sensor : {Origin{nan, nan, nan}, Origin{10000.0F, nan, 0.0F}, Origin{infinity, 0.0F, 0.0F}})
    EXPECT_EQ(survey(rotation({10000.0F, 0.0F, 0.0F}), sensor).mask, Mask::kGrid);
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

TEST(ScanSurvey, NothingToLookAt) {
  EXPECT_EQ(survey(Scan(0, 4)).mask, Mask::kGrid);
  EXPECT_EQ(survey(Scan(1, 1)).mask, Mask::kGrid);
  EXPECT_EQ(survey(Scan(300, 16)).mask, Mask::kGrid);  // no returns
}

TEST(ScanSurvey, WithoutLasers) {
  EXPECT_EQ(survey(Scan(0, 0)).mask, Mask::kGrid);
  EXPECT_EQ(survey(Scan(4, 0)).mask, Mask::kGrid);
}

}  // namespace
}  // namespace lisco_test
