// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The format of the paper's authors: a line `lasers,steps,0`, then `distance,theta,alpha` per cell, step by step,
// laser by laser within a step. Distance in metres, 0 for no return; theta, the elevation, and alpha, the azimuth
// clockwise from +y, in radians: x = d cos(theta) sin(alpha), y = d cos(theta) cos(alpha), z = d sin(theta).
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/formats.h"

namespace lisco_apps {
namespace {

constexpr double kMaxSize = 1e6;  ///< lasers, and steps

/// Reads a line's three comma-separated numbers. \return false if it holds anything else
bool parseThree(std::string_view line, std::array<double, 3>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == values.size())) return false;
    std::string_view item = line.substr(0, comma);
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    while (!item.empty() && (item.back() == ' ' || item.back() == '\r')) item.remove_suffix(1);
    if (!item.empty() && item.front() == '+') item.remove_prefix(1);
    const auto result = std::from_chars(item.data(), item.data() + item.size(), values[i]);
    if (result.ec != std::errc() || result.ptr != item.data() + item.size()) return false;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return true;
}

}  // namespace

Cloud::Ptr readAuthorsCsv(const std::filesystem::path& file, Labels* /*object_of*/) {
  const std::string content = wholeContentOf(file);
  std::string_view rest = content;
  std::size_t line_number = 0;
  const auto next_line = [&] {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++line_number;
    return line;
  };

  std::array<double, 3> values{};
  const bool header = parseThree(next_line(), values);
  if (!header || values[0] < 1 || values[1] < 1 || values[0] > kMaxSize || values[1] > kMaxSize ||
      values[0] != std::floor(values[0]) || values[1] != std::floor(values[1]) || values[2] != 0)
    fail(file,
         "line 1 is not 'lasers,steps,0', with which the paper authors' .csv begins; no other .csv is read, make it a "
         ".pcd");
  const auto lasers = static_cast<std::size_t>(values[0]);
  const auto steps = static_cast<std::size_t>(values[1]);
  if (lasers * steps > content.size()) fail(file, "holds fewer cells than its first line says");

  auto cloud = std::make_shared<Cloud>();
  cloud->resize(lasers * steps);
  cloud->width = static_cast<std::uint32_t>(steps);
  cloud->height = static_cast<std::uint32_t>(lasers);
  cloud->is_dense = false;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t step = 0; step < steps; ++step)
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      if (rest.empty())
        fail(file, "ends at line " + std::to_string(line_number) + ", its first line promises " +
                       std::to_string(lasers * steps) + " cells");
      if (!parseThree(next_line(), values))
        fail(file, "line " + std::to_string(line_number) + " is not 'distance,theta,alpha'");
      const double horizontal = values[0] * std::cos(values[1]);
      (*cloud)[laser * steps + step] = values[0] > 0
                                           ? pcl::PointXYZ(static_cast<float>(horizontal * std::sin(values[2])),
                                                           static_cast<float>(horizontal * std::cos(values[2])),
                                                           static_cast<float>(values[0] * std::sin(values[1])))
                                           : pcl::PointXYZ(kNan, kNan, kNan);
    }
  if (rest.find_first_not_of(" \r\n") != std::string_view::npos)
    fail(file, "goes on after the " + std::to_string(lasers * steps) + " cells its first line promises");
  return cloud;
}

}  // namespace lisco_apps
