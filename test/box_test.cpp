// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Boxes decide exactly, without a margin.
#include "core/neighbour.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

using lisco::Box;

struct Group {
  std::vector<Point> points;
  Box box;
};

/// A few points around a position, all of about one size: from denormals to where squares overflow.
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

TEST(Box, GapAndSpanBoundEveryDistance) {
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

TEST(Box, GapAndSpanOfSinglePointsAreTheirDistance) {
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

}  // namespace
}  // namespace lisco_test
