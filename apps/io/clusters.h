// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <pcl/PointIndices.h>

#include "io/cloud_file.h"
#include "io/point_geometry.h"

namespace lisco_apps {

using Clusters = std::vector<pcl::PointIndices>;

/// A scan and its clusters, as the writers of pictures and tables need them.
struct ClusteredScan {
  std::string name;        ///< of the input, for titles
  double tolerance = 0;    ///< metres
  Cloud::ConstPtr cloud;   ///< as read
  pcl::Indices clustered;  ///< the points that were clustered: returns above the ground
  Clusters clusters;       ///< largest first
  std::string note;        ///< how it was read; empty if there is nothing to say
  /// The same in a row for each ring, as it was clustered; nullptr if that is the cloud itself.
  std::shared_ptr<const ClusteredScan> arranged;
};

/// Per point of a cloud: 0 = in no cluster, otherwise 1 + the index of its cluster.
/// \param points size of the cloud
inline std::vector<std::uint32_t> labelsOf(const Clusters& clusters, std::size_t points) {
  std::vector<std::uint32_t> labels(points, 0);
  for (std::size_t i = 0; i < clusters.size(); ++i)
    for (const auto index : clusters[i].indices)
      labels[static_cast<std::size_t>(index)] = static_cast<std::uint32_t>(i + 1);
  return labels;
}

inline ClusterShape shapeOf(const Cloud& cloud, const pcl::PointIndices& cluster) {
  ClusterShape shape;
  for (const auto index : cluster.indices) shape.add(cloud[static_cast<std::size_t>(index)]);
  return shape;
}

/// Writes labels.pcd (organized as the input; x y z label), clusters.csv, range_image.png, top_view.png and view.html
/// into a folder, and with `cloud_per_cluster` also clusters/cluster_0001.pcd and so on, largest first. All or nothing;
/// replaces the files of an earlier run and refuses to replace any other file of these names, see writeOwnFolder ().
/// \throws std::runtime_error with one line on what cannot be written, or would be overwritten
void writeResults(const ClusteredScan& scan, const fs::path& folder, bool cloud_per_cluster);

}  // namespace lisco_apps
