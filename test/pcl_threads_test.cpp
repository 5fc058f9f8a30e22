// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// pcl::LiscoClusterExtraction by several threads gives byte for byte what one thread and PCL give.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "pcl_client.h"
#include "pcl_clouds.h"
#include "scans.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;

constexpr std::array<unsigned int, 7> kThreads{0, 1, 2, 3, 8, 100, ~0U};

Clusters clustersBy(LiscoClient<PointXYZ>& client, unsigned int threads, const Cloud::Ptr& cloud,
                    const pcl::IndicesPtr& indices, const Request& request) {
  client.extraction.setNumberOfThreads(threads);
  Clusters clusters;
  client.extract(cloud, indices, request, clusters);
  return clusters;
}

/// One object with changing numbers of threads, and one for each.
void expectSameByAnyThreads(LiscoClient<PointXYZ>& repeated, const Cloud::Ptr& cloud, const pcl::IndicesPtr& indices,
                            const Request& request, const Clusters& expected) {
  for (const unsigned int threads : kThreads) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    EXPECT_TRUE(expectSame(expected, clustersBy(repeated, threads, cloud, indices, request)));
    LiscoClient<PointXYZ> once;
    EXPECT_TRUE(expectSame(expected, clustersBy(once, threads, cloud, indices, request)));
  }
}

TEST(PclThreads, OneIsTheDefault) {
  pcl::LiscoClusterExtraction<PointXYZ> extraction;
  EXPECT_EQ(extraction.getNumberOfThreads(), 1U);
  extraction.setNumberOfThreads(3);
  EXPECT_EQ(extraction.getNumberOfThreads(), 3U);
  extraction.setNumberOfThreads();
  EXPECT_EQ(extraction.getNumberOfThreads(), 0U) << "as it was set: one for each core";
}

TEST(PclThreads, ChangeNothing) {
  LiscoClient<PointXYZ> repeated;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Cloud::Ptr cloud = cloudOf(largeScan(random));
    if (random.chance(0.2)) cloud = unorganized(*cloud);
    if (random.chance(0.2)) cloud = displaced(*cloud, 1000.0F, -500.0F, 3.0F, random.chance(0.5));
    pcl::IndicesPtr indices;
    if (random.chance(0.5)) {
      indices = shuffledIndices(random, cloud->size());
      const std::array<std::size_t, 4> shares{1, 2, 7, 20};
      indices->resize(indices->size() / random.oneOf(shares));
      if (random.chance(0.5)) std::sort(indices->begin(), indices->end());
    }
    Request request{random.magnitude(0.05, 0.7)};
    request.min_size = static_cast<pcl::uindex_t>(1 + random.below(5));
    Clusters expected;
    PclClient<PointXYZ>().extract(cloud, returnsOf(*cloud, indices), request, expected);
    expectSameByAnyThreads(repeated, cloud, indices, request, expected);
    if (HasFailure()) return;
  }
}

// Clouds that are too small for threads, and unusual ones.
TEST(PclThreads, ChangeNothingInSmallClouds) {
  LiscoClient<PointXYZ> repeated;
  for (std::uint64_t seed = 100; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = randomScan(random);
    const Cloud::Ptr cloud = cloudOf(scan);
    const Request request{static_cast<double>(criticalTolerance(random, scan))};
    Clusters expected;
    PclClient<PointXYZ>().extract(cloud, returnsOf(*cloud), request, expected);
    expectSameByAnyThreads(repeated, cloud, nullptr, request, expected);
    if (HasFailure()) return;
  }
}

TEST(PclThreads, AppendToClustersOfOtherClouds) {
  Random random(3);
  const Cloud::Ptr cloud = cloudOf(largeScan(random));
  const Cloud::Ptr other = cloudOf(largeScan(random));
  pcl::IndicesPtr shuffled = shuffledIndices(random, other->size());
  std::array<Clusters, 2> clusters;
  for (std::size_t i = 0; i < 2; ++i)
    for (const auto& [input, indices] :
         {std::pair{cloud, pcl::IndicesPtr()}, {other, pcl::IndicesPtr()}, {other, shuffled}}) {
      pcl::LiscoClusterExtraction<PointXYZ> extraction;
      extraction.setNumberOfThreads(i == 0 ? 1 : 3);
      extraction.setInputCloud(input);
      if (indices) extraction.setIndices(indices);
      extraction.setClusterTolerance(0.3);
      extraction.extract(clusters[i]);
    }
  EXPECT_TRUE(expectSame(clusters[0], clusters[1]));
}

TEST(PclThreads, ChangeNoLabels) {
  Random random(1);
  const Cloud::Ptr cloud = cloudOf(largeScan(random));
  pcl::PointCloud<pcl::Label> by_one;
  for (const unsigned int threads : {1U, 2U, 3U, 0U}) {
    LiscoClient<PointXYZ> client;
    client.extraction.setNumberOfThreads(threads);
    client.extraction.setInputCloud(cloud);
    client.extraction.setClusterTolerance(0.3);
    Clusters clusters;
    pcl::PointCloud<pcl::Label> labels;
    client.extraction.extract(clusters, labels);
    EXPECT_FALSE(clusters.empty());
    if (threads == 1) by_one = labels;
    ASSERT_EQ(labels.size(), by_one.size());
    for (std::size_t i = 0; i < labels.size(); ++i) ASSERT_EQ(labels[i].label, by_one[i].label) << i;
  }
}

TEST(PclThreads, ChangeNothingAtAnyTolerance) {
  Random random(2);
  const Cloud::Ptr cloud = cloudOf(largeScan(random));
  LiscoClient<PointXYZ> client;
  for (const double tolerance :
       {0.0, -0.3, 1e-30, 1e30, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(tolerance);
    const Clusters expected = clustersBy(client, 1, cloud, nullptr, {tolerance});
    EXPECT_TRUE(expectSame(expected, clustersBy(client, 3, cloud, nullptr, {tolerance})));
  }
}

}  // namespace
}  // namespace lisco_test
