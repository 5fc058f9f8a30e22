// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// pcl::extractLiscoClusters against pcl::extractEuclideanClusters: appended in order of discovery, not sorted.
#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;

Cloud::Ptr scanOfBoxes() {
  Random random(1);
  return cloudOf(boxesAround(random, 150, 10));
}

TEST(PclFreeFunctions, OnIndices) {
  Random random(2);
  const Cloud::Ptr cloud = scanOfBoxes();
  const pcl::search::KdTree<PointXYZ>::Ptr tree(new pcl::search::KdTree<PointXYZ>(false));
  Clusters expected;
  Clusters actual;
  for (const float tolerance : {0.1F, 0.5F, -1.0F, 0.0F}) {
    const pcl::IndicesPtr indices = shuffledIndices(random, cloud->size());
    const pcl::IndicesPtr returns = returnsOf(*cloud, indices);
    tree->setInputCloud(cloud, returns);
    pcl::extractEuclideanClusters(*cloud, *returns, tree, tolerance, expected, 2, 300);
    pcl::extractLiscoClusters(*cloud, *indices, tolerance, actual, 2, 300);
    ASSERT_TRUE(expectSame(expected, actual)) << tolerance;  // appended each time
  }
  EXPECT_GT(expected.size(), 20U);
}

TEST(PclFreeFunctions, OnAWholeCloud) {
  // PCL's function knows no invalid points.
  const Cloud::Ptr cloud = scanOfBoxes();
  const auto dense = std::make_shared<Cloud>(*cloud, *returnsOf(*cloud));
  const pcl::search::KdTree<PointXYZ>::Ptr tree(new pcl::search::KdTree<PointXYZ>(false));
  tree->setInputCloud(dense);
  Clusters expected;
  Clusters actual;
  for (const float tolerance : {0.1F, 0.5F, 1.0F}) {
    pcl::extractEuclideanClusters<PointXYZ>(*dense, tree, tolerance, expected);
    pcl::extractLiscoClusters(*dense, tolerance, actual);
    ASSERT_TRUE(expectSame(expected, actual)) << tolerance;
  }
  EXPECT_GT(expected.size(), 10U);
}

TEST(PclFreeFunctions, WholeCloudWithoutSomeReturnsIsThatOfItsReturns) {
  const Cloud::Ptr cloud = scanOfBoxes();
  Clusters of_returns;
  Clusters of_all;
  pcl::extractLiscoClusters(*cloud, *returnsOf(*cloud), 0.5F, of_returns);
  pcl::extractLiscoClusters(*cloud, 0.5F, of_all);
  EXPECT_FALSE(of_all.empty());
  expectSame(of_returns, of_all);
}

TEST(PclFreeFunctions, OnNothing) {
  Clusters clusters;
  pcl::extractLiscoClusters(Cloud(), 0.5F, clusters);
  pcl::extractLiscoClusters(Cloud(), pcl::Indices(), 0.5F, clusters);
  pcl::extractLiscoClusters(*scanOfBoxes(), pcl::Indices(), 0.5F, clusters);
  EXPECT_TRUE(clusters.empty());
}

}  // namespace
}  // namespace lisco_test
