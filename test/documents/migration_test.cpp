// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The statements of doc/migration.md about PCL.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include <pcl/point_representation.h>
#include <pcl/search/brute_force.h>
#include <pcl/search/octree.h>

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

using Tree = pcl::search::KdTree<PointXYZI>;

Tree::Ptr treeWithEpsilon(float epsilon) {
  auto tree = std::make_shared<Tree>(false);
  tree->setEpsilon(epsilon);
  return tree;
}

Tree::Ptr treeWithScales(const std::array<float, 3>& scales) {
  auto representation = std::make_shared<pcl::DefaultPointRepresentation<PointXYZI>>();
  representation->setRescaleValues(scales.data());
  auto tree = std::make_shared<Tree>(false);
  tree->setPointRepresentation(representation);
  return tree;
}

/// x and y only.
struct PlanRepresentation : pcl::PointRepresentation<PointXYZI> {
  PlanRepresentation() { nr_dimensions_ = 2, trivial_ = true; }
  void copyToFloatArray(const PointXYZI& point, float* out) const override { out[0] = point.x, out[1] = point.y; }
};

Tree::Ptr treeOfPlan() {
  auto tree = std::make_shared<Tree>(false);
  tree->setPointRepresentation(std::make_shared<PlanRepresentation>());
  return tree;
}

template <typename Extraction>
Clusters clustersBy(const Tree::Ptr& tree, const Cloud::Ptr& cloud) {
  Extraction extraction;
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  extraction.setClusterTolerance(0.4);
  Clusters clusters;
  extraction.extract(clusters);
  return clusters;
}

/// Lisco's clusters with a tree are those of an exact kd-tree, PCL's are others.
void expectPclsAlone(const Tree::Ptr& tree) {
  const Cloud::Ptr cloud = inOneRow(exampleScan());
  const Clusters exact = clustersBy<pcl::EuclideanClusterExtraction<PointXYZI>>(std::make_shared<Tree>(false), cloud);
  expectSame(exact, clustersBy<pcl::LiscoClusterExtraction<PointXYZI>>(tree, cloud));
  const Clusters others = clustersBy<pcl::EuclideanClusterExtraction<PointXYZI>>(tree, cloud);
  EXPECT_FALSE(std::equal(exact.begin(), exact.end(), others.begin(), others.end(),
                          [](const auto& a, const auto& b) { return a.indices == b.indices; }));
}

TEST(Migration, PclsClustersDifferWithAnInexactKdTree) {
  expectPclsAlone(treeWithEpsilon(1.0F));
}

TEST(Migration, PclsClustersDifferWithAnotherMetric) {
  expectPclsAlone(treeWithScales({1.0F, 1.0F, 0.1F}));
  expectPclsAlone(treeOfPlan());
}

TEST(Migration, PclsClustersDifferWithSearchesThatReachTheTolerance) {
  auto pair = std::make_shared<Cloud>(2, 1);
  for (std::size_t i = 0; i < 2; ++i) (*pair)[i].getVector3fMap() << 1.0F + 0.5F * static_cast<float>(i), 1.0F, 1.0F;
  const auto count = [&](auto&& extraction, const pcl::search::Search<PointXYZI>::Ptr& tree) {
    extraction.setInputCloud(pair);
    extraction.setSearchMethod(tree);
    extraction.setClusterTolerance(0.5);
    Clusters clusters;
    extraction.extract(clusters);
    return clusters.size();
  };
  const pcl::search::Search<PointXYZI>::Ptr brute = std::make_shared<pcl::search::BruteForce<PointXYZI>>();
  const pcl::search::Search<PointXYZI>::Ptr octree = std::make_shared<pcl::search::Octree<PointXYZI>>(0.5);
  for (const auto& tree : {brute, octree}) {
    EXPECT_EQ(count(pcl::EuclideanClusterExtraction<PointXYZI>(), tree), 1U);
    EXPECT_EQ(count(pcl::LiscoClusterExtraction<PointXYZI>(), tree), 2U);
  }
}

void giveToClass(const Tree::Ptr& tree) {
  pcl::LiscoClusterExtraction<PointXYZI>().setSearchMethod(tree);
}

void giveToFunctions(const Tree::Ptr& tree) {
  const pcl::PointCloud<PointXYZI> cloud;
  Clusters clusters;
  pcl::extractLiscoClusters(cloud, tree, 0.4F, clusters);
  pcl::extractLiscoClusters(cloud, pcl::Indices(), tree, 0.4F, clusters);
}

/// Runs a body in a new process, where no warning has been given yet, and expects one line for each text.
void expectWarnings(void (*body)(), const std::vector<std::string>& texts) {
  std::string pattern;
  for (const std::string& text : texts) pattern += "[^\n]*" + text + "[^\n]*\n";
  const auto run = [&] {
    body();
    std::exit(0);
  };
  testing::GTEST_FLAG(death_test_style) = "threadsafe";  // a new process, not a fork
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "^" + pattern + "[^\n]*$");
}

TEST(Migration, WarnsOnceOfAnInexactKdTree) {
  const auto body = [] {
    giveToClass(treeWithEpsilon(1.0F));
    giveToClass(treeWithEpsilon(0.5F));
    giveToFunctions(treeWithEpsilon(1.0F));
  };
  expectWarnings(body, {"\\[pcl::LiscoClusterExtraction::setSearchMethod\\] The kd-tree's epsilon is above 0"});
}

TEST(Migration, WarnsOnceOfAnotherMetric) {
  const auto body = [] {
    giveToClass(treeWithScales({1.0F, 1.0F, 0.1F}));
    giveToClass(treeOfPlan());
    giveToFunctions(treeOfPlan());
  };
  const std::string text =
      "\\[pcl::LiscoClusterExtraction::setSearchMethod\\] The kd-tree's point representation is not \\(x, y, z\\)";
  expectWarnings(body, {text});
  expectWarnings([] { giveToClass(treeOfPlan()); }, {text});
}

TEST(Migration, WarnsOfBothKinds) {
  const auto body = [] {
    giveToClass(treeOfPlan());
    giveToClass(treeWithEpsilon(1.0F));
  };
  expectWarnings(body, {"point representation", "epsilon"});
}

TEST(Migration, FreeFunctionsWarnToo) {
  expectWarnings([] { giveToFunctions(treeWithEpsilon(1.0F)); },
                 {"\\[pcl::extractLiscoClusters\\] The kd-tree's epsilon"});
}

TEST(Migration, DoesNotWarnOfExactSearchMethods) {
  const auto body = [] {
    for (const auto& give : {giveToClass, giveToFunctions}) {
      give(nullptr);
      give(std::make_shared<Tree>());
      give(treeWithEpsilon(0.0F));
      give(treeWithScales({1.0F, 1.0F, 1.0F}));
    }
  };
  expectWarnings(body, {});
}

/// The search method after an extraction.
template <typename Extraction>
pcl::search::Search<PointXYZI>::Ptr searchMethodAfter(const Tree::Ptr& tree) {
  Extraction extraction;
  if (tree) extraction.setSearchMethod(tree);
  extraction.setInputCloud(inOneRow(exampleScan()));
  Clusters clusters;
  extraction.extract(clusters);
  return extraction.getSearchMethod();
}

TEST(Migration, LiscoLeavesTheTreeAsItIs) {
  const auto tree = std::make_shared<Tree>(false);
  EXPECT_EQ(searchMethodAfter<pcl::LiscoClusterExtraction<PointXYZI>>(tree), tree);
  EXPECT_EQ(tree->getInputCloud(), nullptr);
  EXPECT_EQ(searchMethodAfter<pcl::EuclideanClusterExtraction<PointXYZI>>(tree), tree);
  EXPECT_NE(tree->getInputCloud(), nullptr);
}

TEST(Migration, LiscoChoosesNoTree) {
  EXPECT_EQ(searchMethodAfter<pcl::LiscoClusterExtraction<PointXYZI>>(nullptr), nullptr);
  EXPECT_NE(searchMethodAfter<pcl::EuclideanClusterExtraction<PointXYZI>>(nullptr), nullptr);
}

}  // namespace
}  // namespace lisco_test
