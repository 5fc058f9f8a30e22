// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "random.h"
#include "scans.h"

namespace lisco_test {

/// A scan as an organized cloud: rows are lasers. Its header is filled in.
template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr cloudOf(const Scan& scan) {
  auto cloud = std::make_shared<pcl::PointCloud<PointT>>(static_cast<std::uint32_t>(scan.columns),
                                                         static_cast<std::uint32_t>(scan.lasers));
  for (std::size_t i = 0; i < scan.cells.size(); ++i) {
    (*cloud)[i].x = scan.cells[i].x;
    (*cloud)[i].y = scan.cells[i].y;
    (*cloud)[i].z = scan.cells[i].z;
  }
  cloud->is_dense = false;
  cloud->header.frame_id = "lidar";
  cloud->header.stamp = 1234567;
  cloud->header.seq = 89;
  return cloud;
}

/// A rotating scan of boxes around the sensor, with the steps of a real one: columns x lasers cells.
Scan boxesAround(Random& random, std::size_t columns, std::size_t lasers);

/// A depth camera's cloud: z forward, y down, a wall with a few boxes before it.
Scan cameraView(Random& random, std::size_t columns, std::size_t lasers);

/// The points in one row.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr unorganized(const pcl::PointCloud<PointT>& cloud) {
  auto row = std::make_shared<pcl::PointCloud<PointT>>(cloud);
  row->width = static_cast<std::uint32_t>(row->size());
  row->height = 1;
  return row;
}

/// The cloud in a frame in which its sensor is at (x, y, z).
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr displaced(const pcl::PointCloud<PointT>& cloud, float x, float y, float z,
                                                bool with_origin) {
  auto moved = std::make_shared<pcl::PointCloud<PointT>>(cloud);
  for (PointT& point : *moved) {
    if (!lisco::isReturn(point.x, point.y, point.z)) continue;
    point.x += x;
    point.y += y;
    point.z += z;
  }
  if (with_origin) moved->sensor_origin_ << x, y, z, 0.0F;
  return moved;
}

/// The cloud of doc/contract.md: at kMissingTolerance the search of PCL's kd-tree misses a pair of neighbours. 23
/// points, of which 0 and 1 are the pair.
constexpr double kMissingTolerance = 0.450000107;
inline pcl::PointCloud<pcl::PointXYZ>::Ptr cloudWithAMissedPair() {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  const pcl::PointXYZ p(0.102015592F, 0.107390307F, 0.184661239F);
  cloud->push_back(p);
  cloud->push_back({0.368932515F, 0.374665797F, 0.429241002F});
  constexpr float kY = 6.24102783F;
  constexpr float kZ = 8.30695152F;
  for (int i = 0; i < 16; ++i) cloud->push_back({p.x - 0.25F * static_cast<float>(i), kY, kZ});
  for (const float x : {4.73547411F, -4.26452589F}) cloud->push_back({x, kY, kZ});
  cloud->push_back({-4.26452589F, -5.75897217F, -7.69304895F});
  cloud->push_back({0.23547405F, 0.107390307F, kZ});
  cloud->push_back({0.23547405F, -5.75897217F, kZ});
  return cloud;
}

/// All indices of a cloud of this size, shuffled.
inline pcl::IndicesPtr shuffledIndices(Random& random, std::size_t size) {
  auto indices = std::make_shared<pcl::Indices>(size);
  for (std::size_t i = 0; i < size; ++i) (*indices)[i] = static_cast<pcl::index_t>(i);
  random.shuffle(*indices);
  return indices;
}

}  // namespace lisco_test
