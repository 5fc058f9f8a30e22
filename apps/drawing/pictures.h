// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>

#include "io/clusters.h"

namespace lisco_apps {

/// The scan as the sensor sees it, one cell per laser and step (an unorganized scan is projected by azimuth and
/// elevation): clusters in colours, noise grey, ground dark, no return black.
/// \throws std::runtime_error if the file cannot be written
void drawRangeImage(const ClusteredScan& scan, const std::filesystem::path& png);

/// The scan from above, x (forward) up and y to the left, with the sensor, rings of equal range and a scale. A camera's
/// cloud (all points ahead in +z) is shown with z up and x to the right.
/// \throws std::runtime_error if the file cannot be written
void drawTopView(const ClusteredScan& scan, const std::filesystem::path& png);

}  // namespace lisco_apps
