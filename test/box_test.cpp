// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// What a box decides about its points, it decides exactly, without a margin.
#include "lisco/box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "lisco/shelf.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

using lisco::Box;

struct Group {
  std::vector<Point> points;
  Box box;
};

/// A few points around a place, all of about one size: from denormals to where squares overflow.
Group randomGroup(Random& random, double scale) {
  Group group;
  const std::array<double, 3> centre{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  const double spread = random.magnitude(1e-6, 1.0);
  for (std::size_t i = 0; i < 1 + random.below(6); ++i) {
    const auto coordinate = [&](std::size_t axis) {
      return static_cast<float>(scale * (centre[axis] + spread * random.between(-1.0, 1.0)));
    };
    const Point p{coordinate(0), coordinate(1), coordinate(2)};
    if (i == 0)
      group.box = Box::around(p.x, p.y, p.z);
    else
      group.box.add(Box::around(p.x, p.y, p.z));
    group.points.push_back(p);
  }
  return group;
}

float squaredDistance(const Point& a, const Point& b) {
  return lisco::squaredDistance(a.x - b.x, a.y - b.y, a.z - b.z);
}

TEST(Box, GapIsNeverMoreAndSpanNeverLessThanAnyDistance) {
  Random random(1);
  const std::array<double, 6> scales{1.0, 1e30, 1.5e38, 1e-20, 1e-38, 1e-43};
  for (int i = 0; i < 30000; ++i) {
    const double scale = random.oneOf(scales);
    const Group a = randomGroup(random, scale);
    const Group b = random.chance(0.1) ? a : randomGroup(random, scale);
    for (const Point& p : a.points)
      for (const Point& q : b.points) {
        ASSERT_LE(Box::squaredGap(a.box, b.box), squaredDistance(p, q)) << i;
        ASSERT_GE(Box::squaredSpan(a.box, b.box), squaredDistance(p, q)) << i;
      }
    for (const Group* group : {&a, &b})
      for (const Point& p : group->points)
        for (const Point& q : group->points) ASSERT_GE(Box::squaredSpan(a.box, b.box), squaredDistance(p, q)) << i;
    ASSERT_EQ(Box::squaredGap(a.box, b.box), Box::squaredGap(b.box, a.box));
  }
}

TEST(Box, OfSinglePointsIsTheirDistance) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.between(-10.0, 10.0)); };
    const Point p{coordinate(), coordinate(), coordinate()};
    const Point q{coordinate(), coordinate(), coordinate()};
    const Box a = Box::around(p.x, p.y, p.z);
    const Box b = Box::around(q.x, q.y, q.z);
    ASSERT_EQ(Box::squaredGap(a, b), squaredDistance(p, q));
    ASSERT_EQ(Box::squaredSpan(a, b), squaredDistance(p, q));
  }
}

// Four boxes at once say what each says alone, bit for bit: a vector unit must not round otherwise.
TEST(Shelf, DecidesAsItsBoxesDo) {
  Random random(3);
  const std::array<double, 5> scales{1.0, 1e30, 1.5e38, 1e-20, 1e-38};
  int near = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = random.oneOf(scales);
    lisco::Shelf shelf = lisco::Shelf::empty(7);
    EXPECT_EQ(shelf.next_in_tile, 7U);
    const std::size_t count = random.below(lisco::Shelf::kPlaces + 1);
    std::vector<Group> groups;
    for (std::uint32_t place = 0; place < count; ++place) {
      groups.push_back(randomGroup(random, scale));
      shelf.add(100 + place, groups.back().box);
    }
    EXPECT_EQ(shelf.full(), count == lisco::Shelf::kPlaces);
    const Group group = randomGroup(random, scale);
    float squared = static_cast<float>(random.unit() * scale * scale);
    if (count > 0 && random.chance(0.7)) squared = Box::squaredGap(random.oneOf(groups).box, group.box);
    if (random.chance(0.3)) squared = std::nextafter(squared, std::numeric_limits<float>::infinity());
    const std::uint32_t places = shelf.placesNear(group.box, squared);
    for (std::uint32_t place = 0; place < lisco::Shelf::kPlaces; ++place) {
      const bool expected = place < count && Box::squaredGap(groups[place].box, group.box) < squared;
      ASSERT_EQ((places >> place & 1U) != 0, expected) << i;
      near += expected ? 1 : 0;
    }
    ASSERT_LT(places, 16U);
  }
  EXPECT_GT(near, 1000);
}

}  // namespace
}  // namespace lisco_test
