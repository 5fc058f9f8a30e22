// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// A program for PCL with one include and one class name changed.
#include <cstdio>
#include <memory>
#include <vector>

#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

int main() {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  for (const float x : {5.0F, 1.0F, 5.1F, 1.1F, 1.2F}) {
    pcl::PointXYZI point;
    point.x = x;
    point.y = point.z = 1.0F;
    cloud->push_back(point);
  }
  pcl::LiscoClusterExtraction<pcl::PointXYZI> extraction;
  extraction.setClusterTolerance(0.3);
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  const bool right =
      clusters.size() == 2 && clusters[0].indices == pcl::Indices{1, 3, 4} && clusters[1].indices == pcl::Indices{0, 2};
  std::puts(right ? "two clusters, as expected" : "not the two clusters expected");
  return right ? 0 : 1;
}
