// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/stagger.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "core/sorted_element.h"
#include "io/point_geometry.h"

namespace lisco_apps {
namespace {

constexpr double kMinStep = 1e-6;  // radians from column to column; the sensor of a scan with less does not turn

/// The median angle between neighbouring returns of a row, radians; 0 if there are none.
double stepOf(const Cloud& cloud) {
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < cloud.size(); ++i)
    if ((i + 1) % cloud.width != 0 && isReturn(cloud[i]) && isReturn(cloud[i + 1]))
      steps.push_back(std::remainder(azimuthOf(cloud[i + 1]) - azimuthOf(cloud[i]), 2 * kPi));
  return steps.empty() ? 0 : lisco::sortedElement(steps, steps.size() / 2);
}

}  // namespace

std::vector<int> rowShiftsOf(const Cloud& cloud) {
  std::vector<int> shifts(cloud.height, 0);
  const double step = stepOf(cloud);
  if (std::fabs(step) < kMinStep) return shifts;

  double first = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t row = 0; row < cloud.height; ++row) {
    double x = 0;
    double y = 0;
    for (std::size_t column = 0; column < cloud.width; ++column) {
      const pcl::PointXYZ& point = cloud[row * cloud.width + column];
      if (!isReturn(point)) continue;
      const double offset = azimuthOf(point) - step * static_cast<double>(column);
      x += std::cos(offset);
      y += std::sin(offset);
    }
    if (x == 0 && y == 0) continue;
    const double offset = std::atan2(y, x);
    if (std::isnan(first)) first = offset;
    shifts[row] = static_cast<int>(std::lround(std::remainder(offset - first, 2 * kPi) / step));
  }
  return shifts;
}

}  // namespace lisco_apps
