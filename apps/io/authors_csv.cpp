// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The format of the paper's authors: a line `lasers,steps,0`, then `distance,theta,alpha` per cell, step by step,
// laser by laser within a step. Distance in metres, 0 for no return; theta, the elevation, and alpha, the azimuth
// clockwise from +y, in radians: x = d cos(theta) sin(alpha), y = d cos(theta) cos(alpha), z = d sin(theta).
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "io/formats.h"

namespace lisco_apps {
namespace {

constexpr double kMaxSize = 1e6;  ///< lasers, and steps

/// Reads the three comma-separated numbers of a line. \return false if it has other content
bool parseThree(const std::string& line, std::array<double, 3>& values) {
  int end = 0;
  return std::sscanf(line.c_str(), "%lf ,%lf ,%lf %n", &values[0], &values[1], &values[2], &end) == 3 &&
         static_cast<std::size_t>(end) == line.size();
}

}  // namespace

Cloud::Ptr readAuthorsCsv(const fs::path& file, const ReadOptions& /*options*/, ReadExtras& /*extras*/) {
  const std::string text = wholeContentOf(file);
  std::istringstream content(text);
  std::string line;
  std::array<double, 3> values{};
  const bool header = std::getline(content, line) && parseThree(line, values);
  if (!header || values[0] < 1 || values[1] < 1 || values[0] > kMaxSize || values[1] > kMaxSize ||
      values[0] != std::floor(values[0]) || values[1] != std::floor(values[1]) || values[2] != 0)
    fail(file,
         "line 1 is not 'lasers,steps,0', as in the paper authors' .csv; any other .csv is not read, make it a .pcd");
  const auto lasers = static_cast<std::size_t>(values[0]);
  const auto steps = static_cast<std::size_t>(values[1]);
  if (lasers * steps > text.size()) fail(file, "holds fewer cells than its first line says");

  auto cloud = std::make_shared<Cloud>();
  cloud->resize(lasers * steps);
  cloud->width = static_cast<std::uint32_t>(steps);
  cloud->height = static_cast<std::uint32_t>(lasers);
  cloud->is_dense = false;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t step = 0; step < steps; ++step)
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const std::size_t cells_before = step * lasers + laser;
      if (!std::getline(content, line))
        fail(file,
             formatted("ends at line %zu, before the %zu cells of its first line", cells_before + 1, lasers * steps));
      if (!parseThree(line, values)) fail(file, formatted("line %zu is not 'distance,theta,alpha'", cells_before + 2));
      const double horizontal = values[0] * std::cos(values[1]);
      (*cloud)[laser * steps + step] = values[0] > 0
                                           ? pcl::PointXYZ(static_cast<float>(horizontal * std::sin(values[2])),
                                                           static_cast<float>(horizontal * std::cos(values[2])),
                                                           static_cast<float>(values[0] * std::sin(values[1])))
                                           : pcl::PointXYZ(kNan, kNan, kNan);
    }
  if ((content >> std::ws).peek() != std::istringstream::traits_type::eof())
    fail(file, formatted("holds more than the %zu cells of its first line", lasers * steps));
  return cloud;
}

}  // namespace lisco_apps
