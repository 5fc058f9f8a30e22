// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/label_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

std::vector<Point> pointsOf(const Scan& scan) {
  std::vector<Point> points;
  for (const lisco::Return& cell : scan.cells) points.push_back({cell.x, cell.y, cell.z});
  return points;
}

/// The clusters that labels give, ordered by first members.
Clustering clustersOf(const std::vector<std::int32_t>& labels) {
  std::map<std::int32_t, Cluster> by_label;
  for (std::uint32_t i = 0; i < labels.size(); ++i)
    if (labels[i] >= 0) by_label[labels[i]].members.push_back(i);
  Clustering clusters;
  for (auto& [label, cluster] : by_label) clusters.push_back({cluster.members, cluster.members.size()});
  return inOrder(std::move(clusters));
}

TEST(LabelClusters, AreTheTrueClustersLargestFirst) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = sometimesWide(random, randomScan(random));
    const std::vector<Point> points = pointsOf(scan);
    lisco::LabelParameters parameters;
    parameters.tolerance = criticalTolerance(random, scan);
    parameters.min_size = 1 + random.below(3);
    parameters.max_size = random.chance(0.5) ? ~std::size_t{0} : 1 + random.below(20);
    parameters.lasers = random.chance(0.5) ? scan.lasers : 1;
    parameters.threads = 1 + random.below(3);
    // Any stride, aligned or not.
    const std::size_t stride = random.chance(0.2) ? 32 : sizeof(Point) + random.below(12);
    std::vector<unsigned char> bytes(points.size() * stride + 1);
    for (std::size_t i = 0; i < points.size(); ++i) std::memcpy(&bytes[i * stride], &points[i], sizeof(Point));
    std::vector<std::int32_t> labels(points.size(), 77);
    const std::size_t count = lisco::labelClusters(bytes.data(), points.size(), stride, parameters, labels.data());

    Clustering expected = trueClusters(points, parameters.tolerance);
    expected.erase(std::remove_if(expected.begin(), expected.end(),
                                  [&](const Cluster& cluster) {
                                    return cluster.members.size() < parameters.min_size ||
                                           cluster.members.size() > parameters.max_size;
                                  }),
                   expected.end());
    ASSERT_EQ(count, expected.size());
    ASSERT_EQ(difference(expected, clustersOf(labels)), "");
    std::vector<std::size_t> sizes(count, 0);
    for (const std::int32_t label : labels)
      if (label >= 0) ++sizes.at(static_cast<std::size_t>(label));
    EXPECT_TRUE(std::is_sorted(sizes.rbegin(), sizes.rend()));
  }
}

TEST(LabelClusters, OneLabellerLabelsScanAfterScan) {
  lisco::ClusterLabeller labeller;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random);
    const std::vector<Point> points = pointsOf(scan);
    lisco::LabelParameters parameters;
    parameters.tolerance = criticalTolerance(random, scan);
    parameters.min_size = 1 + random.below(3);
    parameters.lasers = random.chance(0.5) ? scan.lasers : 1;
    std::vector<std::int32_t> expected(points.size()), labels(points.size(), 77);
    const std::size_t count =
        lisco::labelClusters(points.data(), points.size(), sizeof(Point), parameters, expected.data());
    const std::size_t columns = points.size() / parameters.lasers;
    const auto cell_at = [&](std::size_t laser, std::size_t column) {
      const Point& point = points[laser * columns + column];
      return lisco::Return{point.x, point.y, point.z, 0};
    };
    EXPECT_EQ(labeller.label(points.size(), cell_at, parameters, labels.data()), count);
    EXPECT_EQ(labels, expected);
  }
}

TEST(LabelClusters, RejectsWrongArguments) {
  const float points[6] = {1, 2, 3, 4, 5, 6};
  std::int32_t labels[2];
  lisco::LabelParameters parameters;
  parameters.tolerance = 1.0F;
  EXPECT_EQ(lisco::labelClusters(points, 2, 12, parameters, labels), 2U);
  EXPECT_EQ(lisco::labelClusters(nullptr, 0, 12, parameters, nullptr), 0U);
  EXPECT_THROW(lisco::labelClusters(points, 2, 11, parameters, labels), std::invalid_argument);
  EXPECT_THROW(lisco::labelClusters(nullptr, 2, 12, parameters, labels), std::invalid_argument);
  EXPECT_THROW(lisco::labelClusters(points, 2, 12, parameters, nullptr), std::invalid_argument);
  EXPECT_THROW(lisco::labelClusters(points, std::size_t{1} << 31, 12, parameters, labels), std::invalid_argument);
  for (const std::size_t lasers : {0U, 3U}) {
    parameters.lasers = lasers;
    EXPECT_THROW(lisco::labelClusters(points, 2, 12, parameters, labels), std::invalid_argument);
  }
}

}  // namespace
}  // namespace lisco_test
