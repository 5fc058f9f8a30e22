// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "clustering.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lisco_apps {

std::vector<std::uint32_t> ClusteredScan::labels() const {
  std::vector<std::uint32_t> labels(cloud->size(), 0);
  for (std::size_t number = 0; number < clusters.size(); ++number)
    for (const auto& index : clusters[number].indices)
      labels[static_cast<std::size_t>(index)] = static_cast<std::uint32_t>(number + 1);
  return labels;
}

ClusterShape shapeOf(const Cloud& cloud, const pcl::PointIndices& cluster) {
  ClusterShape shape;
  shape.size = cluster.indices.size();
  std::fill_n(shape.lo, 3, std::numeric_limits<float>::infinity());
  std::fill_n(shape.hi, 3, -std::numeric_limits<float>::infinity());
  shape.nearest_range = std::numeric_limits<double>::infinity();
  for (const auto& index : cluster.indices) {
    const pcl::PointXYZ& point = cloud[static_cast<std::size_t>(index)];
    for (int axis = 0; axis < 3; ++axis) {
      shape.centroid[axis] += static_cast<double>(point.data[axis]) / static_cast<double>(shape.size);
      shape.lo[axis] = std::min(shape.lo[axis], point.data[axis]);
      shape.hi[axis] = std::max(shape.hi[axis], point.data[axis]);
    }
    shape.nearest_range =
        std::min(shape.nearest_range,
                 std::hypot(static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)));
  }
  return shape;
}

}  // namespace lisco_apps
