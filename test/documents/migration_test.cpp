// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// What doc/migration.md says about PCL itself.
#include "examples/example_scan.h"
#include "pcl_client.h"

namespace lisco_test {
namespace {

using pcl::PointXYZI;
using Cloud = pcl::PointCloud<PointXYZI>;

Clusters clustersOf(pcl::EuclideanClusterExtraction<PointXYZI>& extraction, const Cloud::Ptr& cloud) {
  extraction.setInputCloud(cloud);
  extraction.setClusterTolerance(0.4);
  extraction.setMinClusterSize(10);
  Clusters clusters;
  extraction.extract(clusters);
  return clusters;
}

Clusters clustersByPclsChoice(const Cloud::Ptr& cloud) {
  pcl::EuclideanClusterExtraction<PointXYZI> extraction;
  return clustersOf(extraction, cloud);
}

Clusters clustersByKdTree(const Cloud::Ptr& cloud, bool sorted) {
  pcl::EuclideanClusterExtraction<PointXYZI> extraction;
  extraction.setSearchMethod(std::make_shared<pcl::search::KdTree<PointXYZI>>(sorted));
  return clustersOf(extraction, cloud);
}

Clusters clustersByLisco(const Cloud::Ptr& cloud) {
  Clusters clusters;
  LiscoClient<PointXYZI>().extract(cloud, nullptr, {0.4, 10}, clusters);
  return clusters;
}

Cloud::Ptr inOneRow(const Cloud::Ptr& cloud) {
  auto row = std::make_shared<Cloud>(*cloud);
  row->width = static_cast<std::uint32_t>(row->size());
  row->height = 1;
  return row;
}

TEST(Migration, PclsDefaultSearchMethodIsACamerasOnOrganizedClouds) {
  const Cloud::Ptr cloud = exampleScan();
  const Clusters by_kd_tree = clustersByKdTree(cloud, false);
  EXPECT_GT(by_kd_tree.size(), 12U);
  const Clusters by_default = clustersByPclsChoice(cloud);
  const bool same = by_default.size() == by_kd_tree.size() &&
                    std::equal(by_default.begin(), by_default.end(), by_kd_tree.begin(),
                               [](const auto& a, const auto& b) { return a.indices == b.indices; });
  EXPECT_FALSE(same);
  expectSame(by_kd_tree, clustersByLisco(cloud));
}

TEST(Migration, PclsDefaultSearchMethodIsAKdTreeOnOthers) {
  const Cloud::Ptr row = inOneRow(exampleScan());
  expectSame(clustersByPclsChoice(row), clustersByLisco(row));
}

TEST(Migration, KdTreesThatSortGiveTheSameClusters) {
  const Cloud::Ptr cloud = exampleScan();
  expectSame(clustersByKdTree(cloud, true), clustersByLisco(cloud));
}

TEST(Migration, OrganizedOrNotGivesTheSameClusters) {
  const Cloud::Ptr cloud = exampleScan();
  expectSame(clustersByLisco(cloud), clustersByLisco(inOneRow(cloud)));
}

}  // namespace
}  // namespace lisco_test
