// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/neighbour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lisco/return.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

using lisco::Tolerance;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kDenormal = std::numeric_limits<float>::denorm_min();

TEST(Tolerance, JoinsNothingIfItsSquareIsZero) {
  for (const float metres : {0.0F, -0.0F, kNan, 1e-30F, -1e-30F, kDenormal, 1e-23F}) {
    EXPECT_FALSE(Tolerance(metres).joinsAnything()) << metres;
    EXPECT_EQ(Tolerance(metres).reach(), 0.0) << metres;
  }
}

TEST(Tolerance, IgnoresTheSign) {
  for (const float metres : {1e-20F, 0.1F, 0.4F, 1e10F, kInfinity}) {
    EXPECT_EQ(Tolerance(metres).squared(), Tolerance(-metres).squared());
    EXPECT_EQ(Tolerance(metres).reach(), Tolerance(-metres).reach());
    EXPECT_TRUE(Tolerance(-metres).joinsAnything());
  }
}

TEST(Tolerance, IsSquaredInDoubleThenRounded) {
  for (const float metres : {0.1F, 0.3F, 0.7F, 1e-20F, 3e19F, kInfinity}) {
    const double wide = static_cast<double>(metres);
    EXPECT_EQ(Tolerance(metres).squared(), static_cast<float>(wide * wide));
  }
  EXPECT_GT(Tolerance(4e-23F).squared(), 0.0F);  // a denormal
  EXPECT_EQ(Tolerance(1e30F).squared(), kInfinity);
}

// reach() bounds the true distance of all neighbours, also where squares under- or overflow.
TEST(Tolerance, ReachBoundsEveryNeighbour) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto metres = static_cast<float>(random.magnitude(1e-23, 1e20));
    const Tolerance tolerance(random.chance(0.1) ? kInfinity : metres);
    const auto coordinate = [&] { return static_cast<float>(random.between(-1.2, 1.2)) * metres; };
    const float dx = coordinate();
    const float dy = random.chance(0.5) ? 0.0F : coordinate();
    const float dz = random.chance(0.5) ? 0.0F : coordinate();
    if (!(lisco::squaredDistance(dx, dy, dz) < tolerance.squared())) continue;
    const double distance = std::hypot(static_cast<double>(dx), static_cast<double>(dy), static_cast<double>(dz));
    ASSERT_LE(distance, tolerance.reach()) << metres;
  }
}

// Squares near the least float lose bits, or all of them: neighbours by the test may be farther apart than eps.
TEST(Tolerance, ReachBoundsNeighboursWhoseSquaresUnderflow) {
  Random random(4);
  int further = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto metres = static_cast<float>(random.magnitude(3e-23, 3e-22));
    const Tolerance tolerance(metres);
    const auto coordinate = [&] { return static_cast<float>(random.between(-1.2, 1.2)) * metres; };
    const float dx = coordinate();
    const float dy = coordinate();
    const float dz = coordinate();
    if (!(lisco::squaredDistance(dx, dy, dz) < tolerance.squared())) continue;
    const double distance = std::hypot(static_cast<double>(dx), static_cast<double>(dy), static_cast<double>(dz));
    ASSERT_LE(distance, tolerance.reach()) << metres;
    further += distance > 1.00001 * static_cast<double>(metres) ? 1 : 0;
  }
  EXPECT_GT(further, 0);
}

TEST(Tolerance, ReachIsTightForNormalFloats) {
  for (const float metres : {1e-15F, 0.1F, 1.0F, 1e15F})
    EXPECT_LT(Tolerance(metres).reach(), 1.00001 * static_cast<double>(metres));
}

TEST(Tolerance, DistanceEqualsTheOracles) {
  Random random(2);
  int neighbours = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.between(-10.0, 10.0)); };
    const Point a{coordinate(), coordinate(), coordinate()};
    const Point b{coordinate(), coordinate(), coordinate()};
    const float d2 = lisco::squaredDistance(a.x - b.x, a.y - b.y, a.z - b.z);
    const float metres = std::sqrt(d2) * static_cast<float>(random.between(0.9999999, 1.0000001));
    const bool near = d2 < Tolerance(metres).squared();
    neighbours += near ? 1 : 0;
    ASSERT_EQ(near, areNeighbours(a, b, metres));
  }
  EXPECT_GT(neighbours, 2000);
}

TEST(Return, IsFiniteAndNotTheOrigin) {
  EXPECT_TRUE(lisco::isReturn(1, 2, 3));
  EXPECT_TRUE(lisco::isReturn(0, 0, kDenormal));
  EXPECT_TRUE(lisco::isReturn(std::numeric_limits<float>::max(), 0, 0));
  EXPECT_FALSE(lisco::isReturn(0, 0, 0));
  EXPECT_FALSE(lisco::isReturn(-0.0F, 0, -0.0F));
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_FALSE(lisco::isReturn(bad, 1, 1));
    EXPECT_FALSE(lisco::isReturn(1, bad, 1));
    EXPECT_FALSE(lisco::isReturn(1, 1, bad));
  }
}

}  // namespace
}  // namespace lisco_test
