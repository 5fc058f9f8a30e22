// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "pcl_clouds.h"

#include <array>

namespace lisco_test {

Scan boxesAround(Random& random, std::size_t columns, std::size_t lasers) {
  constexpr double kTurn = 6.283185307179586;
  constexpr std::size_t kSectors = 12;
  std::array<double, kSectors> ranges{};
  for (double& range : ranges) range = random.chance(0.3) ? 0.0 : random.magnitude(1.5, 20.0);
  Scan scan(columns, lasers);
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column) {
      const double turn = static_cast<double>(column) / static_cast<double>(columns);
      const double range = ranges[static_cast<std::size_t>(turn * kSectors)] * random.between(0.99, 1.01);
      if (range == 0.0 || random.chance(0.05)) continue;
      const double elevation = 0.2 - 0.03 * static_cast<double>(laser);
      scan.set(laser, column,
               {static_cast<float>(range * std::cos(elevation) * std::cos(-kTurn * turn)),
                static_cast<float>(range * std::cos(elevation) * std::sin(-kTurn * turn)),
                static_cast<float>(range * std::sin(elevation))});
    }
  return scan;
}

Scan cameraView(Random& random, std::size_t columns, std::size_t lasers) {
  constexpr double kFocalLength = 40.0;
  constexpr std::size_t kBox = 8;  // pixels
  Scan scan(columns, lasers);
  std::vector<double> depths((columns / kBox + 1) * (lasers / kBox + 1));
  for (double& depth : depths) depth = random.chance(0.4) ? random.between(0.5, 2.5) : 3.0;
  for (std::size_t v = 0; v < lasers; ++v)
    for (std::size_t u = 0; u < columns; ++u) {
      if (random.chance(0.1)) continue;
      const double z = depths[(v / kBox) * (columns / kBox + 1) + u / kBox] * random.between(0.999, 1.001);
      const double x = (static_cast<double>(u) - static_cast<double>(columns) / 2.0) * z / kFocalLength;
      const double y = (static_cast<double>(v) - static_cast<double>(lasers) / 2.0) * z / kFocalLength;
      scan.set(v, u, {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
  return scan;
}

}  // namespace lisco_test
