// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>

#include "view/view_scan.h"

namespace lisco_apps {

/// Positions are rounded to multiples of this, metres.
inline constexpr double kViewStep = 0.002;
/// Distance of a rounded position from its point, at most: half the diagonal of a cube of that side, metres.
inline constexpr double kViewError = kViewStep * 0.8660254037844387;
/// Points farther than this from the scan's median along an axis are counted but not shown, metres: the multiples of
/// kViewStep up to it are floats.
inline constexpr double kViewReach = kViewStep * (1 << 23);

/// In which order the points are encoded.
enum class PointOrder {
  kSmallest,  ///< the scan's, or Z-order if that takes fewer bytes
  kAsGiven,   ///< the scan's, in a third of the time
};

/// A text after its size: uint32, little-endian.
std::string withSize(const std::string& text);

/// Encodes a scan for the page (see doc/view.md): the size of a JSON header (uint32, little-endian), the header, and
/// for each property of the points a stream of bytes.
std::string encodeViewScan(const ViewScan& scan, PointOrder order = PointOrder::kSmallest);

}  // namespace lisco_apps
