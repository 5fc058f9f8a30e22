// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/scan_returns.h"

#include <cstdint>
#include <vector>

#include "io/point_geometry.h"
#include "lisco/ground_filter.h"
#include "lisco/sensor_hints.h"

namespace lisco_apps {
namespace {

/// Per point: 1 on the ground. Empty if the cloud is not the scan of a rotating sensor.
std::vector<std::uint8_t> groundBySlope(const Cloud& cloud, const Region& region) {
  const std::size_t columns = cloud.width;
  const std::size_t lasers = cloud.height;
  const auto cell_at = [&](std::size_t laser, std::size_t column) {
    const auto& p = cloud[laser * columns + column];
    return region.isOutsideOfBoxes(p.x, p.y, p.z) ? lisco::Return{p.x, p.y, p.z, 0} : lisco::kNoReturn;
  };
  lisco::GroundParameters parameters;
  const auto& origin = cloud.sensor_origin_;
  parameters.sensor =
      lisco::estimateSensor(columns, lasers, {origin[0], origin[1], origin[2]}, lisco::CellSource(cell_at));
  if (lasers < 2 || parameters.sensor.steps_per_turn == 0) return {};
  std::vector<std::uint8_t> ground(cloud.size());
  lisco::GroundFilter().filter(parameters, columns, lasers, cell_at, ground.data());
  return ground;
}

std::string shareOf(std::size_t part, std::size_t all) {
  return formatted("%zu returns (%.0f %%)", part,
                   all == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(all));
}

}  // namespace

ScanReturns returnsOf(const Cloud& cloud, const GroundChoice& ground, const Region& region) {
  ScanReturns result;
  std::vector<std::uint8_t> by_slope;
  if (ground.method == GroundChoice::Method::kSlope) {
    by_slope = groundBySlope(cloud, region);
    result.is_rotating = !by_slope.empty();
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& point = cloud[i];
    if (!isReturn(point)) continue;
    ++result.returns;
    if (!region.contains(point.x, point.y, point.z))
      ++result.ignored;
    else if (!by_slope.empty() ? by_slope[i] != 0 : point.z < ground.height)
      ++result.ground;
    else
      result.clustered.push_back(static_cast<pcl::index_t>(i));
  }
  return result;
}

std::string describe(const ScanReturns& returns, const GroundChoice& ground) {
  std::string text;
  if (returns.ignored > 0) text += "  ignored   " + shareOf(returns.ignored, returns.returns) + " by range or place\n";
  const std::string left_out = shareOf(returns.ground, returns.returns) + " left out";
  if (ground.method == GroundChoice::Method::kHeight)
    text += "  ground    " + left_out + formatted(", below z = %g m\n", static_cast<double>(ground.height));
  if (ground.method == GroundChoice::Method::kSlope)
    text += !returns.is_rotating ? "  ground    nothing left out: this is not the organized scan of a rotating sensor\n"
            : returns.ground == 0 ? "  ground    nothing left out: none was found\n"
                                  : "  ground    " + left_out + ", by slope; --ground none keeps them\n";
  return text;
}

}  // namespace lisco_apps
