// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "view/clustered_view.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "drawing/scan_pictures.h"
#include "view/point_fields.h"
#include "view/rows.h"

namespace lisco_apps {

ViewScan viewScanOf(const ClusteredScan& scan) {
  const Cloud& cloud = *scan.cloud;
  ViewScan view;
  view.name = scan.name;
  view.seen_by_camera = seenByCamera(cloud);
  view.points.reserve(cloud.size());
  for (const auto& point : cloud) view.points.push_back({point.x, point.y, point.z});
  view.is_ground.assign(cloud.size(), 1);
  for (const auto index : scan.returns.clustered) view.is_ground[static_cast<std::size_t>(index)] = 0;
  for (const double value : numbersOf(scan.fields, {"intensity", "reflectivity"}, cloud.size()))
    view.intensity.push_back(static_cast<float>(value));
  for (const double value : numbersOf(scan.fields, {"ring", "channel"}, cloud.size()))
    view.ring.push_back(static_cast<std::uint16_t>(value >= 0 ? std::min(value, 65535.0) : 0));
  if (view.ring.empty()) view.ring = rowsOf(cloud.width, cloud.height);
  ViewLabelling labelling{"clusters", scan.tolerance, labelsOf(scan.clusters, cloud.size()), {}};
  for (const lisco::ClusterFeatures& features : scan.features) labelling.clusters.push_back(viewClusterOf(features));
  view.labellings.push_back(std::move(labelling));
  return view;
}

}  // namespace lisco_apps
