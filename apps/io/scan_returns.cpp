// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/scan_returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "io/point_geometry.h"
#include "lisco/ground_filter.h"
#include "lisco/label_ground.h"

namespace lisco_apps {
namespace {

/// Whether points lie around the sensor as those of a turn or of a sector do: on several sides, and hardly any straight
/// above or below it, where cameras look and the middle of a map is.
bool isAroundSensor(const Cloud& cloud) {
  constexpr std::size_t kBins = 360;
  constexpr double kMinSides = 1.0 / 12;
  constexpr double kSteep = 60 * kPi / 180;
  constexpr double kMaxSteep = 0.01;  // share of the returns
  std::vector<bool> sides(kBins, false);
  std::size_t returns = 0;
  std::size_t steep = 0;
  const std::array<float, 3> sensor = declaredOriginOf(cloud);
  for (const auto& point : cloud) {
    if (!isReturn(point)) continue;
    const pcl::PointXYZ relative(point.x - sensor[0], point.y - sensor[1], point.z - sensor[2]);
    const double turn = azimuthOf(relative) / (2 * kPi) + 0.5;
    sides[std::min(kBins - 1, static_cast<std::size_t>(turn * kBins))] = true;
    steep += std::fabs(elevationOf(relative)) > kSteep ? 1 : 0;
    ++returns;
  }
  return static_cast<double>(std::count(sides.begin(), sides.end(), true)) >= kMinSides * kBins &&
         static_cast<double>(steep) <= kMaxSteep * static_cast<double>(returns);
}

/// Per point: 1 on the ground. Empty if the cloud is not the scan of a rotating sensor.
std::vector<std::uint8_t> groundBySlope(const Cloud& cloud, const Region& region, bool is_rotation) {
  const std::size_t columns = cloud.width;
  const std::size_t lasers = cloud.height;
  const auto cell_at = [&](std::size_t laser, std::size_t column) {
    const auto& p = cloud[laser * columns + column];
    return region.isOutsideOfBoxes(p.x, p.y, p.z) ? lisco::Return{p.x, p.y, p.z, 0} : lisco::kNoReturn;
  };
  const std::array<float, 3> origin = declaredOriginOf(cloud);
  std::vector<std::uint8_t> ground(cloud.size());
  lisco::GroundFilter filter;
  lisco::GroundParameters parameters;
  if (is_rotation)
    parameters.sensor.steps_per_turn = static_cast<int>(columns);  // known, so that the place of the sensor is, too
  else if (lasers > 1)
    parameters.sensor = lisco::estimateSensor(columns, lasers, origin, lisco::CellSource(cell_at));
  if (parameters.sensor.steps_per_turn != 0) {
    filter.filterScan(parameters, columns, lasers, cell_at, ground.data());
    return ground;
  }
  if (!isAroundSensor(cloud)) return {};
  std::vector<lisco::Return> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cell_at(0, i));
  lisco::LabelGroundParameters unorganized;
  unorganized.origin = origin;
  lisco::labelGround(points.data(), points.size(), sizeof points[0], unorganized, ground.data());
  return ground;
}

std::string shareOf(std::size_t part, std::size_t all) {
  return formatted("%zu returns (%.0f %%)", part,
                   all == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(all));
}

}  // namespace

ScanReturns returnsOf(const Cloud& cloud, const GroundChoice& ground, const Region& region, bool is_rotation) {
  ScanReturns result;
  std::vector<std::uint8_t> by_slope;
  if (ground.method == GroundChoice::Method::kSlope) {
    by_slope = groundBySlope(cloud, region, is_rotation);
    result.is_rotating = !by_slope.empty();
  }
  const std::array<float, 3> sensor = declaredOriginOf(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& point = cloud[i];
    if (!isReturn(point)) continue;
    ++result.returns;
    if (!region.contains(point.x, point.y, point.z, sensor))
      ++result.ignored;
    else if (!by_slope.empty() ? by_slope[i] != 0 : point.z < ground.height)
      result.ground.push_back(static_cast<pcl::index_t>(i));
    else
      result.clustered.push_back(static_cast<pcl::index_t>(i));
  }
  return result;
}

float roundingOf(const Cloud& cloud, const pcl::Indices& points) {
  float largest = 0;
  for (const pcl::index_t i : points) {
    const auto& point = cloud[static_cast<std::size_t>(i)];
    largest = std::max({largest, std::fabs(point.x), std::fabs(point.y), std::fabs(point.z)});
  }
  return std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
}

std::string describe(const ScanReturns& returns, const GroundChoice& ground) {
  std::string text;
  if (returns.ignored > 0) text += "  ignored   " + shareOf(returns.ignored, returns.returns) + " by range or place\n";
  const std::string left_out = shareOf(returns.ground.size(), returns.returns) + " left out";
  if (ground.method == GroundChoice::Method::kHeight)
    text += "  ground    " + left_out + formatted(", below z = %g m\n", static_cast<double>(ground.height));
  if (ground.method == GroundChoice::Method::kSlope)
    text += !returns.is_rotating     ? "  ground    nothing left out: this is not the scan of a rotating sensor\n"
            : returns.ground.empty() ? "  ground    nothing left out: none was found\n"
                                     : "  ground    " + left_out + ", by slope; --ground none keeps them\n";
  return text;
}

}  // namespace lisco_apps
