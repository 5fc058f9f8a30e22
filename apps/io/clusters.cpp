// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/clusters.h"

namespace lisco_apps {

std::vector<std::uint32_t> labelsOf(const Clusters& clusters, std::size_t points) {
  std::vector<std::uint32_t> labels(points, 0);
  for (std::size_t i = 0; i < clusters.size(); ++i)
    for (const auto index : clusters[i].indices)
      labels[static_cast<std::size_t>(index)] = static_cast<std::uint32_t>(i + 1);
  return labels;
}

ClusterShape shapeOf(const Cloud& cloud, const pcl::PointIndices& cluster) {
  ClusterShape shape;
  for (const auto index : cluster.indices) shape.add(cloud[static_cast<std::size_t>(index)]);
  return shape;
}

}  // namespace lisco_apps
