// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/rotation_cutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "random.h"

namespace lisco_test {
namespace {

using lisco_apps::RotationCutter;

double wrapped(double degrees) {
  const double angle = std::fmod(degrees, 360.);
  return angle < 0 ? angle + 360. : angle;
}

/// Number of the rotation of a column at this angle, which is not wrapped.
/// \param direction 1: clockwise, -1: counterclockwise
double rotationAt(double angle, double cut, double direction) {
  constexpr double kRounding = 1e-9;
  return std::floor(direction * (angle - cut) / 360 + kRounding);
}

/// Which of the columns at these azimuths start a rotation.
std::vector<std::size_t> startsAmong(RotationCutter cutter, const std::vector<double>& azimuths) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < azimuths.size(); ++i)
    if (cutter.startsRotation(wrapped(azimuths[i]))) starts.push_back(i);
  return starts;
}

TEST(RotationCutter, CutsWhereTheFirstColumnLies) {
  for (const double direction : {1., -1.}) {
    std::vector<double> azimuths;
    for (int i = 0; i < 4000; ++i) azimuths.push_back(123.45 + direction * 0.36 * i);  // exactly a turn in 1000
    EXPECT_EQ(startsAmong(RotationCutter(), azimuths), (std::vector<std::size_t>{0, 1000, 2000, 3000})) << direction;
  }
}

TEST(RotationCutter, CutsAtAnAngle) {
  for (const double direction : {1., -1.})
    for (const double cut : {0., 90., 80.36, 359.99, -270., 450.}) {
      RotationCutter cutter(cut);
      EXPECT_TRUE(cutter.startsRotation(80));
      for (int i = 1; i < 2500; ++i) {
        const double before = 80 + direction * 0.36 * (i - 1), now = before + direction * 0.36;
        EXPECT_EQ(cutter.startsRotation(wrapped(now)),
                  rotationAt(now, cut, direction) != rotationAt(before, cut, direction))
            << "cut at " << cut << ", turning " << direction << ", at " << now;
      }
    }
}

TEST(RotationCutter, AllowsStepsBack) {
  constexpr std::uint64_t kSeed = 5;
  Random random(kSeed);
  for (int run = 0; run < 200; ++run) {
    const double direction = random.chance(0.5) ? 1 : -1;
    const double step = random.between(0.1, 0.8);
    const double start = random.between(0, 360);
    RotationCutter cutter = random.chance(0.5) ? RotationCutter() : RotationCutter(start + direction * 200);
    std::vector<double> azimuths;
    for (double turned = 0; turned < 5 * 360; turned += step)
      azimuths.push_back(start + direction * (turned + random.between(-1.5, 1.5) * step));
    const std::vector<std::size_t> starts = startsAmong(cutter, azimuths);
    ASSERT_GE(starts.size(), 5U) << "seed " << kSeed << ", run " << run;
    EXPECT_LE(starts.size(), 6U);
    for (std::size_t i = 2; i < starts.size(); ++i)
      EXPECT_NEAR(static_cast<double>(starts[i] - starts[i - 1]), 360 / step, 4) << "seed " << kSeed << ", run " << run;
  }
}

TEST(RotationCutter, AllowsMissingColumns) {
  constexpr std::uint64_t kSeed = 6;
  Random random(kSeed);
  for (int run = 0; run < 200; ++run) {
    const double direction = random.chance(0.5) ? 1 : -1;
    RotationCutter cutter(0.);
    double angle = direction * 100;
    for (int i = 0; i < 2000; ++i) {
      const double before = angle;
      // The first columns establish the direction of turning.
      angle += direction * (i > 20 && random.chance(0.01) ? random.between(0, 349) : 0.2);
      const bool starts = i == 0 || rotationAt(angle, 0, direction) != rotationAt(before, 0, direction);
      EXPECT_EQ(cutter.startsRotation(wrapped(angle)), starts)
          << "seed " << kSeed << ", run " << run << ": from " << before << " to " << angle;
    }
  }
}

TEST(RotationCutter, StartsARotationAfterABreak) {
  for (const double direction : {1., -1.}) {
    RotationCutter cutter;
    EXPECT_TRUE(cutter.startsRotation(0));
    EXPECT_FALSE(cutter.startsRotation(wrapped(direction)));
    EXPECT_TRUE(cutter.startsRotation(wrapped(2 * direction), true));
    EXPECT_FALSE(cutter.startsRotation(wrapped(200 * direction)));
    EXPECT_FALSE(cutter.startsRotation(wrapped(359 * direction)));
    EXPECT_TRUE(cutter.startsRotation(0)) << "the cut does not move";
  }
}

TEST(RotationCutter, KeepsTheRotationWhileTheSensorStandsStill) {
  RotationCutter cutter;
  EXPECT_TRUE(cutter.startsRotation(359.99));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(cutter.startsRotation(i % 2 == 0 ? 0. : 359.99));
}

}  // namespace
}  // namespace lisco_test
