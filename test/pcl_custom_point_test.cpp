// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// A user's own point type: the templates are compiled here, as PCL_NO_PRECOMPILE asks for.
#define PCL_NO_PRECOMPILE
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

namespace lisco_test {

struct LidarPoint {
  PCL_ADD_POINT4D;
  float intensity;
  std::uint16_t ring;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace lisco_test

POINT_CLOUD_REGISTER_POINT_STRUCT(lisco_test::LidarPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)(std::uint16_t,
                                                                                                       ring, ring))

#include "pcl_client.h"
#include "pcl_clouds.h"
#include "pcl_stream.h"

namespace lisco_test {
namespace {

TEST(PclCustomPoint, EqualsPcl) {
  Random random(1);
  const auto cloud = cloudOf<LidarPoint>(boxesAround(random, 120, 8));
  EXPECT_GT((expectSameAsPcl<LidarPoint>(cloud, nullptr, {0.5, 3}).size()), 3U);
  expectSameAsPcl<LidarPoint>(cloud, shuffledIndices(random, cloud->size()), {0.5});
}

TEST(PclCustomPoint, WorksInFreeFunctionsAndLabels) {
  Random random(2);
  const auto cloud = cloudOf<LidarPoint>(boxesAround(random, 60, 4));
  Clusters found;
  pcl::extractLiscoClusters(*cloud, 0.5F, found);
  EXPECT_FALSE(found.empty());
  pcl::LiscoClusterExtraction<LidarPoint> extraction;
  extraction.setInputCloud(cloud);
  extraction.setClusterTolerance(0.5);
  Clusters sorted;
  pcl::PointCloud<pcl::Label> labels;
  extraction.extract(sorted, labels);
  EXPECT_EQ(sorted.size(), found.size());
  EXPECT_EQ(labels.width, 60U);
}

TEST(PclCustomPoint, WorksInStreams) {
  Random random(3);
  const auto columns = columnsOf(*cloudOf<LidarPoint>(boxesAround(random, 120, 8)));
  pcl::LiscoStreamExtraction<LidarPoint> stream;
  expectRotationSameAsPcl(stream, random, columns, {0.5, 3});
  pcl::LiscoWindowExtraction<LidarPoint> windows;
  expectWindowsSameAsPcl(windows, random, columns, {0.5, 3}, 60, 20);
  pcl::LiscoEndlessExtraction<LidarPoint> endless;
  endless.setClusterTolerance(0.5);
  endless.setClockwise(true);
  endless.setColumnsPerTurn(120);
  std::size_t delivered = 0;
  endless.setClusterCallback(
      [&](const pcl::LiscoEndlessCluster<LidarPoint>& cluster) { delivered += cluster.cloud.size(); });
  ASSERT_TRUE(endless.beginStream());
  for (const auto& column : columns) EXPECT_TRUE(endless.addColumn(column));
  endless.finish();
  EXPECT_EQ(delivered, endless.getNumberOfReturns());
  EXPECT_GT(delivered, 100U);
}

}  // namespace
}  // namespace lisco_test
