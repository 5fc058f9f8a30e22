// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "drawing/canvas.h"
#include "io/clusters.h"
#include "io/text.h"

namespace lisco_apps {

/// The scan as the sensor sees it, one cell per laser and step (an unorganized scan is projected by azimuth and
/// elevation): clusters in colours, noise grey, ground dark, no return black.
/// \throws std::runtime_error if the file cannot be written
void drawRangeImage(const ClusteredScan& scan, const fs::path& png);

/// The scan from above, x (forward) up and y to the left, with the sensor, rings of equal range and a scale. A camera's
/// cloud (all points ahead in +z) is shown with z up and x to the right.
/// \throws std::runtime_error if the file cannot be written
void drawTopView(const ClusteredScan& scan, const fs::path& png);

// Shared by both pictures. Lengths in pixels.
constexpr int kHeaderHeight = 44;
constexpr double kHeaderBaseline = 28;
constexpr double kTitleSize = 17;
constexpr double kLabelSize = 13;

/// The colour of each point of the cloud, 0xAARRGGBB.
/// \param shade_by_range darkens distant points, which gives a view from the sensor its depth
std::vector<std::uint32_t> pointColors(const ClusteredScan& scan, bool shade_by_range);

/// Writes the title at the left of the header and the meaning of the colours at its right.
/// \param left, right ends of the header
void drawHeader(Canvas& canvas, const ClusteredScan& scan, double left, double right);

/// Whether the points lie ahead of a camera (+z forward) instead of around a LiDAR.
bool seenByCamera(const Cloud& cloud);

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
double roundLength(double length);

}  // namespace lisco_apps
