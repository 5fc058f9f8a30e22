// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/features/lisco_cluster_features.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

/// Two walls: 4 m along y at x = 10, 1 m high, and 2 m at 45 degrees, further away.
Cloud::Ptr twoWalls() {
  auto cloud = std::make_shared<Cloud>();
  const auto add = [&cloud](float x, float y, float z) {
    pcl::PointXYZI point;
    point.x = x;
    point.y = y;
    point.z = z;
    cloud->push_back(point);
  };
  for (int row = 0; row < 3; ++row)
    for (int i = 0; i <= 40; ++i) {
      add(10, -2 + 0.1F * static_cast<float>(i), 0.5F * static_cast<float>(row));
      const float along = 0.05F * static_cast<float>(i) * std::sqrt(0.5F);
      add(20 + along, 5 + along, 0.5F * static_cast<float>(row));
    }
  return cloud;
}

TEST(PclClusterFeatures, DescribesEachCluster) {
  const Cloud::Ptr cloud = twoWalls();
  pcl::LiscoClusterExtraction<pcl::PointXYZI> extraction;
  extraction.setClusterTolerance(0.6);
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  ASSERT_EQ(clusters.size(), 2U);

  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  estimation.setInputCloud(cloud);
  std::vector<lisco::ClusterFeatures> features(7);
  estimation.compute(clusters, features);
  ASSERT_EQ(features.size(), 2U);
  const bool swapped = features[0].centroid[0] > 15;
  const lisco::ClusterFeatures& across = features[swapped ? 1 : 0];
  const lisco::ClusterFeatures& slanting = features[swapped ? 0 : 1];
  EXPECT_EQ(across.size, 123U);
  EXPECT_NEAR(across.box.length, 4, 1e-5);
  EXPECT_NEAR(std::fabs(across.box.yaw), M_PI / 2, 1e-6);
  EXPECT_NEAR(across.nearest_range, 10, 1e-5);
  EXPECT_NEAR(across.density, 123 / 4., 0.1);
  EXPECT_NEAR(slanting.box.length, 2, 1e-5);
  EXPECT_NEAR(slanting.box.width, 0, 1e-5);
  EXPECT_NEAR(slanting.box.yaw, M_PI / 4, 1e-5);
}

TEST(PclClusterFeatures, CountsTheNearestRangeFromTheSensor) {
  auto cloud = twoWalls();
  cloud->sensor_origin_ << 7, 0, 0, 0;
  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  estimation.setInputCloud(cloud);
  estimation.compute();
  lisco::ClusterFeatures features;
  ASSERT_TRUE(estimation.getFeatures(features));
  EXPECT_DOUBLE_EQ(features.nearest_range, 3);
}

TEST(PclClusterFeatures, GivesBoxesAsMomentOfInertiaEstimationDoes) {
  const Cloud::Ptr cloud = twoWalls();
  auto indices = std::make_shared<pcl::Indices>();
  for (std::size_t i = 1; i < cloud->size(); i += 2) indices->push_back(static_cast<pcl::index_t>(i));
  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  pcl::PointXYZI min, max, position;
  Eigen::Matrix3f rotation;
  Eigen::Vector3f center;
  lisco::ClusterFeatures features;
  EXPECT_FALSE(estimation.getAABB(min, max));
  estimation.setInputCloud(cloud);
  estimation.setIndices(indices);
  estimation.compute();
  ASSERT_TRUE(estimation.getFeatures(features));
  ASSERT_TRUE(estimation.getAABB(min, max));
  ASSERT_TRUE(estimation.getMassCenter(center));
  ASSERT_TRUE(estimation.getOBB(min, max, position, rotation));
  EXPECT_EQ(features.size, indices->size());
  EXPECT_NEAR(max.x - min.x, 2, 1e-5);
  EXPECT_NEAR(max.z - min.z, 1, 1e-5);
  EXPECT_LT((position.getVector3fMap() - center).norm(), 1e-4F);
  // A corner of the box, rotated and moved, is an end of the wall.
  const Eigen::Vector3f end = rotation * Eigen::Vector3f(max.x, 0, 0) + position.getVector3fMap();
  EXPECT_NEAR(end.x(), 20 + std::sqrt(2.), 1e-4);
  EXPECT_NEAR(end.y(), 5 + std::sqrt(2.), 1e-4);
}

TEST(PclClusterFeatures, LeavesOutPointsThatAreNotFinite) {
  const Cloud::Ptr cloud = twoWalls();
  (*cloud)[0].x = std::numeric_limits<float>::quiet_NaN();
  (*cloud)[2].y = std::numeric_limits<float>::infinity();
  cloud->is_dense = false;
  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  estimation.setInputCloud(cloud);
  estimation.compute();
  lisco::ClusterFeatures features;
  ASSERT_TRUE(estimation.getFeatures(features));
  EXPECT_EQ(features.size, cloud->size() - 2);
  EXPECT_TRUE(std::isfinite(features.box.length));
}

TEST(PclClusterFeatures, AreThoseOfTheLatestInput) {
  const Cloud::Ptr cloud = twoWalls();
  const auto some = std::make_shared<pcl::Indices>(pcl::Indices{0, 1, 2});
  const auto chosen = std::make_shared<pcl::PointIndices>();
  chosen->indices = *some;
  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  lisco::ClusterFeatures features;
  const auto compute = [&] {
    estimation.setInputCloud(cloud);
    estimation.compute();
    return estimation.getFeatures(features);
  };
  ASSERT_TRUE(compute());
  estimation.setInputCloud(twoWalls());
  EXPECT_FALSE(estimation.getFeatures(features));
  ASSERT_TRUE(compute());
  estimation.setIndices(some);
  EXPECT_FALSE(estimation.getFeatures(features));
  estimation.compute();
  ASSERT_TRUE(estimation.getFeatures(features));
  EXPECT_EQ(features.size, 3U);
  estimation.setIndices(pcl::IndicesConstPtr(some));
  EXPECT_FALSE(estimation.getFeatures(features));
  estimation.compute();
  estimation.setIndices(pcl::PointIndicesConstPtr(chosen));
  EXPECT_FALSE(estimation.getFeatures(features));
  const auto organized = std::make_shared<Cloud>(*cloud);
  organized->width = 3;
  organized->height = static_cast<std::uint32_t>(cloud->size() / 3);
  estimation.setInputCloud(organized);
  estimation.compute();
  ASSERT_TRUE(estimation.getFeatures(features));
  estimation.setIndices(1, 1, 2, 2);
  EXPECT_FALSE(estimation.getFeatures(features));
  estimation.compute();
  ASSERT_TRUE(estimation.getFeatures(features));
  EXPECT_EQ(features.size, 4U);
  estimation.setInputCloud(cloud);
  estimation.setIndices(some);
  // Through the base class as well.
  estimation.compute();
  static_cast<pcl::PCLBase<pcl::PointXYZI>&>(estimation).setInputCloud(twoWalls());
  EXPECT_FALSE(estimation.getFeatures(features));
}

TEST(PclClusterFeatures, NeedAFiniteSensorOrigin) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  auto cloud = twoWalls();
  cloud->sensor_origin_[2] = std::numeric_limits<float>::quiet_NaN();
  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  estimation.setInputCloud(cloud);
  estimation.compute();
  lisco::ClusterFeatures features;
  EXPECT_FALSE(estimation.getFeatures(features));
  std::vector<pcl::PointIndices> clusters(1);
  clusters[0].indices = {0, 1};
  std::vector<lisco::ClusterFeatures> all(3);
  estimation.compute(clusters, all);
  EXPECT_TRUE(all.empty());
  pcl::console::setVerbosityLevel(pcl::console::L_INFO);
}

TEST(PclClusterFeatures, ReportsIndicesBeyondTheCloud) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const Cloud::Ptr cloud = twoWalls();
  std::vector<pcl::PointIndices> clusters(2);
  clusters[0].indices = {0, 1};
  clusters[1].indices = {static_cast<pcl::index_t>(cloud->size())};
  std::vector<lisco::ClusterFeatures> features(3);
  pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
  estimation.compute(clusters, features);
  EXPECT_TRUE(features.empty());
  features.resize(3);
  estimation.setInputCloud(cloud);
  estimation.compute(clusters, features);
  EXPECT_TRUE(features.empty());
  clusters[1].indices = {-1};
  estimation.compute(clusters, features);
  EXPECT_TRUE(features.empty());
  pcl::console::setVerbosityLevel(pcl::console::L_INFO);
}

}  // namespace
