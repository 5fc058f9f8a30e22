// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The steps of PCL's tutorial on cluster extraction: downsample the cloud, remove the planes, write a cloud for each
// cluster of the rest.
#include <cstdio>
#include <string>
#include <vector>

#include <pcl/ModelCoefficients.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/method_types.h>
#include <pcl/sample_consensus/model_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

int main(int, char** argv) {
  Cloud::Ptr cloud(new Cloud);
  if (pcl::io::loadPCDFile(argv[1], *cloud) < 0) return 1;

  Cloud::Ptr thinned(new Cloud);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(0.01F, 0.01F, 0.01F);
  grid.filter(*thinned);

  pcl::SACSegmentation<pcl::PointXYZ> plane;
  plane.setOptimizeCoefficients(true);
  plane.setModelType(pcl::SACMODEL_PLANE);
  plane.setMethodType(pcl::SAC_RANSAC);
  plane.setMaxIterations(100);
  plane.setDistanceThreshold(0.02);
  const std::size_t enough = thinned->size() / 2;
  while (thinned->size() > enough) {
    pcl::PointIndices::Ptr of_plane(new pcl::PointIndices);
    pcl::ModelCoefficients coefficients;
    plane.setInputCloud(thinned);
    plane.segment(*of_plane, coefficients);
    if (of_plane->indices.empty()) return 1;
    pcl::ExtractIndices<pcl::PointXYZ> extract;
    extract.setInputCloud(thinned);
    extract.setIndices(of_plane);
    extract.setNegative(true);
    Cloud::Ptr rest(new Cloud);
    extract.filter(*rest);
    thinned = rest;
  }

  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  tree->setInputCloud(thinned);
  std::vector<pcl::PointIndices> clusters;
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> ec;
  ec.setClusterTolerance(0.02);
  ec.setMinClusterSize(100);
  ec.setMaxClusterSize(25000);
  ec.setSearchMethod(tree);
  ec.setInputCloud(thinned);
  ec.extract(clusters);

  pcl::PCDWriter writer;
  int number = 0;
  for (const auto& cluster : clusters) {
    Cloud::Ptr points(new Cloud);
    for (const auto& index : cluster.indices) points->push_back((*thinned)[static_cast<std::size_t>(index)]);
    writer.write<pcl::PointXYZ>("cloud_cluster_" + std::to_string(number++) + ".pcd", *points, false);
    std::printf("%zu points\n", points->size());
  }
}
