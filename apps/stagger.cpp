// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stagger.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "lisco/return.h"

namespace lisco_apps {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

std::vector<int> staggerOf(const Cloud& cloud) {
  const auto columns = static_cast<int>(cloud.width);
  const auto rows = static_cast<int>(cloud.height);
  std::vector<int> shifts(cloud.height, 0);
  const auto azimuth = [](const pcl::PointXYZ& p) {
    return std::atan2(static_cast<double>(p.y), static_cast<double>(p.x));
  };
  const auto valid = [](const pcl::PointXYZ& p) { return lisco::isReturn(p.x, p.y, p.z); };

  std::vector<double> steps;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column)
      if (valid(cloud.at(column, row)) && valid(cloud.at(column + 1, row)))
        steps.push_back(std::remainder(azimuth(cloud.at(column + 1, row)) - azimuth(cloud.at(column, row)), 2 * kPi));
  if (steps.empty()) return shifts;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  const double step = steps[steps.size() / 2];
  constexpr double kLeastStep = 1e-6;
  if (std::fabs(step) < kLeastStep) return shifts;

  double first = std::numeric_limits<double>::quiet_NaN();
  for (int row = 0; row < rows; ++row) {
    double x = 0;
    double y = 0;
    for (int column = 0; column < columns; ++column)
      if (valid(cloud.at(column, row))) {
        const double offset = azimuth(cloud.at(column, row)) - step * column;
        x += std::cos(offset);
        y += std::sin(offset);
      }
    if (x == 0 && y == 0) continue;
    const double offset = std::atan2(y, x);
    if (std::isnan(first)) first = offset;
    shifts[static_cast<std::size_t>(row)] =
        static_cast<int>(std::lround(std::remainder(offset - first, 2 * kPi) / step));
  }
  return shifts;
}

}  // namespace lisco_apps
