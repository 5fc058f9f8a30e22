// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Features of made-up clusters; test/simulated_cars_test.cpp has simulated ones.
#include "lisco/cluster_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/convex_hull.h"

namespace lisco {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Points = std::vector<std::array<float, 3>>;

ClusterFeatures featuresOf(const Points& points, const std::array<float, 3>& origin = {}) {
  return clusterFeatures(points.data(), points.size(), sizeof points[0], origin);
}

/// The upright sides of a box around `center`, 5 cm between points.
Points boxSides(double length, double width, double height, double yaw, const std::array<double, 3>& center) {
  Points points;
  const auto add = [&](double a, double b, double z) {
    points.push_back({static_cast<float>(center[0] + a * std::cos(yaw) - b * std::sin(yaw)),
                      static_cast<float>(center[1] + a * std::sin(yaw) + b * std::cos(yaw)),
                      static_cast<float>(center[2] + z)});
  };
  for (const double z : {-height / 2, 0., height / 2}) {
    for (int i = 0; i <= 20; ++i) {
      const double share = i / 20. - 0.5;
      for (const double side : {-0.5, 0.5}) {
        add(share * length, side * width, z);
        add(side * length, share * width, z);
      }
    }
  }
  return points;
}

double difference(double yaw, double other) {
  return std::fabs(std::remainder(yaw - other, kPi));
}

TEST(ClusterFeatures, MeasuresABoxAtAnyYaw) {
  for (int degrees = -360; degrees <= 360; degrees += 7) {
    SCOPED_TRACE(degrees);
    const double yaw = degrees * kPi / 180;
    const Points points = boxSides(4.2, 1.7, 1.4, yaw, {12, -7, 0.5});
    const ClusterFeatures features = featuresOf(points);
    EXPECT_EQ(features.size, points.size());
    EXPECT_LT(difference(features.box.yaw, yaw), 1e-3);
    EXPECT_GE(features.box.yaw, -kPi / 2);
    EXPECT_LT(features.box.yaw, kPi / 2);
    EXPECT_NEAR(features.box.length, 4.2, 1e-3);
    EXPECT_NEAR(features.box.width, 1.7, 1e-3);
    EXPECT_NEAR(features.box.height, 1.4, 1e-5);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      EXPECT_NEAR(features.box.center[at], (std::array<double, 3>{12, -7, 0.5}[at]), 1e-3);
      EXPECT_NEAR(features.centroid[at], (std::array<double, 3>{12, -7, 0.5}[at]), 1e-5);
    }
    EXPECT_NEAR(features.density, static_cast<double>(points.size()) / (4.2 * 1.7 + 4.2 * 1.4 + 1.7 * 1.4), 0.1);
  }
}

// The sides that a sensor sees: the box of the least area has the same area along either leg and the hypotenuse.
TEST(ClusterFeatures, FitsTwoVisibleSides) {
  for (int degrees = 0; degrees < 180; degrees += 5) {
    const double yaw = degrees * kPi / 180;
    Points points;
    for (int i = 0; i <= 80; ++i) {
      const double a = i < 50 ? 0.08 * i : 4;
      const double b = i < 50 ? 0 : 0.06 * (i - 50);
      points.push_back({static_cast<float>(a * std::cos(yaw) - b * std::sin(yaw)),
                        static_cast<float>(a * std::sin(yaw) + b * std::cos(yaw)), 0});
    }
    const ClusterFeatures features = featuresOf(points);
    EXPECT_LT(difference(features.box.yaw, yaw), 1e-3) << degrees;
    EXPECT_NEAR(features.box.length, 4, 1e-3) << degrees;
    EXPECT_NEAR(features.box.width, 1.8, 1e-3) << degrees;
  }
}

TEST(ClusterFeatures, BoxesHoldAllPoints) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (const std::size_t count : {3U, 10U, 63U, 64U, 500U, 5000U}) {
    Points points(count);
    for (auto& point : points) point = {20 + 3 * normal(random), 5 + normal(random), normal(random)};
    const ClusterFeatures features = featuresOf(points);
    const OrientedBox& box = features.box;
    EXPECT_GE(box.length, box.width);
    for (const auto& point : points) {
      const double dx = static_cast<double>(point[0]) - box.center[0];
      const double dy = static_cast<double>(point[1]) - box.center[1];
      EXPECT_LE(std::fabs(std::cos(box.yaw) * dx + std::sin(box.yaw) * dy), box.length / 2 + 1e-9);
      EXPECT_LE(std::fabs(std::cos(box.yaw) * dy - std::sin(box.yaw) * dx), box.width / 2 + 1e-9);
      EXPECT_LE(std::fabs(static_cast<double>(point[2]) - box.center[2]), box.height / 2 + 1e-9);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(point[axis], features.min[axis]);
        EXPECT_LE(point[axis], features.max[axis]);
      }
    }
  }
}

TEST(ClusterFeatures, OnePointHasNoExtent) {
  const ClusterFeatures features = featuresOf({{3, 4, -1}});
  EXPECT_EQ(features.size, 1U);
  EXPECT_EQ(features.centroid, (std::array<double, 3>{3, 4, -1}));
  EXPECT_EQ(features.min, features.max);
  EXPECT_EQ(features.box.center, features.centroid);
  EXPECT_EQ(features.box.yaw, 0);
  EXPECT_EQ(features.box.length, 0);
  EXPECT_EQ(features.box.width, 0);
  EXPECT_EQ(features.box.height, 0);
  EXPECT_EQ(features.density, 0);
  EXPECT_DOUBLE_EQ(features.nearest_range, std::sqrt(26.));
}

TEST(ClusterFeatures, EqualPointsHaveNoExtent) {
  const ClusterFeatures features = featuresOf(Points(1000, {1, 2, 3}));
  EXPECT_EQ(features.box.length, 0);
  EXPECT_EQ(features.box.width, 0);
  EXPECT_EQ(features.box.yaw, 0);
  EXPECT_EQ(features.density, 0);
}

TEST(ClusterFeatures, TwoPointsGiveTheirLine) {
  const ClusterFeatures features = featuresOf({{1, 1, 0}, {4, 5, 2}});
  EXPECT_DOUBLE_EQ(features.box.length, 5);
  EXPECT_EQ(features.box.width, 0);
  EXPECT_EQ(features.box.height, 2);
  EXPECT_DOUBLE_EQ(features.box.yaw, std::atan2(4, 3));
  EXPECT_EQ(features.box.center, (std::array<double, 3>{2.5, 3, 1}));
  EXPECT_DOUBLE_EQ(features.density, 2. / 10);  // per square metre of the upright plane
}

TEST(ClusterFeatures, YawOfALineAlongYIsWithinItsRange) {
  for (const float y : {5.F, -5.F}) EXPECT_DOUBLE_EQ(featuresOf({{0, 0, 0}, {0, y, 0}}).box.yaw, -kPi / 2) << y;
}

TEST(ClusterFeatures, AVerticalLineHasAHeightOnly) {
  Points points;
  for (int i = 0; i < 100; ++i) points.push_back({7, -2, 0.1F * static_cast<float>(i)});
  const ClusterFeatures features = featuresOf(points);
  EXPECT_EQ(features.box.length, 0);
  EXPECT_EQ(features.box.width, 0);
  EXPECT_EQ(features.box.yaw, 0);
  EXPECT_NEAR(features.box.height, 9.9, 1e-5);
  EXPECT_EQ(features.density, 0);
}

TEST(ClusterFeatures, CollinearPointsHaveNoWidth) {
  for (const std::size_t count : {3U, 1000U}) {
    Points points;
    for (std::size_t i = 0; i < count; ++i)
      points.push_back({static_cast<float>(i % 17) * 0.25F, 3 - static_cast<float>(i % 17) * 0.5F, 1});
    const ClusterFeatures features = featuresOf(points);
    EXPECT_EQ(features.box.width, 0) << count;
    EXPECT_EQ(features.box.height, 0) << count;
    EXPECT_LT(difference(features.box.yaw, std::atan2(-2, 1)), 1e-12) << count;
    EXPECT_EQ(features.density, 0) << count;
  }
}

TEST(ClusterFeatures, NoPointsGiveZeros) {
  const ClusterFeatures features = clusterFeatures(nullptr, 0, 12);
  EXPECT_EQ(features.size, 0U);
  EXPECT_EQ(features.nearest_range, 0);
  EXPECT_EQ(features.box.length, 0);
}

TEST(ClusterFeatures, RefusesBadParameters) {
  const float point[3] = {1, 2, 3};
  EXPECT_THROW(clusterFeatures(point, 1, 11), std::invalid_argument);
  EXPECT_THROW(clusterFeatures(nullptr, 1, 12), std::invalid_argument);
}

TEST(ClusterFeatures, ReadsPointsOfAnyStride) {
  const std::vector<float> points{1, 2, 3, 99, 98, 2, 2, 3, 97, 96};
  const ClusterFeatures features = clusterFeatures(points.data(), 2, 5 * sizeof(float));
  EXPECT_EQ(features.max, (std::array<float, 3>{2, 2, 3}));
  std::vector<char> bytes(1 + 2 * 13);
  for (int i = 0; i < 2; ++i) std::memcpy(&bytes[1 + 13 * static_cast<std::size_t>(i)], &points[0], 12);
  EXPECT_EQ(clusterFeatures(&bytes[1], 2, 13).min, (std::array<float, 3>{1, 2, 3}));
}

TEST(ClusterFeatures, NearestRangeCountsFromTheSensor) {
  EXPECT_DOUBLE_EQ(featuresOf({{10, 0, 0}, {13, 4, 0}}, {10, 4, 0}).nearest_range, 3);
}

// Floats at 5 million metres are half a metre apart: the points are exact there, and so must the features be.
TEST(ClusterFeatures, LosesNothingInMapCoordinates) {
  constexpr double kEast = 5e5;
  constexpr double kNorth = 5.25e6;
  Points near, far;
  std::mt19937 random(5);
  for (int i = 0; i < 400; ++i) {  // an L of 30 m x 12 m, on a grid of half a metre
    const float along = 0.5F * static_cast<float>(random() % 60);
    const float across = 0.5F * static_cast<float>(random() % 24);
    near.push_back(i % 2 == 0 ? std::array<float, 3>{along, 0, 1} : std::array<float, 3>{0, across, 0});
    far.push_back(
        {near.back()[0] + static_cast<float>(kEast), near.back()[1] + static_cast<float>(kNorth), near.back()[2]});
  }
  const ClusterFeatures here = featuresOf(near);
  const ClusterFeatures there = featuresOf(far);
  EXPECT_EQ(there.box.length, here.box.length);
  EXPECT_EQ(there.box.width, here.box.width);
  EXPECT_EQ(there.box.yaw, here.box.yaw);
  EXPECT_NEAR(there.centroid[0] - kEast, here.centroid[0], 1e-9);
  EXPECT_NEAR(there.centroid[1] - kNorth, here.centroid[1], 1e-9);
  EXPECT_NEAR(there.box.center[1] - kNorth, here.box.center[1], 1e-9);
}

TEST(ClusterFeatures, AcceptsAnyFiniteCoordinates) {
  const ClusterFeatures features = featuresOf({{3e38F, 1e30F, -3e38F}, {-3e38F, -3e38F, 3e38F}, {1e-40F, 0, 0}});
  EXPECT_TRUE(std::isfinite(features.box.length));
  EXPECT_TRUE(std::isfinite(features.centroid[0]));
  EXPECT_TRUE(std::isfinite(features.nearest_range));
  EXPECT_NEAR(features.box.length / 1e38, std::sqrt(45.), 1e-6);
}

TEST(ConvexHull, IsThatOfBruteForce) {
  std::mt19937 random(11);
  for (int round = 0; round < 300; ++round) {
    const int grid = round % 3 == 0 ? 6 : 1000;  // coarse: many collinear and equal points
    std::vector<PlanePoint> points(3 + random() % 200);
    for (PlanePoint& p : points) {
      p.x = static_cast<double>(random() % static_cast<unsigned>(grid));
      p.y = static_cast<double>(random() % static_cast<unsigned>(grid));
    }
    const std::vector<PlanePoint> hull = convexHull(points);
    ASSERT_GE(hull.size(), 1U);
    for (std::size_t i = 0; hull.size() >= 3 && i < hull.size(); ++i) {
      const PlanePoint& a = hull[i];
      const PlanePoint& b = hull[(i + 1) % hull.size()];
      const PlanePoint& c = hull[(i + 2) % hull.size()];
      EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0) << round;
      for (const PlanePoint& p : points) EXPECT_GE((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x), 0) << round;
    }
    for (const PlanePoint& corner : hull)
      EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                              [&](const PlanePoint& p) { return p.x == corner.x && p.y == corner.y; }));
  }
}

}  // namespace
}  // namespace lisco
