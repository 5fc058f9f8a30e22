// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/turn_position.h"

#include <gtest/gtest.h>

#include <optional>

namespace lisco_test {
namespace {

using lisco_apps::TurnPosition;

constexpr double kStep = 1. / 360;

TEST(TurnPosition, UnrollsTheAzimuth) {
  TurnPosition position;
  EXPECT_DOUBLE_EQ(position.next(350, std::nullopt, false), 350. / 360);
  for (int degree = 351; degree < 1500; ++degree)
    EXPECT_NEAR(position.next(degree % 360, kStep, false), degree / 360., 1e-12);
}

TEST(TurnPosition, IsUnchangedIfTheAzimuthStepsBack) {
  for (const std::optional<double> by_time : {std::optional<double>(kStep), std::optional<double>()}) {
    TurnPosition position;
    position.next(359, by_time, false);
    EXPECT_NEAR(position.next(1, by_time, false), 361. / 360, 1e-12);
    EXPECT_NEAR(position.next(359.5, by_time, false), 361. / 360, 1e-12);
    EXPECT_NEAR(position.next(0, by_time, false), 361. / 360, 1e-12);
    EXPECT_NEAR(position.next(2, by_time, false), 362. / 360, 1e-12);
  }
}

TEST(TurnPosition, SkipsMissingTurns) {
  TurnPosition position;
  position.next(10, kStep, false);
  EXPECT_NEAR(position.next(280, 0.74, false), 280. / 360, 1e-12);
  EXPECT_NEAR(position.next(275, 0.98, false), 1 + 275. / 360, 1e-12);
  EXPECT_NEAR(position.next(100, 3.52, false), 5 + 100. / 360, 1e-12);  // 3 1/2 turns, by time
}

TEST(TurnPosition, AdvancesAtLeastATurnAfterABreak) {
  TurnPosition position;
  position.next(100, kStep, false);
  EXPECT_NEAR(position.next(110, std::nullopt, true), 1 + 110. / 360, 1e-12);
  EXPECT_NEAR(position.next(100, 0., true), 2 + 110. / 360 + 350. / 360, 1e-12);
  EXPECT_NEAR(position.next(100, 5.01, true), 8 + 100. / 360, 1e-12);
}

}  // namespace
}  // namespace lisco_test
