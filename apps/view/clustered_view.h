// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "io/clusters.h"
#include "view/view_scan.h"

namespace lisco_apps {

/// A scan and its clusters as the page shows them. Without a field of rings, rows of an organized scan are rings.
/// Returns that were not clustered are ground.
ViewScan viewScanOf(const ClusteredScan& scan);

}  // namespace lisco_apps
