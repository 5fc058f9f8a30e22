// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The steps of PCL's tool pcl_cluster_extraction: clusters of a cloud of any fields, each written with all of them.
// Like the tool, it uses the kd-tree without including it.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/conversions.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/extract_clusters.h>

int main(int, char** argv) {
  const pcl::PCLPointCloud2::Ptr input(new pcl::PCLPointCloud2);
  if (pcl::io::loadPCDFile(argv[1], *input) < 0) return 1;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr xyz(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::fromPCLPointCloud2(*input, *xyz);

  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  tree->setInputCloud(xyz);
  std::vector<pcl::PointIndices> clusters;
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> ec;
  ec.setClusterTolerance(0.03);
  ec.setMinClusterSize(20);
  ec.setMaxClusterSize(25000);
  ec.setSearchMethod(tree);
  ec.setInputCloud(xyz);
  ec.extract(clusters);

  pcl::PCDWriter writer;
  int number = 0;
  for (const auto& cluster : clusters) {
    pcl::ExtractIndices<pcl::PCLPointCloud2> extract;
    extract.setInputCloud(input);
    extract.setIndices(std::make_shared<const pcl::PointIndices>(cluster));
    pcl::PCLPointCloud2 output;
    extract.filter(output);
    writer.writeBinaryCompressed("cluster_" + std::to_string(number++) + ".pcd", output);
    std::printf("%u points\n", output.width * output.height);
  }
}
