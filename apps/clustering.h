// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <pcl/PointIndices.h>

#include "cloud_file.h"

namespace lisco_apps {

/// A scan and its clusters, as the writers of pictures and tables need them.
struct ClusteredScan {
  std::string name;                         ///< of the input, for titles
  double tolerance = 0;                     ///< metres
  Cloud::ConstPtr cloud;                    ///< as read
  pcl::Indices clustered;                   ///< the points that were clustered: returns above the ground
  std::vector<pcl::PointIndices> clusters;  ///< largest first

  /// Per point of the cloud: 0 = in no cluster, otherwise 1 + the number of its cluster.
  std::vector<std::uint32_t> labels() const;
};

/// What a cluster looks like from outside.
struct ClusterShape {
  std::size_t size = 0;
  double centroid[3] = {0, 0, 0};  ///< metres
  float lo[3], hi[3];              ///< bounding box, metres
  double nearest_range = 0;        ///< from (0, 0, 0), metres
};
ClusterShape shapeOf(const Cloud& cloud, const pcl::PointIndices& cluster);

}  // namespace lisco_apps
