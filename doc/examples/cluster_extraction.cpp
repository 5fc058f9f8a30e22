// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Reads a scan, removes the ground by height, and writes a cloud for each cluster.
#include <cstdio>
#include <limits>
#include <vector>

#include <pcl/common/io.h>
#include <pcl/filters/passthrough.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: cluster_extraction SCAN.pcd\n");
    return 2;
  }

  // Read in the cloud data
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (pcl::io::loadPCDFile(argv[1], *cloud) < 0) return 1;  // it prints the reason
  std::printf("The scan has %u lasers, %u columns.\n", cloud->height, cloud->width);

  // Remove the ground: the indices of the other points keep the cloud organized
  pcl::IndicesPtr above_ground(new pcl::Indices);
  pcl::PassThrough<pcl::PointXYZ> pass;
  pass.setInputCloud(cloud);
  pass.setFilterFieldName("z");
  pass.setFilterLimits(-1.6F, std::numeric_limits<float>::max());
  pass.filter(*above_ground);
  std::printf("%zu returns are higher than -1.6 m.\n", above_ground->size());

  // Extract the clusters
  pcl::LiscoClusterExtraction<pcl::PointXYZ> ec;
  ec.setClusterTolerance(0.4);  // 40 cm
  ec.setMinClusterSize(10);
  ec.setMaxClusterSize(25000);
  ec.setInputCloud(cloud);
  ec.setIndices(above_ground);
  std::vector<pcl::PointIndices> clusters;
  ec.extract(clusters);

  // Write them
  pcl::PCDWriter writer;
  for (std::size_t j = 0; j < clusters.size(); ++j) {
    pcl::PointCloud<pcl::PointXYZ> cloud_cluster;
    pcl::copyPointCloud(*cloud, clusters[j], cloud_cluster);
    char name[48];
    std::snprintf(name, sizeof(name), "cloud_cluster_%04zu.pcd", j);
    if (writer.writeBinary(name, cloud_cluster) < 0) return 1;
    std::printf("%s: %zu points\n", name, cloud_cluster.size());
  }
}
