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

TEST(PclFreeFunctions, EqualPclsOnIndices) {
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

TEST(PclFreeFunctions, EqualPclsOnAWholeCloud) {
  // PCL's function accepts only valid points.
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

TEST(PclFreeFunctions, SkipNoReturnsOfAWholeCloud) {
  const Cloud::Ptr cloud = scanOfBoxes();
  Clusters of_returns;
  Clusters of_all;
  pcl::extractLiscoClusters(*cloud, *returnsOf(*cloud), 0.5F, of_returns);
  pcl::extractLiscoClusters(*cloud, 0.5F, of_all);
  EXPECT_FALSE(of_all.empty());
  expectSame(of_returns, of_all);
}

/// The common calls of both names: a plain rename.
template <typename Extract>
void extractWithTree(const Extract& extract, const Cloud::Ptr& cloud, const pcl::IndicesPtr& indices,
                     Clusters& clusters) {
  const pcl::search::KdTree<PointXYZ>::Ptr tree(new pcl::search::KdTree<PointXYZ>(false));
  const pcl::search::Search<PointXYZ>::Ptr search = tree;
  tree->setInputCloud(cloud, indices);
  extract(*cloud, *indices, tree, 0.5F, clusters);
  extract(*cloud, *indices, search, 0.5F, clusters, 2);
  extract(*cloud, *indices, tree, 0.5F, clusters, 2, 300);
  tree->setInputCloud(cloud);
  extract(*cloud, tree, 0.5F, clusters);
  extract(*cloud, search, 0.5F, clusters, 2);
  extract(*cloud, tree, 0.5F, clusters, 2, 300);
}

TEST(PclFreeFunctions, AcceptATreeAsPclsDo) {
  Random random(3);
  const Cloud::Ptr scan = scanOfBoxes();
  const auto cloud = std::make_shared<Cloud>(*scan, *returnsOf(*scan));
  const pcl::IndicesPtr indices = shuffledIndices(random, cloud->size());
  indices->resize(indices->size() / 2);
  Clusters expected;
  Clusters actual;
  extractWithTree([](auto&&... arguments) { pcl::extractEuclideanClusters<PointXYZ>(arguments...); }, cloud, indices,
                  expected);
  extractWithTree([](auto&&... arguments) { pcl::extractLiscoClusters<PointXYZ>(arguments...); }, cloud, indices,
                  actual);
  EXPECT_GT(expected.size(), 40U);
  expectSame(expected, actual);
  actual.clear();
  extractWithTree([](auto&&... arguments) { pcl::extractLiscoClusters(arguments...); }, cloud, indices, actual);
  expectSame(expected, actual);
}

TEST(PclFreeFunctions, IgnoreTheTree) {
  const Cloud::Ptr cloud = scanOfBoxes();
  const pcl::search::KdTree<PointXYZ>::Ptr empty_tree(new pcl::search::KdTree<PointXYZ>);
  Clusters expected;
  Clusters actual;
  pcl::extractLiscoClusters(*cloud, 0.5F, expected, 2);
  pcl::extractLiscoClusters(*cloud, *returnsOf(*cloud), 0.5F, expected, 2);
  pcl::extractLiscoClusters(*cloud, empty_tree, 0.5F, actual, 2);
  pcl::extractLiscoClusters(*cloud, *returnsOf(*cloud), nullptr, 0.5F, actual, 2);
  expectSame(expected, actual);
  EXPECT_EQ(empty_tree->getInputCloud(), nullptr);
}

TEST(PclFreeFunctions, AcceptEmptyClouds) {
  Clusters clusters;
  pcl::extractLiscoClusters(Cloud(), 0.5F, clusters);
  pcl::extractLiscoClusters(Cloud(), pcl::Indices(), 0.5F, clusters);
  pcl::extractLiscoClusters(*scanOfBoxes(), pcl::Indices(), 0.5F, clusters);
  EXPECT_TRUE(clusters.empty());
}

}  // namespace
}  // namespace lisco_test
