// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// What PCL's people detector and others use besides the class's common calls: the class and the kd-tree within a
// template, neither tree nor comparePointClusters included by name, and the free functions with a tree.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/extract_clusters.h>

namespace {

using Clusters = std::vector<pcl::PointIndices>;

template <typename PointT>
class Detector {
 public:
  using Cloud = pcl::PointCloud<PointT>;

  void detect(const typename Cloud::Ptr& cloud, Clusters& clusters) {
    typename pcl::search::KdTree<PointT>::Ptr tree(new pcl::search::KdTree<PointT>);
    tree->setInputCloud(cloud);
    pcl::EuclideanClusterExtraction<PointT> ec;
    ec.setClusterTolerance(0.03);
    ec.setMinClusterSize(5);
    ec.setMaxClusterSize(5000);
    ec.setSearchMethod(tree);
    ec.setInputCloud(cloud);
    ec.extract(clusters);
  }

  void detectSome(const typename Cloud::Ptr& cloud, const pcl::IndicesPtr& indices, Clusters& clusters) {
    typename pcl::search::Search<PointT>::Ptr tree(new pcl::search::KdTree<PointT>);
    tree->setInputCloud(cloud, indices);
    pcl::extractEuclideanClusters<PointT>(*cloud, *indices, tree, 0.03F, clusters, 5, 5000);
    tree->setInputCloud(cloud);
    pcl::extractEuclideanClusters<PointT>(*cloud, tree, 0.03F, clusters, 5);
    std::sort(clusters.begin(), clusters.end(), pcl::comparePointClusters);
  }
};

template <typename PointT>
bool write(const char* input, const char* output) {
  const typename pcl::PointCloud<PointT>::Ptr cloud(new pcl::PointCloud<PointT>);
  if (pcl::io::loadPCDFile(input, *cloud) < 0) return false;
  const auto indices = std::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < cloud->size(); i += 2) indices->push_back(static_cast<pcl::index_t>(i));
  Detector<PointT> detector;
  Clusters all;
  Clusters some;
  detector.detect(cloud, all);
  detector.detectSome(cloud, indices, some);

  std::FILE* const file = std::fopen(output, "w");
  if (!file) return false;
  for (const Clusters* clusters : {&all, &some})
    for (const auto& cluster : *clusters) {
      for (const auto& index : cluster.indices) std::fprintf(file, "%d ", static_cast<int>(index));
      std::fputc('\n', file);
    }
  std::fclose(file);
  return true;
}

}  // namespace

int main(int, char** argv) {
  const bool good = write<pcl::PointXYZ>(argv[1], "xyz.txt") && write<pcl::PointXYZI>(argv[1], "xyzi.txt");
  return good ? 0 : 1;
}
