// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Tests of the oracle and the verifier: right clusterings pass, and both notice each kind of wrong one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "oracle.h"
#include "random.h"
#include "verifier.h"

namespace lisco_test {
namespace {

constexpr float kTolerance = 1.0F;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

//   0 1 2     3 4     5      6 is NaN, 7 is (0, 0, 0)
const std::vector<Point> kPoints{{1.0F, 1, 1}, {1.5F, 1, 1}, {2.0F, 1, 1},    {5.0F, 1, 1},
                                 {5.5F, 1, 1}, {9.0F, 1, 1}, {kNan, 1.0F, 1}, {0, 0, 0}};
const Clustering kRight{{{0, 1, 2}, 3}, {{3, 4}, 2}, {{5}, 1}};

void expectNoticed(const Clustering& wrong, const std::string& invariant) {
  EXPECT_NE(difference(trueClusters(kPoints, kTolerance), inOrder(wrong)), "") << invariant;
  const std::vector<std::string> found = violations(kPoints, wrong, kTolerance);
  ASSERT_FALSE(found.empty()) << invariant;
  for (const std::string& line : found) EXPECT_EQ(line.substr(0, line.find(':')), invariant) << line;
}

TEST(Oracle, FindsTheClusters) {
  EXPECT_EQ(difference(kRight, trueClusters(kPoints, kTolerance)), "");
  EXPECT_TRUE(violations(kPoints, kRight, kTolerance).empty());
}

TEST(Oracle, IgnoresOrder) {
  EXPECT_EQ(difference(kRight, inOrder({{{5}, 1}, {{4, 3}, 2}, {{2, 0, 1}, 3}})), "");
}

TEST(Oracle, SeparatesPointsAtTheTolerance) {
  EXPECT_FALSE(areNeighbours({1, 1, 1}, {1.5F, 1, 1}, 0.5F));
  EXPECT_TRUE(areNeighbours({1, 1, 1}, {1.5F, 1, 1}, std::nextafter(0.5F, 1.0F)));
  EXPECT_TRUE(areNeighbours({1, 1, 1}, {1, 1, 1}, -0.5F));
  EXPECT_FALSE(areNeighbours({1, 1, 1}, {1, 1, 1}, 0.0F));
  EXPECT_FALSE(areNeighbours({1, 1, 1}, {1, 1, 1}, kNan));
}

TEST(Verifier, NoticesMergedClusters) {
  expectNoticed({{{0, 1, 2, 3, 4}, 5}, {{5}, 1}}, "connectivity");
}

TEST(Verifier, NoticesASplitCluster) {
  expectNoticed({{{0, 1}, 2}, {{2}, 1}, {{3, 4}, 2}, {{5}, 1}}, "separation");
}

TEST(Verifier, NoticesAMissingPoint) {
  expectNoticed({{{0, 1, 2}, 3}, {{3, 4}, 2}}, "coverage");
}

TEST(Verifier, NoticesAnInvalidPoint) {
  expectNoticed({{{0, 1, 2}, 3}, {{3, 4}, 2}, {{5}, 1}, {{6}, 1}}, "coverage");
  expectNoticed({{{0, 1, 2}, 3}, {{3, 4}, 2}, {{5}, 1}, {{7}, 1}}, "coverage");
}

TEST(Verifier, NoticesANonexistentPoint) {
  expectNoticed({{{0, 1, 2}, 3}, {{3, 4}, 2}, {{5}, 1}, {{8}, 1}}, "coverage");
}

TEST(Verifier, NoticesAPointInTwoClusters) {
  expectNoticed({{{0, 1, 2}, 3}, {{3, 4}, 2}, {{5}, 1}, {{5}, 1}}, "coverage");
}

TEST(Verifier, NoticesAWrongSize) {
  expectNoticed({{{0, 1, 2}, 4}, {{3, 4}, 2}, {{5}, 1}}, "size");
}

TEST(Verifier, NoticesAnEmptyCluster) {
  expectNoticed({{{0, 1, 2}, 3}, {{3, 4}, 2}, {{5}, 1}, {{}, 0}}, "size");
}

// Two algorithms that share only the comparison of two points agree on random points, and on corrupted copies.
TEST(Verifier, AgreesWithTheOracleOnRandomPoints) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Point> points(2 + random.below(60));
    const auto coordinate = [&] { return static_cast<float>(random.between(1.0, 6.0)); };
    for (Point& point : points) point = {coordinate(), coordinate(), random.chance(0.1) ? kNan : coordinate()};
    const auto tolerance = static_cast<float>(random.between(0.0, 2.0));
    const Clustering right = trueClusters(points, tolerance);
    EXPECT_TRUE(violations(points, right, tolerance).empty());
    if (right.size() < 2) continue;
    Clustering merged = right;
    merged[0].members.insert(merged[0].members.end(), merged[1].members.begin(), merged[1].members.end());
    merged[0].reported_size += merged[1].reported_size;
    merged.erase(merged.begin() + 1);
    EXPECT_FALSE(violations(points, merged, tolerance).empty());
    EXPECT_NE(difference(right, inOrder(merged)), "");
  }
}

}  // namespace
}  // namespace lisco_test
