// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "view/clustered_view.h"

#include <fstream>

#include "drawing/scan_pictures.h"
#include "view/page.h"
#include "view/rows.h"
#include "view/scan_encoder.h"

namespace lisco_apps {

ViewScan viewScanOf(const ClusteredScan& scan, const pcl::Indices& clustered) {
  const Cloud& cloud = *scan.cloud;
  ViewScan view;
  view.name = scan.name;
  view.seen_by_camera = seenByCamera(cloud);
  view.points.reserve(cloud.size());
  for (const auto& point : cloud) view.points.push_back({point.x, point.y, point.z});
  view.is_ground.assign(cloud.size(), 1);
  for (const auto index : clustered) view.is_ground[static_cast<std::size_t>(index)] = 0;
  view.ring = rowsOf(cloud.width, cloud.height);
  view.labellings.push_back({"clusters", scan.tolerance, labelsOf(scan.clusters, cloud.size()), {}});
  return view;
}

void writeView(const ClusteredScan& scan, const pcl::Indices& clustered, const fs::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << viewPage(scan.name, {encodeViewScan(viewScanOf(scan, clustered))});
  stream.close();
  if (!stream) fail(file, "cannot be written");
}

}  // namespace lisco_apps
