// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Passes clouds to the library and takes clouds from it, so that each side frees memory that the other one has touched.
// Prints results that are independent of the options it was compiled with.
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <pcl/segmentation/lisco_endless_extraction.h>
#include <pcl/segmentation/lisco_stream_extraction.h>
#include <pcl/segmentation/lisco_window_extraction.h>
#include <Eigen/Core>

namespace {

using Point = pcl::PointXYZI;
using Cloud = pcl::PointCloud<Point>;
using Clusters = std::vector<pcl::PointIndices>;

constexpr std::size_t kLasers = 16;
constexpr std::size_t kSteps = 900;
constexpr float kTurn = 6.2831853F;

/// A round wall with gates; every third laser sees nothing in every fifth step.
Point pointAt(std::size_t laser, std::size_t step) {
  Point point;
  point.intensity = static_cast<float>(laser);
  const bool gate = step % 90 < 12;
  const bool missing = laser % 3 == 0 && step % 5 == 0;
  const float azimuth = kTurn * static_cast<float>(step) / static_cast<float>(kSteps);
  const float range = gate ? 19.0F : 8.0F;
  point.x = missing ? 0.0F : range * std::cos(azimuth);
  point.y = missing ? 0.0F : range * std::sin(azimuth);
  point.z = missing ? 0.0F : range * 0.03F * (static_cast<float>(laser) - 8.0F);
  return point;
}

std::vector<Point> columnAt(std::size_t step) {
  std::vector<Point> column;
  for (std::size_t laser = 0; laser < kLasers; ++laser) column.push_back(pointAt(laser, step));
  return column;
}

Cloud::Ptr scan() {
  auto cloud = std::make_shared<Cloud>();
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    for (std::size_t step = 0; step < kSteps; ++step) cloud->push_back(pointAt(laser, step));
  cloud->width = kSteps;
  cloud->height = kLasers;
  return cloud;
}

void print(const char* what, const Clusters& clusters) {
  std::size_t sum = 0;
  for (const auto& cluster : clusters)
    for (const auto& index : cluster.indices) sum = sum * 31 + static_cast<std::size_t>(index);
  std::printf("%s: %zu clusters, %zu\n", what, clusters.size(), sum);
}

void print(const char* what, const Cloud& cloud) {
  double sum = 0;
  for (const auto& point : cloud)
    if (std::isfinite(point.x)) sum += static_cast<double>(point.x + point.intensity);
  std::printf("%s: %u x %u points, %.6f\n", what, cloud.width, cloud.height, sum);
}

void extract() {
  Clusters clusters;
  pcl::PointCloud<pcl::Label> labels;
  labels.resize(7);  // the host's; to be replaced
  {
    auto extraction = std::make_unique<pcl::LiscoClusterExtraction<Point>>();
    extraction->setClusterTolerance(0.7);
    for (int i = 0; i < 2; ++i) {
      extraction->setInputCloud(scan());  // the extraction holds the only pointer
      clusters.clear();
      extraction->extract(clusters, labels);
    }
    const auto copy = *extraction;
    std::unique_ptr<pcl::PCLBase<Point>> base = std::move(extraction);  // deleted as one
  }
  print("extract", clusters);
  std::size_t sum = 0;
  for (const auto& label : labels) sum = sum * 31 + label.label;
  std::printf("labels: %u x %u, %zu\n", labels.width, labels.height, sum);
  labels.resize(100000);

  Clusters free_clusters;
  pcl::extractLiscoClusters(*scan(), 0.7F, free_clusters, 10, 100000);
  print("extractLiscoClusters", free_clusters);
}

void stream() {
  Clusters clusters;
  auto cloud = std::make_shared<Cloud>(3, 5);  // the host's; to be replaced
  {
    pcl::LiscoStreamExtraction<Point> stream;
    stream.setClusterTolerance(0.7);
    for (int turn = 0; turn < 2; ++turn) {
      stream.beginRotation();
      for (std::size_t step = 0; step < kSteps; ++step) {
        stream.addColumn(columnAt(step).data(), kLasers);
        if (step == 100) stream.getCloud(*cloud);
      }
      clusters.clear();
      stream.endRotation(clusters, *cloud);
    }
    auto copy = stream;
    copy.beginRotation();
    for (std::size_t step = 0; step < 2 * kSteps; ++step) copy.addColumn(columnAt(step).data(), kLasers);
    stream = std::move(copy);
  }
  print("stream", clusters);
  print("stream", *cloud);
  cloud->push_back(Point());  // has to grow
  cloud->resize(kLasers * kSteps);
  pcl::LiscoClusterExtraction<Point> extraction;
  extraction.setClusterTolerance(0.7);
  extraction.setInputCloud(cloud);
  cloud.reset();
  clusters.clear();
  extraction.extract(clusters);
  print("of the stream's cloud", clusters);
}

void windows() {
  Clusters clusters;
  Cloud cloud(2, 2);
  pcl::LiscoWindowExtraction<Point> windows;
  windows.setClusterTolerance(0.7);
  windows.setWindowSize(300);
  windows.setHop(100);
  windows.beginStream();
  for (std::size_t step = 0; step < kSteps; ++step)
    if (windows.addColumn(columnAt(step).data(), kLasers)) {
      clusters.clear();
      windows.extract(clusters);
      windows.getWindow(cloud);
    }
  print("window", clusters);
  print("window", cloud);
}

void endless() {
  std::vector<pcl::LiscoEndlessCluster<Point>> delivered;
  Cloud all;
  {
    pcl::LiscoEndlessExtraction<Point> endless;
    endless.setClusterTolerance(0.7);
    endless.setClusterCallback([&](const pcl::LiscoEndlessCluster<Point>& cluster) {
      delivered.push_back(cluster);
      all += cluster.cloud;
    });
    endless.beginStream();
    for (std::size_t step = 0; step < 3 * kSteps; ++step)
      endless.addColumn(columnAt(step % kSteps).data(), kLasers, static_cast<double>(step) / kSteps);
    endless.finish();
  }
  std::printf("endless: %zu clusters\n", delivered.size());
  print("endless", all);
}

}  // namespace

int main() {
  extract();
  stream();
  windows();
  endless();
  std::fprintf(stderr, "Eigen aligns to %d bytes\n", EIGEN_MAX_ALIGN_BYTES);
  return 0;
}
