// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// pcl::LiscoClusterExtraction against pcl::EuclideanClusterExtraction with KdTree (false): whole vectors.
#include <algorithm>
#include <array>
#include <string>

#include <pcl/common/point_tests.h>

#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// About 1400 returns in a dozen clusters and many small ones.
Cloud::Ptr scanOfBoxes(std::uint64_t seed = 1) {
  Random random(seed);
  return cloudOf(boxesAround(random, 180, 12));
}

class PclIdentity : public testing::TestWithParam<std::uint64_t> {};

TEST_P(PclIdentity, HoldsOnRandomScans) {
  for (std::uint64_t seed = GetParam(); seed < GetParam() + 700; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random);
    const Cloud::Ptr cloud = cloudOf(scan);
    Request request;
    request.tolerance = static_cast<double>(criticalTolerance(random, scan));
    request.min_size = static_cast<pcl::uindex_t>(1 + random.below(3));
    expectSameAsPcl<PointXYZ>(cloud, nullptr, request);
    expectSameAsPcl<PointXYZ>(cloud, shuffledIndices(random, cloud->size()), request);
    if (HasFailure()) return;
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, PclIdentity, testing::Values(1, 1001, 2001, 3001));

// FLANN sums up the bound by which it prunes a branch with rounding: here it exceeds r2 while d2 is below.
TEST(PclMissesPairs, ByTheRoundingOfItsTree) {
  const Cloud::Ptr cloud = cloudWithAMissedPair();
  const Request request{kMissingTolerance};
  Clusters by_pcl;
  Clusters by_lisco;
  PclClient<PointXYZ>().extract(cloud, nullptr, request, by_pcl);
  LiscoClient<PointXYZ>().extract(cloud, nullptr, request, by_lisco);
  EXPECT_EQ(by_pcl.size(), 8U);
  EXPECT_EQ(by_lisco.size(), 7U);
  EXPECT_TRUE(areSame(clustersByDefinition(*cloud, *returnsOf(*cloud), request), by_lisco));
  EXPECT_TRUE(isRefinement(by_pcl, by_lisco, cloud->size()));
  EXPECT_FALSE(isRefinement(by_lisco, by_pcl, cloud->size()));
  EXPECT_TRUE(areNeighbours({(*cloud)[0].x, (*cloud)[0].y, (*cloud)[0].z},
                            {(*cloud)[1].x, (*cloud)[1].y, (*cloud)[1].z}, static_cast<float>(kMissingTolerance)));
  expectSameAsPcl<PointXYZ>(cloud, nullptr, request);
}

// Squared distances to a branch overflow in FLANN, too: Lisco keeps to the definition.
TEST(PclMissesPairs, WhereItsBoundOverflows) {
  const auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 40; ++i)
    cloud->push_back(
        {static_cast<float>(i % 5) * 4e18F, static_cast<float>(i / 5 % 4) * 4e18F, static_cast<float>(i / 20) * 1e19F});
  (*cloud)[0].x = 1.0F;
  for (const double tolerance : {5e18, 1.3e19, 1.7e19, 1.85e19, 1e20}) {
    SCOPED_TRACE(tolerance);
    expectSameAsPcl<PointXYZ>(cloud, nullptr, {tolerance});
  }
}

// Without a pair that PCL misses, its vector is the definition's: indices in any order and repeated, sizes, headers.
TEST(PclMissesPairs, InNoOtherCases) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random);
    const Cloud::Ptr cloud = cloudOf(scan);
    const pcl::IndicesPtr indices = shuffledIndices(random, cloud->size());
    indices->insert(indices->end(), indices->begin(), indices->begin() + static_cast<long>(indices->size() / 2));
    const pcl::IndicesPtr returns = returnsOf(*cloud, indices);
    if (returns->empty()) continue;
    const Request request{static_cast<double>(criticalTolerance(random, scan)),
                          static_cast<pcl::uindex_t>(1 + random.below(3)),
                          static_cast<pcl::uindex_t>(3 + random.below(20))};
    Clusters by_pcl;
    PclClient<PointXYZ>().extract(cloud, returns, request, by_pcl);
    EXPECT_TRUE(areSame(clustersByDefinition(*cloud, *returns, request), by_pcl));
  }
}

TEST(PclIdentity, HoldsAtManyTolerances) {
  const Cloud::Ptr cloud = scanOfBoxes();
  for (const double tolerance : {0.05, 0.1, 0.3, 0.7, 1.0, 5.0, 100.0})
    EXPECT_FALSE(expectSameAsPcl<PointXYZ>(cloud, nullptr, {tolerance}).empty()) << tolerance;
}

TEST(PclIdentity, HoldsAtAnyTolerance) {
  const Cloud::Ptr cloud = scanOfBoxes();
  for (const double tolerance : {0.0, -0.0, -0.5, 1e-30, 1e-22, 1e15, 1e30, 1e300, kNan, kInfinity, -kInfinity}) {
    SCOPED_TRACE(tolerance);
    expectSameAsPcl<PointXYZ>(cloud, nullptr, {tolerance});
  }
}

TEST(PclIdentity, HoldsAtBothLimitsOfSize) {
  const Cloud::Ptr cloud = scanOfBoxes();
  const Clusters all = expectSameAsPcl<PointXYZ>(cloud, nullptr, {0.5});
  ASSERT_GT(all.size(), 4U);
  const auto middle = static_cast<pcl::uindex_t>(all[2].indices.size());
  for (const Request& request :
       {Request{0.5, 10}, Request{0.5, middle}, Request{0.5, middle + 1}, Request{0.5, 1, middle},
        Request{0.5, 1, middle - 1}, Request{0.5, middle, middle}, Request{0.5, 0, 0}, Request{0.5, 9, 3}})
    expectSameAsPcl<PointXYZ>(cloud, nullptr, request);
}

TEST(PclIdentity, HoldsForShuffledRepeatedAndFewIndices) {
  Random random(2);
  const Cloud::Ptr cloud = scanOfBoxes();
  const pcl::IndicesPtr all = shuffledIndices(random, cloud->size());
  expectSameAsPcl<PointXYZ>(cloud, all, {0.5});
  for (const std::size_t count : {cloud->size() / 2, cloud->size() / 4, cloud->size() / 8, cloud->size() / 20,
                                  std::size_t{100}, std::size_t{5}, std::size_t{1}}) {
    SCOPED_TRACE(count);
    const auto some = std::make_shared<pcl::Indices>(all->begin(), all->begin() + static_cast<std::ptrdiff_t>(count));
    expectSameAsPcl<PointXYZ>(cloud, some, {0.8});
    auto doubled = std::make_shared<pcl::Indices>(*some);
    doubled->insert(doubled->end(), some->begin(), some->end());
    random.shuffle(*doubled);
    expectSameAsPcl<PointXYZ>(cloud, doubled, {0.8});
  }
  // Many more indices than points.
  auto many = std::make_shared<pcl::Indices>();
  for (int i = 0; i < 3; ++i) many->insert(many->end(), all->begin(), all->end());
  expectSameAsPcl<PointXYZ>(cloud, many, {0.5});
}

TEST(PclIdentity, HoldsForIndicesOfARectangle) {
  const Cloud::Ptr cloud = scanOfBoxes();
  PclClient<PointXYZ> reference;
  LiscoClient<PointXYZ> lisco;
  Clusters actual;
  lisco.extraction.setInputCloud(cloud);
  lisco.extraction.setIndices(2, 30, 8, 100);
  lisco.extraction.setClusterTolerance(0.5);
  lisco.extraction.extract(actual);
  Clusters expected;
  reference.extract(cloud, returnsOf(*cloud, lisco.extraction.getIndices()), {0.5}, expected);
  EXPECT_GT(expected.size(), 1U);
  expectSame(expected, actual);
}

// Clusters of one size are ordered by an unstable sort of more than 16 elements.
TEST(PclIdentity, HoldsForManyClustersOfOneSize) {
  Random random(3);
  Scan scan(400, 2);
  for (std::size_t column = 0; column < 400; ++column)
    for (std::size_t laser = 0; laser < 2; ++laser)
      scan.set(laser, column,
               {static_cast<float>(column % 20) + 0.5F, static_cast<float>(column) / 20.0F,
                column % 3 == 0 ? 50.0F * static_cast<float>(laser) : 0.1F * static_cast<float>(laser)});
  const Cloud::Ptr cloud = cloudOf(scan);
  EXPECT_GT(expectSameAsPcl<PointXYZ>(cloud, nullptr, {0.5}).size(), 300U);
  expectSameAsPcl<PointXYZ>(cloud, shuffledIndices(random, cloud->size()), {0.5});
}

TEST(PclIdentity, HoldsForAppendedClusters) {
  PclClient<PointXYZ> reference;
  LiscoClient<PointXYZ> lisco;
  Clusters expected;
  Clusters actual;
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const Cloud::Ptr cloud = scanOfBoxes(seed);
    cloud->header.seq = static_cast<std::uint32_t>(seed);
    reference.extract(cloud, returnsOf(*cloud), {0.5}, expected);
    lisco.extract(cloud, nullptr, {0.5}, actual);
    ASSERT_TRUE(expectSame(expected, actual)) << seed;
  }
}

// One object for clouds of all sizes, with and without indices: each extraction starts afresh.
TEST(PclIdentity, HoldsForOneObjectAndManyClouds) {
  LiscoClient<PointXYZ> lisco;
  for (std::uint64_t seed = 1; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = random.chance(0.2) ? boxesAround(random, 100, 10) : randomScan(random);
    const Cloud::Ptr cloud = cloudOf(scan);
    pcl::IndicesPtr indices = random.chance(0.5) ? shuffledIndices(random, cloud->size()) : nullptr;
    if (indices && random.chance(0.5)) indices->resize(1 + random.below(indices->size()));
    const Request request{static_cast<double>(criticalTolerance(random, scan))};
    Clusters expected;
    Clusters actual;
    PclClient<PointXYZ>().extract(cloud, returnsOf(*cloud, indices), request, expected);
    lisco.extract(cloud, indices, request, actual);
    ASSERT_TRUE(expectSame(expected, actual));
  }
}

TEST(PclIdentity, HoldsForASecondExtraction) {
  LiscoClient<PointXYZ> lisco;
  Clusters first;
  lisco.extract(scanOfBoxes(), nullptr, {0.5}, first);
  Clusters second;
  lisco.extraction.extract(second);
  EXPECT_FALSE(first.empty());
  expectSame(first, second);
}

TEST(PclIdentity, HoldsForAnySearchMethod) {
  const Cloud::Ptr cloud = scanOfBoxes();
  pcl::LiscoClusterExtraction<PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  extraction.setClusterTolerance(0.5);
  Clusters without;
  extraction.extract(without);
  EXPECT_EQ(extraction.getSearchMethod(), nullptr);
  const auto tree = std::make_shared<pcl::search::KdTree<PointXYZ>>();
  extraction.setSearchMethod(tree);
  EXPECT_EQ(extraction.getSearchMethod(), tree);
  Clusters with;
  extraction.extract(with);
  expectSame(without, with);
  EXPECT_EQ(tree->getInputCloud(), nullptr);  // the tree was not used
}

TEST(PclIdentity, HoldsForAnyOrganization) {
  Random random(4);
  const Cloud::Ptr cloud = scanOfBoxes();
  expectSameAsPcl<PointXYZ>(unorganized(*cloud), nullptr, {0.5});
  const Cloud::Ptr dense = unorganized(*cloud);
  dense->erase(std::remove_if(dense->begin(), dense->end(), [](const PointXYZ& p) { return !pcl::isFinite(p); }),
               dense->end());
  dense->is_dense = true;
  expectSameAsPcl<PointXYZ>(dense, nullptr, {0.5});
  random.shuffle(*dense);
  expectSameAsPcl<PointXYZ>(dense, nullptr, {0.5});
  for (const std::uint32_t width : {1U, 7U, 179U, 2160U, 5000U}) {  // only some of which divide the size
    const auto wrong = std::make_shared<Cloud>(*cloud);
    wrong->width = width;
    SCOPED_TRACE(width);
    expectSameAsPcl<PointXYZ>(wrong, nullptr, {0.5});
  }
}

TEST(PclIdentity, HoldsForOrganizedCloudsWithoutNan) {
  Random random(5);
  Scan scan(60, 8);
  for (std::size_t laser = 0; laser < 8; ++laser)
    for (std::size_t column = 0; column < 60; ++column) {
      const double azimuth = 0.105 * static_cast<double>(column);
      const double range = random.between(4.9, 5.1);
      scan.set(laser, column,
               {static_cast<float>(range * std::cos(azimuth)), static_cast<float>(range * std::sin(azimuth)),
                0.3F * static_cast<float>(laser)});
    }
  const Cloud::Ptr cloud = cloudOf(scan);
  cloud->is_dense = true;
  for (const double tolerance : {0.2, 0.4, 0.55, 0.6}) expectSameAsPcl<PointXYZ>(cloud, nullptr, {tolerance});
}

TEST(PclIdentity, HoldsForACameraView) {
  Random random(6);
  const Cloud::Ptr cloud = cloudOf(cameraView(random, 80, 60));
  for (const double tolerance : {0.02, 0.05, 0.08, 0.2}) {
    EXPECT_FALSE(expectSameAsPcl<PointXYZ>(cloud, nullptr, {tolerance}).empty());
    expectSameAsPcl<PointXYZ>(unorganized(*cloud), nullptr, {tolerance});
  }
}

TEST(PclIdentity, HoldsForDisplacedClouds) {
  const Cloud::Ptr cloud = scanOfBoxes();
  for (const bool with_origin : {false, true})
    for (const float distance : {1.0F, 30.0F, 1000.0F, 1e6F}) {
      SCOPED_TRACE(distance);
      expectSameAsPcl<PointXYZ>(displaced(*cloud, distance, -distance, 0.1F * distance, with_origin), nullptr, {0.5});
    }
}

TEST(PclIdentity, HoldsForAnySensorOrigin) {
  const Cloud::Ptr cloud = displaced(*scanOfBoxes(), 1000.0F, 1000.0F, 0.0F, false);
  const std::array<float, 4> origins{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                                     3e38F, -1000.0F};
  for (const float origin : origins) {
    cloud->sensor_origin_ << origin, origin, 1.0F, 0.0F;
    expectSameAsPcl<PointXYZ>(cloud, nullptr, {0.5});
  }
}

}  // namespace
}  // namespace lisco_test
