// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>

#include "compare/baselines.h"
#include "view/view_scan.h"

namespace lisco_apps {

/// The returns of a compared scan, as yet without labellings. Rows of an organized scan are rings.
ViewScan viewScanOf(const ComparedCloud& cloud, const std::string& name);

/// Adds the clusters that a method found in the cloud of viewScanOf ().
void addLabelling(ViewScan& scan, const Baseline& baseline, double tolerance, const Clusters& clusters);

}  // namespace lisco_apps
