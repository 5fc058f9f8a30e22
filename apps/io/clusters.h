// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/PointIndices.h>

#include "io/cloud_file.h"
#include "io/scan_options.h"
#include "io/scan_returns.h"
#include "lisco/cluster_features.h"

namespace lisco_apps {

using Clusters = std::vector<pcl::PointIndices>;

/// A scan and its clusters, as the writers of pictures and tables need them.
struct ClusteredScan {
  std::string name;                              ///< of the input, for titles
  double tolerance = 0;                          ///< metres
  unsigned min_size = 0;                         ///< of clusters
  std::optional<unsigned> max_size;              ///< the same, if there is a limit
  GroundChoice ground;                           ///< as asked for
  Cloud::ConstPtr cloud;                         ///< as read
  pcl::PCLPointCloud2 fields;                    ///< all fields of the input; empty if x, y, z are all
  ScanReturns returns;                           ///< of the cloud
  Clusters clusters;                             ///< largest first
  std::vector<lisco::ClusterFeatures> features;  ///< of the clusters
  std::string note;                              ///< how it was read; empty if there is nothing to say
  /// The same in a row for each ring, as it was clustered, with the same clusters in the same order; nullptr if that is
  /// the cloud itself.
  std::shared_ptr<const ClusteredScan> arranged;

  /// Whether ground has been looked for.
  bool isGroundKnown() const { return ground.method != GroundChoice::Method::kNone && returns.is_rotating; }
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

/// Per point of a scan's cloud: 1 = left out as ground, otherwise 0.
inline std::vector<std::uint8_t> groundOf(const ClusteredScan& scan) {
  std::vector<std::uint8_t> ground(scan.cloud->size(), 0);
  for (const auto index : scan.returns.ground) ground[static_cast<std::size_t>(index)] = 1;
  return ground;
}

}  // namespace lisco_apps
