// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lisco/cluster_features.h"

namespace lisco_apps {

/// What the page shows of a cluster. Metres and radians; the box is upright and turned about the z axis.
struct ViewCluster {
  std::size_t size = 0;
  std::array<double, 3> center{};            ///< of the box
  double length = 0, width = 0, height = 0;  ///< of the box
  double yaw = 0;                            ///< of its length, counterclockwise from the x axis
  double nearest_range = 0;
  std::uint32_t id = 0;  ///< shown in place of its number; 0: the number. All clusters of a labelling have one, or none
};

/// \param id see ViewCluster
inline ViewCluster viewClusterOf(const lisco::ClusterFeatures& features, std::uint32_t id = 0) {
  const lisco::OrientedBox& box = features.box;
  return {features.size, box.center, box.length, box.width, box.height, box.yaw, features.nearest_range, id};
}

/// Clusters of a scan's points.
struct ViewLabelling {
  std::string name;                   ///< shown where a scan has several
  double tolerance = 0;               ///< metres; 0: unknown
  std::vector<std::uint32_t> labels;  ///< per point: 0 = in no cluster, otherwise the cluster's number from 1
  std::vector<ViewCluster> clusters;  ///< of numbers 1, 2, ...; the page measures those that are missing
};

/// A scan as the page shows it. Vectors per point have the size of `points` or are empty.
struct ViewScan {
  std::string name;
  std::vector<std::array<float, 3>> points;  ///< metres; those that are no returns are left out
  std::vector<float> intensity;
  std::vector<std::uint16_t> ring;
  std::vector<std::uint8_t> is_ground;    ///< not 0: removed before clustering
  bool seen_by_camera = false;            ///< z ahead and y down, instead of x ahead and z up
  std::vector<ViewLabelling> labellings;  ///< at least one
};

}  // namespace lisco_apps
