// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// before.cpp after its change from PCL to Lisco; both print the same.
#include <cstdio>
#include <vector>

#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "example_scan.h"

int main() {
  const pcl::PointCloud<pcl::PointXYZI>::Ptr cloud = exampleScan();
  std::vector<pcl::PointIndices> clusters;
  pcl::LiscoClusterExtraction<pcl::PointXYZI> ec;
  ec.setClusterTolerance(0.4);
  ec.setMinClusterSize(10);
  ec.setInputCloud(cloud);
  ec.extract(clusters);
  print(clusters);
}
