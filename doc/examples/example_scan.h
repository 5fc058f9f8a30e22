// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <cstdio>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

/// An organized scan, 16 lasers x 900 columns, that has a return in each cell: posts before a wall all around.
inline pcl::PointCloud<pcl::PointXYZI>::Ptr exampleScan() {
  pcl::PointCloud<pcl::PointXYZI>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZI>(900, 16));
  for (int laser = 0; laser < 16; ++laser)
    for (int column = 0; column < 900; ++column) {
      const double azimuth = -2 * M_PI * column / 900;
      const double range = column % 75 < 9 ? 4 + column / 75 : 20;
      pcl::PointXYZI& point = cloud->at(column, laser);
      point.x = static_cast<float>(range * std::cos(azimuth));
      point.y = static_cast<float>(range * std::sin(azimuth));
      point.z = static_cast<float>(range * 0.02 * (8 - laser));
    }
  return cloud;
}

/// Everything there is to see of the clusters.
inline void print(const std::vector<pcl::PointIndices>& clusters) {
  for (const auto& cluster : clusters) {
    std::printf("%zu points:", cluster.indices.size());
    for (const auto& index : cluster.indices) std::printf(" %d", static_cast<int>(index));
    std::printf("\n");
  }
}
