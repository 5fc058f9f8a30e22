// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/packet_order.h"

#include <gtest/gtest.h>

#include <vector>

namespace lisco_test {
namespace {

using lisco_apps::PacketOrder;
using Place = PacketOrder::Place;

constexpr double kPeriodUs = 552.96;
constexpr double kHourUs = 3600e6;

/// Times of packets, counted in periods since some time before the end of an hour.
std::vector<Place> placesOf(PacketOrder& order, const std::vector<double>& periods, double start_us = kHourUs - 2000) {
  std::vector<Place> places;
  for (const double period : periods) {
    double time_us = start_us + period * kPeriodUs;
    while (time_us >= kHourUs) time_us -= kHourUs;
    places.push_back(order.place(static_cast<std::uint32_t>(time_us), kPeriodUs));
  }
  return places;
}

TEST(PacketOrder, FollowsTheClockIntoTheNextHour) {
  PacketOrder order;
  for (const Place place : placesOf(order, {0, 1, 2, 3, 4, 5, 6, 7, 8})) EXPECT_EQ(place, Place::kNext);
  EXPECT_NEAR(order.gap(), kPeriodUs, 1);
  EXPECT_EQ(order.missing() + order.clockJumps(), 0U);
}

TEST(PacketOrder, CountsMissingPackets) {
  PacketOrder order;
  // Across the hour too, and as many as come in seconds.
  EXPECT_EQ(placesOf(order, {0, 1, 3, 4, 10, 5010, 5011}),
            (std::vector{Place::kNext, Place::kNext, Place::kAfterGap, Place::kNext, Place::kAfterGap, Place::kAfterGap,
                         Place::kNext}));
  EXPECT_EQ(order.missing(), 1U + 5U + 4999U);
}

TEST(PacketOrder, FindsLatePacketsAndCopies) {
  PacketOrder order;
  EXPECT_EQ(placesOf(order, {0, 1, 5, 3, 2, 4, 5, 6, 6, 7}),
            (std::vector{Place::kNext, Place::kNext, Place::kAfterGap, Place::kLate, Place::kLate, Place::kLate,
                         Place::kLate, Place::kNext, Place::kLate, Place::kNext}));
  EXPECT_EQ(order.missing(), 3U);
  EXPECT_EQ(order.clockJumps(), 0U);
}

TEST(PacketOrder, FollowsNumbersThatWrapAround) {
  PacketOrder order;
  const std::vector<std::uint32_t> numbers{4294967294U, 4294967295U, 0, 2, 1, 2, 3};
  std::vector<Place> places;
  for (const std::uint32_t number : numbers) places.push_back(order.placeByNumber(number, 1000 + 500 * number));
  EXPECT_EQ(places, (std::vector{Place::kNext, Place::kNext, Place::kNext, Place::kAfterGap, Place::kLate, Place::kLate,
                                 Place::kNext}));
  EXPECT_DOUBLE_EQ(order.gap(), 500);
  EXPECT_EQ(order.missing(), 1U);
  EXPECT_EQ(order.clockJumps(), 0U);
}

TEST(PacketOrder, DetectsAnotherRecordingByItsNumbers) {
  PacketOrder order;
  EXPECT_EQ(order.placeByNumber(5000, 1000), Place::kNext);
  for (unsigned i = 0; i < PacketOrder::kMaxLate; ++i) EXPECT_EQ(order.placeByNumber(i, 2000), Place::kLate);
  EXPECT_EQ(order.placeByNumber(PacketOrder::kMaxLate, 2000), Place::kNewClock);
  EXPECT_EQ(order.placeByNumber(PacketOrder::kMaxLate + 1, 2500), Place::kNext);
  EXPECT_EQ(order.placeByNumber(3000000, 3000), Place::kNewClock);
  EXPECT_EQ(order.placeByNumber(3000001, 3000 + PacketOrder::kMaxGapUs + 1), Place::kNewClock);
  EXPECT_EQ(order.placeByNumber(3000002, 3000 + PacketOrder::kMaxGapUs), Place::kNewClock);  // the clock goes back
  EXPECT_EQ(order.clockJumps(), 4U);
  EXPECT_EQ(order.missing(), 0U);
  EXPECT_DOUBLE_EQ(order.gap(), 0);
}

TEST(PacketOrder, DetectsAClockThatWasSet) {
  PacketOrder order;
  constexpr double kMinute = 60e6 / kPeriodUs;
  EXPECT_EQ(placesOf(order, {0, 1, kMinute, kMinute + 1, 2, 3}, 1e6),
            (std::vector{Place::kNext, Place::kNext, Place::kNewClock, Place::kNext, Place::kNewClock, Place::kNext}));
  EXPECT_EQ(order.clockJumps(), 2U);
  EXPECT_EQ(order.missing(), 0U);
}

TEST(PacketOrder, DetectsARestartedRecording) {
  PacketOrder order;
  std::vector<double> periods;
  for (int i = 0; i < 100; ++i) periods.push_back(i);
  placesOf(order, periods);
  const std::vector<Place> again = placesOf(order, periods);
  for (std::size_t i = 0; i < again.size(); ++i)
    EXPECT_EQ(again[i], i < 16 ? Place::kLate : i == 16 ? Place::kNewClock : Place::kNext) << i;
  EXPECT_EQ(order.clockJumps(), 1U);
}

TEST(PacketOrder, AcceptsAClockThatStands) {
  PacketOrder order;
  const std::vector<Place> places = placesOf(order, std::vector<double>(40, 3.));
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(places[i], i == 0 || i > 17 ? Place::kNext : i < 17 ? Place::kLate : Place::kNewClock) << i;
  EXPECT_EQ(placesOf(order, {4, 4, 5}), (std::vector{Place::kNext, Place::kLate, Place::kNext}));
  EXPECT_EQ(order.missing(), 0U);
}

TEST(PacketOrder, MeasuresTheUsualGap) {
  PacketOrder order;
  std::vector<double> periods;
  for (int i = 0; i < 20; ++i) periods.push_back(2.4 * i + (i > 5 ? 7 : 0));
  EXPECT_EQ(order.usualGap(), 0);
  placesOf(order, periods);
  EXPECT_NEAR(order.usualGap(), 2.4 * kPeriodUs, 1);
}

}  // namespace
}  // namespace lisco_test
