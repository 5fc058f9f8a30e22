// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::detail {

/// Columns of points, in the order in which a sensor measured them.
struct Firings {
  std::vector<std::uint32_t> column_of_point;
  std::uint32_t columns = 0;  ///< number of columns
};

/// Cuts points into columns: points within three quarters of the time between firings make one. Several of one row in
/// one firing get columns side by side, so that no two points have the same row and column.
/// \param keys the time or azimuth of each point; finite
/// \param min_step points that differ by less are of one firing
/// \return no columns if no row has two points that differ by more than min_step
Firings cutFirings(const std::vector<double>& keys, const std::vector<std::uint32_t>& row_of_point, std::size_t rows,
                   double min_step);

}  // namespace pcl::detail
