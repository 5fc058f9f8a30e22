// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Clusters a point cloud message of a LiDAR's driver; a ROS node gets it by pcl_conversions::toPCL ().
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/lisco_point_cloud2.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

// A message of a Velodyne's driver: one row of points, x y z intensity ring time, 22 bytes each. Two posts.
pcl::PCLPointCloud2 exampleMessage() {
  pcl::PCLPointCloud2 message;
  const auto add_field = [&](const char* name, std::uint8_t type, pcl::uindex_t offset) {
    message.fields.emplace_back();
    message.fields.back().name = name;
    message.fields.back().datatype = type;
    message.fields.back().offset = offset;
    message.fields.back().count = 1;
  };
  add_field("x", pcl::PCLPointField::FLOAT32, 0);
  add_field("y", pcl::PCLPointField::FLOAT32, 4);
  add_field("z", pcl::PCLPointField::FLOAT32, 8);
  add_field("intensity", pcl::PCLPointField::FLOAT32, 12);
  add_field("ring", pcl::PCLPointField::UINT16, 16);
  add_field("time", pcl::PCLPointField::FLOAT32, 18);
  message.point_step = 22;
  message.height = 1;
  for (int column = 0; column < 1800; ++column)
    for (std::uint16_t ring = 0; ring < 16; ++ring) {
      if (column % 900 >= 20) continue;  // no return: the driver omits it
      const double azimuth = -2 * M_PI * column / 1800;
      const float point[] = {static_cast<float>(8 * std::cos(azimuth)), static_cast<float>(8 * std::sin(azimuth)),
                             0.2F * static_cast<float>(ring), 100.0F};
      const float time = 55.296e-6F * static_cast<float>(column) + 2.304e-6F * ring;
      message.data.resize(message.data.size() + message.point_step);
      std::uint8_t* const bytes = message.data.data() + message.data.size() - message.point_step;
      std::memcpy(bytes, point, 16);
      std::memcpy(bytes + 16, &ring, 2);
      std::memcpy(bytes + 18, &time, 4);
      ++message.width;
    }
  message.row_step = message.width * message.point_step;
  return message;
}

int main() {
  const pcl::PCLPointCloud2 message = exampleMessage();

  pcl::PointCloud<pcl::PointXYZI>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZI>);
  pcl::Indices point_of_cell;
  if (!pcl::organizeLiscoCloud(message, *cloud, point_of_cell)) return 1;  // it prints the reason

  pcl::LiscoClusterExtraction<pcl::PointXYZI> ec;
  ec.setClusterTolerance(0.4);
  ec.setMinClusterSize(10);
  ec.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  ec.extract(clusters);
  pcl::mapLiscoClusters(point_of_cell, clusters);  // from cells to the message's points

  std::printf("%u points as %u rings x %u columns\n", message.width, cloud->height, cloud->width);
  for (const auto& cluster : clusters)
    std::printf("%zu points, the first is number %d\n", cluster.indices.size(), static_cast<int>(cluster.indices[0]));
}
