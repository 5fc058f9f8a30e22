// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "view/compared_view.h"

#include <cstdint>

#include "io/text.h"
#include "view/rows.h"

namespace lisco_apps {

ViewScan viewScanOf(const ComparedCloud& cloud, const std::string& name) {
  ViewScan view;
  view.name = name;
  for (const auto& point : cloud) view.points.push_back({point.x, point.y, point.z});
  view.ring = rowsOf(cloud.width, cloud.height);
  return view;
}

void addLabelling(ViewScan& scan, const Baseline& baseline, double tolerance, const Clusters& clusters) {
  scan.labellings.push_back({formatted("%s, %g m", baseline.title.c_str(), tolerance),
                             tolerance,
                             labelsOf(clusters, scan.points.size()),
                             {}});
}

}  // namespace lisco_apps
