// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// A simulated sensor of 16 lasers turns twice among three posts; its columns are clustered during the rotations.
#include <cmath>
#include <cstdio>
#include <vector>

#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_endless_extraction.h>
#include <pcl/segmentation/lisco_stream_extraction.h>

constexpr int kLasers = 16;
constexpr int kSteps = 1800;  // a turn

// A column of one step: posts 5, 10 and 15 metres away, the first of them at the beginning and end of a turn.
std::vector<pcl::PointXYZ, Eigen::aligned_allocator<pcl::PointXYZ>> measureColumn(int step) {
  std::vector<pcl::PointXYZ, Eigen::aligned_allocator<pcl::PointXYZ>> column(kLasers, pcl::PointXYZ(0, 0, 0));
  const double azimuth = 2 * M_PI * step / kSteps;
  for (const double post : {0.0, 2.0, 4.0})
    if (std::fabs(std::remainder(azimuth - post, 2 * M_PI)) < 0.03)
      for (int laser = 0; laser < kLasers; ++laser) {
        const double range = 5 + 2.5 * post;
        column[laser].x = static_cast<float>(range * std::cos(azimuth));
        column[laser].y = static_cast<float>(range * std::sin(azimuth));
        column[laser].z = static_cast<float>(range * 0.02 * (laser - 8));
      }
  return column;  // (0, 0, 0) and NaN are no returns
}

int main() {
  // Rotation by rotation: the clusters of PCL's EuclideanClusterExtraction, right after the last column.
  pcl::LiscoStreamExtraction<pcl::PointXYZ> stream;
  stream.setClusterTolerance(0.4);  // metres
  stream.setMinClusterSize(10);

  // Endlessly: each cluster as soon as no later column can reach it, whole across the borders of turns.
  pcl::LiscoEndlessExtraction<pcl::PointXYZ> endless;
  endless.setClusterTolerance(0.4);
  endless.setMinClusterSize(10);
  endless.setStagger(0.02);  // radians: all lasers of a column have one azimuth
  endless.setColumnsPerTurn(kSteps);
  endless.setClusterCallback([](const pcl::LiscoEndlessCluster<pcl::PointXYZ>& cluster) {
    std::printf("endless: %zu points, turns %.3f to %.3f\n", cluster.cloud.size(), cluster.first_position,
                cluster.last_position);
  });
  endless.beginStream();

  for (int turn = 0; turn < 2; ++turn) {
    stream.beginRotation();
    for (int step = 0; step < kSteps; ++step) {
      const auto column = measureColumn(step);
      stream.addColumn(column.data(), column.size());
      endless.addColumn(column.data(), column.size());
      if (step % 600 == 599)
        std::printf("turn %d, step %d: %zu subclusters so far\n", turn, step, stream.getNumberOfSubclusters());
    }
    std::vector<pcl::PointIndices> clusters;
    pcl::PointCloud<pcl::PointXYZ> cloud;  // organized: the clusters' indices are of its points
    stream.endRotation(clusters, cloud);
    for (const auto& cluster : clusters)
      std::printf("turn %d: %zu points, first near (%.1f, %.1f)\n", turn, cluster.indices.size(),
                  cloud[cluster.indices[0]].x, cloud[cluster.indices[0]].y);
  }
  endless.finish();
}
