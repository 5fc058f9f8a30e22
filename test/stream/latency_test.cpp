// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/latency.h"

#include <gtest/gtest.h>

#include <chrono>

namespace lisco_test {
namespace {

using lisco_apps::Latency;

TEST(Latency, IsZeroWithoutTimes) {
  EXPECT_EQ(Latency().percentileMs(0.5), 0);
  EXPECT_EQ(Latency().maxMs(), 0);
}

TEST(Latency, GivesPercentilesToTwoPercent) {
  Latency latency;
  for (int us = 1; us <= 10000; ++us) latency.add(std::chrono::microseconds(us));
  EXPECT_EQ(latency.count(), 10000U);
  EXPECT_NEAR(latency.percentileMs(0.01), 0.1, 0.002);
  EXPECT_NEAR(latency.percentileMs(0.5), 5, 0.1);
  EXPECT_NEAR(latency.percentileMs(0.99), 9.9, 0.2);
  EXPECT_EQ(latency.percentileMs(1), 10);
  EXPECT_EQ(latency.maxMs(), 10);
}

TEST(Latency, AcceptsAnyDuration) {
  Latency latency;
  latency.add(std::chrono::nanoseconds(-5));
  latency.add(std::chrono::nanoseconds(0));
  latency.add(std::chrono::hours(100000));
  EXPECT_NEAR(latency.percentileMs(0.5), 1e-6, 1e-7);
  EXPECT_EQ(latency.maxMs(), 3.6e11);
}

}  // namespace
}  // namespace lisco_test
