// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "pcl/firings.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

pcl::detail::Firings pcl::detail::cutFirings(const std::vector<double>& keys,
                                             const std::vector<std::uint32_t>& row_of_point, std::size_t rows,
                                             double min_step) {
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!std::is_sorted(keys.begin(), keys.end()))
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(keys[a], a) < std::pair(keys[b], b); });

  // The step from one firing to the next: the lower quartile of those between a ring's points, since some firings are
  // without return.
  std::vector<double> last(rows, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> steps;
  steps.reserve(keys.size());
  for (const std::uint32_t point : order) {
    double& before = last[row_of_point[point]];
    if (keys[point] - before > min_step) steps.push_back(keys[point] - before);
    before = keys[point];
  }
  Firings firings;
  if (steps.empty()) return firings;
  const auto quarter = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
  std::nth_element(steps.begin(), quarter, steps.end());
  constexpr double kFiringShare = 0.75;  // of the time to the next column, within which the lasers of a column fire
  const double duration = kFiringShare * *quarter;

  firings.column_of_point.resize(keys.size());
  std::vector<std::uint32_t> next_column(rows, 0);
  std::uint32_t first_column = 0;
  double start = keys[order.front()];
  for (const std::uint32_t point : order) {
    if (keys[point] - start >= duration) {
      first_column = firings.columns;
      start = keys[point];
    }
    std::uint32_t& column = next_column[row_of_point[point]];
    column = std::max(column, first_column);
    firings.column_of_point[point] = column++;
    firings.columns = std::max(firings.columns, column);
  }
  return firings;
}
