// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The label image: 0 = none, otherwise the number of the point's cluster in the output, from 1.
#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;
using Extraction = pcl::LiscoClusterExtraction<PointXYZ>;

/// Points in a row on the x axis, from 1 m on.
Cloud::Ptr rowOf(const std::vector<float>& places, std::uint32_t seq) {
  auto cloud = std::make_shared<Cloud>();
  for (const float place : places) cloud->push_back(PointXYZ(1.0F + place, 0, 0));
  cloud->header.seq = seq;
  return cloud;
}

/// Every point has the label of the cluster that holds it, among those that carry the cloud's own header.
void expectLabelsOf(const Clusters& clusters, const Cloud& cloud, const Extraction::Labels& labels) {
  ASSERT_EQ(labels.size(), cloud.size());
  EXPECT_EQ(labels.header.seq, cloud.header.seq);
  EXPECT_EQ(labels.header.frame_id, cloud.header.frame_id);
  std::vector<bool> in_a_cluster(cloud.size(), false);
  for (const pcl::PointIndices& cluster : clusters)
    if (cluster.header.seq == cloud.header.seq)
      for (const pcl::index_t point : cluster.indices) in_a_cluster[static_cast<std::size_t>(point)] = true;
  for (std::size_t point = 0; point < cloud.size(); ++point) {
    const std::uint32_t label = labels[point].label;
    ASSERT_EQ(label != 0, in_a_cluster[point]) << "point " << point << " has label " << label;
    if (label == 0) continue;
    ASSERT_LE(label, clusters.size());
    const pcl::PointIndices& cluster = clusters[label - 1];
    ASSERT_EQ(cluster.header.seq, cloud.header.seq) << "point " << point << " is labelled by another cloud's cluster";
    ASSERT_TRUE(std::binary_search(cluster.indices.begin(), cluster.indices.end(), static_cast<pcl::index_t>(point)));
  }
}

Clusters expectLabelled(Extraction& extraction, const Cloud::Ptr& cloud, Clusters clusters = {}) {
  extraction.setInputCloud(cloud);
  Extraction::Labels labels;
  extraction.extract(clusters, labels);
  expectLabelsOf(clusters, *cloud, labels);
  return clusters;
}

TEST(PclLabels, AreOrganizedAsTheInput) {
  Random random(1);
  const Cloud::Ptr cloud = cloudOf(boxesAround(random, 120, 8));
  Extraction extraction;
  extraction.setInputCloud(cloud);
  extraction.setClusterTolerance(0.5);
  extraction.setMinClusterSize(5);
  Clusters clusters;
  Extraction::Labels labels;
  extraction.extract(clusters, labels);
  EXPECT_GT(clusters.size(), 3U);
  EXPECT_EQ(labels.width, 120U);
  EXPECT_EQ(labels.height, 8U);
  EXPECT_TRUE(labels.is_dense);
  expectLabelsOf(clusters, *cloud, labels);
  Clusters without_labels;
  extraction.extract(without_labels);
  expectSame(without_labels, clusters);
}

TEST(PclLabels, AreZeroOutsideTheIndices) {
  Random random(2);
  const Cloud::Ptr cloud = cloudOf(boxesAround(random, 120, 8));
  const pcl::IndicesPtr all = shuffledIndices(random, cloud->size());
  for (const std::size_t count : {cloud->size(), cloud->size() / 2, cloud->size() / 30, std::size_t{1}}) {
    Extraction extraction;
    extraction.setClusterTolerance(1.0);
    extraction.setIndices(
        std::make_shared<pcl::Indices>(all->begin(), all->begin() + static_cast<std::ptrdiff_t>(count)));
    expectLabelled(extraction, cloud);
  }
}

TEST(PclLabels, AreOneRowIfTheWidthIsWrong) {
  const Cloud::Ptr cloud = rowOf({0.0F, 0.1F, 5.0F, 5.1F}, 1);
  cloud->width = 3;
  cloud->height = 2;
  Extraction extraction;
  extraction.setClusterTolerance(0.2);
  extraction.setInputCloud(cloud);
  Clusters clusters;
  Extraction::Labels labels;
  extraction.extract(clusters, labels);
  EXPECT_EQ(labels.width, 4U);
  EXPECT_EQ(labels.height, 1U);
  expectLabelsOf(clusters, *cloud, labels);
}

TEST(PclLabels, AreZeroWithoutClusters) {
  Extraction extraction;
  Clusters clusters(3);
  Extraction::Labels labels(4, 4);
  testing::internal::CaptureStderr();
  extraction.extract(clusters, labels);  // no input
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(labels.empty());

  expectLabelled(extraction, std::make_shared<Cloud>());
  extraction.setMinClusterSize(100);
  EXPECT_TRUE(expectLabelled(extraction, rowOf({0.0F, 0.1F, 0.2F}, 1)).empty());

  extraction.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{0, 77}));
  testing::internal::CaptureStderr();
  expectLabelled(extraction, rowOf({0.0F, 0.1F, 0.2F}, 2));
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
}

// The vector may hold the clusters of a larger cloud, whose indices this cloud does not have.
TEST(PclLabels, IgnoreClustersOfALargerCloud) {
  Random random(3);
  const Cloud::Ptr large = cloudOf(boxesAround(random, 120, 8));
  large->header.seq = 1;
  Extraction extraction;
  extraction.setClusterTolerance(0.5);
  const Clusters clusters = expectLabelled(extraction, large);
  const Clusters both = expectLabelled(extraction, rowOf({0.0F, 0.1F, 0.2F, 7.0F}, 2), clusters);
  EXPECT_EQ(both.size(), clusters.size() + 2);
  pcl::PointIndices bad;
  bad.indices = {-1, 100000};
  expectLabelled(extraction, rowOf({0.0F, 0.1F, 0.2F, 7.0F}, 3), {bad, pcl::PointIndices()});
}

// Another cloud's clusters have the same indices as this cloud's: they do not number this cloud's labels.
TEST(PclLabels, IgnoreClustersOfEqualIndices) {
  std::vector<float> pairs;
  for (int i = 0; i < 40; ++i) {
    pairs.push_back(static_cast<float>(i));
    pairs.push_back(static_cast<float>(i) + 0.1F);
  }
  Extraction extraction;
  extraction.setClusterTolerance(0.2);
  const Clusters clusters = expectLabelled(extraction, rowOf(pairs, 1));
  ASSERT_EQ(clusters.size(), 40U);
  expectLabelled(extraction, rowOf(pairs, 2), clusters);
}

// This cloud's group is too small to be a cluster.
TEST(PclLabels, IgnoreClustersOfATooSmallGroup) {
  Extraction extraction;
  extraction.setClusterTolerance(0.2);
  const Clusters clusters = expectLabelled(extraction, rowOf({0.0F, 0.1F, 0.2F}, 1));
  ASSERT_EQ(clusters.size(), 1U);
  extraction.setMinClusterSize(4);
  expectLabelled(extraction, rowOf({0.0F, 0.1F, 0.2F, 5.0F, 5.1F, 5.2F, 5.3F}, 2), clusters);
}

}  // namespace
}  // namespace lisco_test
