// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "io/clusters.h"
#include "view/view_scan.h"

namespace lisco_apps {

/// A scan and its clusters as the page shows them. Without a field of rings, rows of an organized scan are rings.
/// \param clustered the points that were clustered; other returns are ground
ViewScan viewScanOf(const ClusteredScan& scan, const pcl::Indices& clustered);

/// Writes a page that shows a scan and its clusters.
/// \throws std::runtime_error with one line if it cannot be written
void writeView(const ClusteredScan& scan, const pcl::Indices& clustered, const fs::path& file);

}  // namespace lisco_apps
