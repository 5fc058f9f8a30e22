// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <string>

#include "io/cloud_file.h"
#include "io/scan_options.h"

namespace lisco_apps {

/// What becomes of the returns of a scan.
struct ScanReturns {
  pcl::Indices clustered;   ///< the rest, in the cloud's order
  pcl::Indices ground;      ///< left out as ground, in the cloud's order
  std::size_t returns = 0;  ///< of the scan
  std::size_t ignored = 0;  ///< left out by range or place
  bool is_rotating = true;  ///< false: the slope method found no scan of a rotating sensor, and left out nothing
};

/// Divides the returns of a cloud. The slope method looks at all returns outside of ignored boxes, so that the ground
/// goes on beyond the range limits.
/// \param is_rotation the cloud is a turn of a sensor that stands upright at the origin; otherwise the place of the
///        sensor is estimated
ScanReturns returnsOf(const Cloud& cloud, const GroundChoice& ground, const Region& region, bool is_rotation = false);

/// Distance between adjacent floats as large as the largest coordinate of some points, metres.
float roundingOf(const Cloud& cloud, const pcl::Indices& points);

/// The lines "ignored" and "ground" of a summary; empty if nothing is to be said.
std::string describe(const ScanReturns& returns, const GroundChoice& ground);

}  // namespace lisco_apps
