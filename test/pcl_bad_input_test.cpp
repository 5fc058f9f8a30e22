// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Input that is missing, empty or wrong, and points that are no returns.
#include <algorithm>
#include <array>
#include <string>

#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;

/// Content of the vector before a call that clears it.
Clusters anyClusters() {
  Clusters clusters(2);
  clusters[0].indices = {1, 2, 3};
  return clusters;
}

Cloud::Ptr fivePoints() {
  auto cloud = std::make_shared<Cloud>();
  for (int i = 0; i < 5; ++i) cloud->push_back(PointXYZ(1.0F + 0.1F * static_cast<float>(i), 1.0F, 1.0F));
  return cloud;
}

/// Both classes clear the vector and return.
template <typename Extraction>
class PclMissingInput : public testing::Test {};
using Extractions = testing::Types<pcl::EuclideanClusterExtraction<PointXYZ>, pcl::LiscoClusterExtraction<PointXYZ>>;
TYPED_TEST_SUITE(PclMissingInput, Extractions);

TYPED_TEST(PclMissingInput, ClearsTheVector) {
  TypeParam extraction;
  Clusters clusters = anyClusters();
  testing::internal::CaptureStderr();
  extraction.extract(clusters);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("No input set"), std::string::npos);
  EXPECT_TRUE(clusters.empty());
}

TYPED_TEST(PclMissingInput, EmptyCloudOrIndicesClearTheVector) {
  TypeParam extraction;
  extraction.setInputCloud(std::make_shared<Cloud>());
  Clusters clusters = anyClusters();
  extraction.extract(clusters);
  EXPECT_TRUE(clusters.empty());

  extraction.setInputCloud(fivePoints());
  extraction.setIndices(std::make_shared<pcl::Indices>());
  clusters = anyClusters();
  extraction.extract(clusters);
  EXPECT_TRUE(clusters.empty());
}

TYPED_TEST(PclMissingInput, ThenUsableAsEver) {
  TypeParam extraction;
  Clusters clusters;
  extraction.setClusterTolerance(0.2);
  extraction.setInputCloud(std::make_shared<Cloud>());
  extraction.extract(clusters);
  extraction.setInputCloud(fivePoints());
  extraction.extract(clusters);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_EQ(clusters[0].indices, (pcl::Indices{0, 1, 2, 3, 4}));
}

TYPED_TEST(PclMissingInput, IndicesBecomeThoseOfAllPoints) {
  TypeParam extraction;
  extraction.setInputCloud(fivePoints());
  EXPECT_EQ(extraction.getIndices(), nullptr);
  Clusters clusters;
  extraction.extract(clusters);
  ASSERT_NE(extraction.getIndices(), nullptr);
  EXPECT_EQ(*extraction.getIndices(), (pcl::Indices{0, 1, 2, 3, 4}));
}

TYPED_TEST(PclMissingInput, SettersGettersAndTypes) {
  TypeParam extraction;
  EXPECT_EQ(extraction.getClusterTolerance(), 0.0);
  EXPECT_EQ(extraction.getMinClusterSize(), 1U);
  EXPECT_EQ(extraction.getMaxClusterSize(), std::numeric_limits<pcl::uindex_t>::max());
  EXPECT_EQ(extraction.getSearchMethod(), nullptr);
  extraction.setClusterTolerance(-0.25);
  extraction.setMinClusterSize(7);
  extraction.setMaxClusterSize(5);
  EXPECT_EQ(extraction.getClusterTolerance(), -0.25);
  EXPECT_EQ(extraction.getMinClusterSize(), 7U);
  EXPECT_EQ(extraction.getMaxClusterSize(), 5U);

  typename TypeParam::PointCloudPtr cloud = fivePoints();
  typename TypeParam::PointCloudConstPtr const_cloud = cloud;
  extraction.setInputCloud(const_cloud);
  EXPECT_EQ(extraction.getInputCloud(), cloud);
  typename TypeParam::PointIndicesPtr indices(new pcl::PointIndices);
  indices->indices = {2, 1};
  typename TypeParam::PointIndicesConstPtr const_indices = indices;
  extraction.setIndices(const_indices);
  EXPECT_EQ(*extraction.getIndices(), (pcl::Indices{2, 1}));
  typename TypeParam::KdTreePtr tree(new pcl::search::KdTree<PointXYZ>(false));
  extraction.setSearchMethod(tree);
  EXPECT_EQ(extraction.getSearchMethod(), tree);
  static_assert(std::is_same_v<typename TypeParam::KdTree, pcl::search::Search<PointXYZ>>);
  static_assert(std::is_same_v<typename TypeParam::PointCloud, Cloud>);
  static_assert(std::is_base_of_v<pcl::PCLBase<PointXYZ>, TypeParam>);
}

/// The indices clear the vector, with an error that names the method and the index.
void expectRejected(const pcl::Indices& indices, const std::string& bad_index) {
  pcl::LiscoClusterExtraction<PointXYZ> extraction;
  extraction.setInputCloud(fivePoints());
  extraction.setClusterTolerance(0.2);
  extraction.setIndices(std::make_shared<pcl::Indices>(indices));
  Clusters clusters = anyClusters();
  testing::internal::CaptureStderr();
  extraction.extract(clusters);
  std::string error = testing::internal::GetCapturedStderr();
  EXPECT_NE(error.find("[pcl::LiscoClusterExtraction::extract]"), std::string::npos) << error;
  EXPECT_NE(error.find(bad_index), std::string::npos) << error;
  EXPECT_TRUE(clusters.empty());

  clusters = anyClusters();
  testing::internal::CaptureStderr();
  pcl::extractLiscoClusters(*fivePoints(), indices, 0.2F, clusters);
  error = testing::internal::GetCapturedStderr();
  EXPECT_NE(error.find("[pcl::extractLiscoClusters]"), std::string::npos) << error;
  EXPECT_NE(error.find(bad_index), std::string::npos) << error;
  EXPECT_TRUE(clusters.empty());

  // The cloud set afterwards is clustered as usual.
  extraction.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{4, 0}));
  extraction.extract(clusters);
  EXPECT_EQ(clusters.size(), 2U);
}

TEST(PclBadIndices, AreRejected) {
  expectRejected({0, 1, 5}, "5");
  expectRejected({-1}, "-1");
  expectRejected({0, std::numeric_limits<pcl::index_t>::max()}, "2147483647");
  expectRejected({std::numeric_limits<pcl::index_t>::min(), 0, 1, 2, 3}, "-2147483648");
}

TEST(PclBadIndices, OfAnEarlierLargerCloudAreRejected) {
  Random random(1);
  const Cloud::Ptr large = cloudOf(boxesAround(random, 50, 4));
  pcl::LiscoClusterExtraction<PointXYZ> extraction;
  extraction.setInputCloud(large);
  extraction.setIndices(shuffledIndices(random, large->size()));
  Clusters clusters;
  extraction.extract(clusters);
  EXPECT_FALSE(clusters.empty());
  extraction.setInputCloud(fivePoints());
  testing::internal::CaptureStderr();
  extraction.extract(clusters);
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(clusters.empty());
}

TEST(PclIndexType, HoldsAsManyPointsAsIndexT) {
  using pcl::detail::LiscoCloudClusterer;
  const auto most = static_cast<std::size_t>(std::numeric_limits<pcl::index_t>::max());
  EXPECT_TRUE(LiscoCloudClusterer::fitsIndexType(0));
  EXPECT_TRUE(LiscoCloudClusterer::fitsIndexType(most));
  EXPECT_FALSE(LiscoCloudClusterer::fitsIndexType(most + 1));
  EXPECT_FALSE(LiscoCloudClusterer::fitsIndexType(std::size_t{1} << 32));
  EXPECT_FALSE(LiscoCloudClusterer::fitsIndexType(std::numeric_limits<std::size_t>::max()));
}

// NaN, infinite and (0, 0, 0) points are in no cluster, for any is_dense and any indices.
TEST(PclNoReturn, IsInNoCluster) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  auto cloud = fivePoints();
  cloud->push_back(PointXYZ(kNan, 1, 1));
  cloud->push_back(PointXYZ(1, kInfinity, 1));
  cloud->push_back(PointXYZ(1, 1, -kInfinity));
  cloud->push_back(PointXYZ(0, 0, 0));
  cloud->push_back(PointXYZ(-0.0F, 0, -0.0F));
  cloud->push_back(PointXYZ(0, 0, 1e-40F));  // a denormal, but a return
  for (const bool is_dense : {false, true})
    for (const double tolerance : {0.2, 0.0, 100.0, static_cast<double>(kInfinity), static_cast<double>(kNan)}) {
      cloud->is_dense = is_dense;
      SCOPED_TRACE(tolerance);
      Random random(1);
      for (const pcl::IndicesPtr& indices : {pcl::IndicesPtr(), shuffledIndices(random, cloud->size())}) {
        const Clusters clusters = expectSameAsPcl<PointXYZ>(cloud, indices, {tolerance});
        EXPECT_EQ(clusters.size(), tolerance > 0.0 && tolerance < 1.0 ? 2U : (tolerance > 1.0 ? 1U : 6U));
      }
    }
}

TEST(PclNoReturn, AddsNothingIfThereAreNoOthers) {
  const auto cloud = std::make_shared<Cloud>(4, 3, PointXYZ(0, 0, 0));
  for (const bool is_dense : {false, true}) {
    cloud->is_dense = is_dense;
    LiscoClient<PointXYZ> lisco;
    Clusters clusters = anyClusters();
    lisco.extract(cloud, nullptr, {0.5}, clusters);
    ASSERT_EQ(clusters.size(), 2U);
    EXPECT_EQ(clusters[0].indices, anyClusters()[0].indices);
  }
}

}  // namespace
}  // namespace lisco_test
