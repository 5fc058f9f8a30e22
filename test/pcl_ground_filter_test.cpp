// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include <pcl/PointIndices.h>
#include <pcl/filters/lisco_ground_filter.h>
#include <pcl/point_types.h>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

constexpr float kGround = -1.8F;

/// A sensor 1.8 m above a plane; a wall 20 m away all around it. Every tenth cell is no return.
Cloud::Ptr scan(std::uint32_t lasers = 32, std::uint32_t columns = 1000) {
  auto cloud = std::make_shared<Cloud>(columns, lasers);
  for (std::uint32_t laser = 0; laser < lasers; ++laser)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double azimuth = 2.0 * M_PI * column / columns;
      const double slope = std::tan((5.0 - 30.0 * laser / lasers) * M_PI / 180.0);
      const double rho = std::min(20.0, slope < 0.0 ? static_cast<double>(kGround) / slope : 20.0);
      auto& point = cloud->at(column, laser);
      point.x = static_cast<float>(rho * std::cos(azimuth));
      point.y = static_cast<float>(rho * std::sin(azimuth));
      point.z = static_cast<float>(rho * slope);
      point.intensity = static_cast<float>(laser);
      if ((laser + column) % 10 == 0) point.x = std::numeric_limits<float>::quiet_NaN();
      if ((laser + column) % 10 == 1 && laser == 3) point.x = point.y = point.z = 0.0F;
    }
  cloud->is_dense = false;
  return cloud;
}

bool isMeasured(const pcl::PointXYZI& point) {
  return std::isfinite(point.x) && !(point.x == 0.0F && point.y == 0.0F && point.z == 0.0F);
}

void expectGround(const Cloud& cloud, const pcl::Indices& indices) {
  std::size_t on_ground = 0;
  for (const auto index : indices) {
    ASSERT_TRUE(isMeasured(cloud[index]));
    EXPECT_LT(cloud[index].z, kGround + 0.25F);
    on_ground += cloud[index].z < kGround + 0.001F;
  }
  const auto all = std::count_if(cloud.begin(), cloud.end(),
                                 [](const auto& point) { return isMeasured(point) && point.z < kGround + 0.001F; });
  EXPECT_GT(all, 10000);
  EXPECT_EQ(on_ground, static_cast<std::size_t>(all));
}

TEST(PclGroundFilter, LeavesAllButTheGround) {
  const auto cloud = scan();
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter(true);
  filter.setInputCloud(cloud);
  pcl::Indices objects;
  filter.filter(objects);
  const pcl::Indices removed = *filter.getRemovedIndices();
  EXPECT_EQ(objects.size() + removed.size(), cloud->size());
  filter.setNegative(true);
  pcl::Indices ground;
  filter.filter(ground);
  expectGround(*cloud, ground);
  for (const auto index : objects) ASSERT_TRUE(isMeasured((*cloud)[index]));
  const std::set<pcl::index_t> left(objects.begin(), objects.end());
  for (const auto index : ground) ASSERT_EQ(left.count(index), 0U);
  const auto measured = std::count_if(cloud->begin(), cloud->end(), isMeasured);
  EXPECT_EQ(objects.size() + ground.size(), static_cast<std::size_t>(measured));
  EXPECT_TRUE(std::is_sorted(objects.begin(), objects.end()));
}

TEST(PclGroundFilter, FiltersUnorganizedCloudsInAnyOrder) {
  const auto organized = scan();
  Cloud cloud(*organized);
  std::mt19937 random(7);
  std::shuffle(cloud.points.begin(), cloud.points.end(), random);
  cloud.width = static_cast<std::uint32_t>(cloud.size());
  cloud.height = 1;
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  filter.setInputCloud(cloud.makeShared());
  filter.setNegative(true);
  pcl::Indices ground;
  filter.filter(ground);
  expectGround(cloud, ground);
}

TEST(PclGroundFilter, TakesOneColumnForAnUnorganizedCloud) {
  const auto cloud = scan();
  cloud->width *= cloud->height;
  cloud->height = 1;
  const auto column = std::make_shared<Cloud>(*cloud);
  std::swap(column->width, column->height);
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  filter.setNegative(true);
  pcl::Indices of_row, of_column;
  filter.setInputCloud(cloud);
  filter.filter(of_row);
  filter.setInputCloud(column);
  filter.filter(of_column);
  expectGround(*cloud, of_row);
  EXPECT_EQ(of_column, of_row);
}

TEST(PclGroundFilter, WritesItsIndicesOverThoseGiven) {
  const auto cloud = scan();
  auto given = std::make_shared<pcl::Indices>(cloud->size() / 2);
  std::iota(given->begin(), given->end(), 0);
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  filter.setInputCloud(cloud);
  filter.setIndices(given);
  pcl::Indices apart;
  filter.filter(apart);
  ASSERT_FALSE(apart.empty());
  ASSERT_LT(apart.size(), given->size());
  filter.filter(*given);
  EXPECT_EQ(*given, apart);
}

TEST(PclGroundFilter, KeepsTheCloudOrganized) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "PCL's library allocates the cloud, and Eigen frees it differently in sanitized code";
#endif
  const auto cloud = scan();
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter(true);
  filter.setInputCloud(cloud);
  filter.setKeepOrganized(true);
  Cloud objects;
  filter.filter(objects);
  ASSERT_EQ(objects.width, cloud->width);
  ASSERT_EQ(objects.height, cloud->height);
  EXPECT_FALSE(objects.is_dense);
  for (const auto index : *filter.getRemovedIndices()) ASSERT_TRUE(std::isnan(objects[index].x));
  for (std::size_t i = 0; i < cloud->size(); ++i) ASSERT_EQ(objects[i].intensity, (*cloud)[i].intensity);
}

TEST(PclGroundFilter, LeavesTheGroundOfIndexedPointsIfNegative) {
  const auto cloud = scan();
  auto given = std::make_shared<pcl::Indices>();
  for (pcl::index_t i = 0; i < static_cast<pcl::index_t>(cloud->size()); ++i)
    if (i % 4 != 0) given->push_back(i);
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter(true);
  filter.setInputCloud(cloud);
  filter.setIndices(given);
  filter.setNegative(true);
  pcl::Indices ground;
  filter.filter(ground);
  pcl::PointIndices removed;
  filter.getRemovedIndices(removed);
  EXPECT_GT(ground.size(), 7000U);
  for (const auto index : ground) {
    ASSERT_NE(index % 4, 0);
    ASSERT_LT((*cloud)[index].z, kGround + 0.25F);
  }
  pcl::Indices all(ground);
  all.insert(all.end(), removed.indices.begin(), removed.indices.end());
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, *given);
  filter.setNegative(false);
  pcl::Indices objects;
  filter.filter(objects);
  for (const auto index : objects)
    ASSERT_TRUE(std::binary_search(removed.indices.begin(), removed.indices.end(), index));
}

TEST(PclGroundFilter, KeepsTheGroundOrganizedIfNegative) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "PCL's library allocates the cloud, and Eigen frees it differently in sanitized code";
#endif
  const auto cloud = scan();
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter(true);
  filter.setInputCloud(cloud);
  filter.setKeepOrganized(true);
  filter.setUserFilterValue(-7.0F);
  filter.setNegative(true);
  Cloud ground;
  filter.filter(ground);
  ASSERT_EQ(ground.width, cloud->width);
  ASSERT_EQ(ground.height, cloud->height);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    if (ground[i].z == -7.0F) continue;
    ++kept;
    ASSERT_EQ(ground[i].z, (*cloud)[i].z);
    ASSERT_LT(ground[i].z, kGround + 0.25F);
  }
  EXPECT_EQ(kept + filter.getRemovedIndices()->size(), cloud->size());
  EXPECT_GT(kept, 10000U);
}

TEST(PclGroundFilter, LooksAtIndexedPointsOnly) {
  const auto cloud = scan();
  auto given = std::make_shared<pcl::Indices>();
  for (pcl::index_t i = static_cast<pcl::index_t>(cloud->size()); i-- > 0;)
    if (i % 3 != 0) given->push_back(i);
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter(true);
  filter.setInputCloud(cloud);
  filter.setIndices(given);
  pcl::Indices objects;
  filter.filter(objects);
  EXPECT_EQ(objects.size() + filter.getRemovedIndices()->size(), given->size());
  EXPECT_TRUE(std::is_sorted(objects.rbegin(), objects.rend()));  // in the order given
  for (const auto index : objects) ASSERT_NE(index % 3, 0);
}

TEST(PclGroundFilter, RejectsBadParameters) {
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  filter.setInputCloud(scan());
  pcl::Indices objects{1, 2, 3};
  filter.setMaxSlope(90.0F);
  filter.filter(objects);
  EXPECT_TRUE(objects.empty());
  filter.setMaxSlope(20.0F);
  filter.setSensorHeight(std::numeric_limits<float>::infinity());
  filter.filter(objects);
  EXPECT_TRUE(objects.empty());
  filter.setSensorHeight(1.8F);
  filter.filter(objects);
  EXPECT_FALSE(objects.empty());
  auto nowhere = scan();
  nowhere->sensor_origin_[1] = std::numeric_limits<float>::quiet_NaN();
  filter.setInputCloud(nowhere);
  filter.filter(objects);
  EXPECT_TRUE(objects.empty());
}

TEST(PclGroundFilter, ReportsIndicesBeyondTheCloud) {
  const auto cloud = scan();
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter(true);
  filter.setInputCloud(cloud);
  for (const pcl::index_t index : {-1, static_cast<pcl::index_t>(cloud->size())}) {
    const pcl::Indices some{3, index, 5};
    filter.setIndices(std::make_shared<pcl::Indices>(some));
    pcl::Indices objects{1, 2, 3};
    filter.setKeepOrganized(false);
    filter.filter(objects);
    EXPECT_TRUE(objects.empty());
    EXPECT_TRUE(filter.getRemovedIndices()->empty());
    Cloud output(*cloud);  // has memory: sanitizers refuse that of PCL's library to be freed here
    for (pcl::PointXYZI& point : output) point.intensity = -1.0F;
    filter.setKeepOrganized(true);
    filter.filter(output);
    ASSERT_EQ(output.size(), cloud->size());
    for (std::size_t i = 0; i < output.size(); ++i) EXPECT_EQ(output[i].intensity, (*cloud)[i].intensity);
  }
}

TEST(PclGroundFilter, GivesRepeatedIndicesAsOften) {
  const auto cloud = scan();
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  filter.setInputCloud(cloud);
  pcl::Indices once, twice;
  filter.filter(once);
  pcl::Indices repeated(2 * cloud->size());
  for (std::size_t i = 0; i < repeated.size(); ++i) repeated[i] = static_cast<pcl::index_t>(i / 2);
  filter.setIndices(std::make_shared<pcl::Indices>(repeated));
  filter.filter(twice);
  ASSERT_EQ(twice.size(), 2 * once.size());
  for (std::size_t i = 0; i < twice.size(); ++i) EXPECT_EQ(twice[i], once[i / 2]);
}

TEST(PclGroundFilter, FiltersCloudsOfOtherShapesInTurn) {
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  auto unorganized = scan(16, 900);
  unorganized->width = static_cast<std::uint32_t>(unorganized->size());
  unorganized->height = 1;
  const std::vector<Cloud::Ptr> clouds{scan(64, 1000), unorganized, std::make_shared<Cloud>(), scan(16, 300), scan(32)};
  for (int round = 0; round < 2; ++round)
    for (const Cloud::Ptr& cloud : clouds) {
      pcl::LiscoGroundFilter<pcl::PointXYZI> fresh;
      pcl::Indices objects, expected;
      fresh.setInputCloud(cloud);
      fresh.filter(expected);
      filter.setInputCloud(cloud);
      filter.filter(objects);
      EXPECT_EQ(objects, expected) << cloud->size();
    }
}

TEST(PclGroundFilter, AcceptsCloudsWithoutReturns) {
  pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
  auto cloud = std::make_shared<Cloud>(100, 16);
  filter.setInputCloud(cloud);
  pcl::Indices objects;
  filter.filter(objects);
  EXPECT_TRUE(objects.empty());
}

}  // namespace
