// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "ground_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/sorted_element.h"
#include "io/point_geometry.h"
#include "lisco/label_clusters.h"

namespace lisco_benchmarks {
namespace {

using lisco_apps::Cloud;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kSquare = 1.0;       // metres
constexpr int kReach = 6;             // squares
constexpr double kSlope = 0.27;       // of 15 degrees
constexpr float kElevated = 0.5F;     // metres
constexpr float kFlatHeight = 0.15F;  // metres
constexpr float kFlatLength = 1.0F;   // metres

using Square = std::pair<int, int>;

Square squareOf(const pcl::PointXYZ& point) {
  const auto number = [](float coordinate) {
    return static_cast<int>(std::clamp(std::floor(static_cast<double>(coordinate) / kSquare), -1e9, 1e9));
  };
  return {number(point.x), number(point.y)};
}

struct Low {
  float height;
  std::size_t returns;
};

bool isReflection(const std::map<Square, Low>& lows, const Square& square, const Low& low) {
  constexpr float kBelow = 0.8F;
  constexpr std::size_t kMinReturns = 3;
  constexpr int kAround = 8;
  std::vector<float> around;
  for (int dx = -kAround; dx <= kAround; ++dx)
    for (int dy = -kAround; dy <= kAround; ++dy) {
      const auto other = lows.find({square.first + dx, square.second + dy});
      if ((dx != 0 || dy != 0) && other != lows.end()) around.push_back(other->second.height);
    }
  if (around.empty()) return low.returns < kMinReturns;
  return low.height < lisco::sortedElement(around, around.size() / 2) - kBelow;
}

}  // namespace

std::vector<float> localGround(const Cloud& cloud) {
  std::map<Square, std::vector<float>> heights;
  for (const auto& point : cloud)
    if (lisco_apps::isReturn(point)) heights[squareOf(point)].push_back(point.z);
  std::map<Square, Low> lows;
  for (auto& [square, of_square] : heights)
    lows[square] = {lisco::sortedElement(of_square, of_square.size() / 20), of_square.size()};
  std::map<Square, float> kept;
  for (const auto& [square, low] : lows)
    if (!isReflection(lows, square, low)) kept[square] = low.height;

  std::map<Square, float> ground;
  for (const auto& [square, low] : lows) {
    std::vector<float> bounds;
    for (int dx = -kReach; dx <= kReach; ++dx)
      for (int dy = -kReach; dy <= kReach; ++dy) {
        const auto other = kept.find({square.first + dx, square.second + dy});
        const double distance = std::max(0.0, std::hypot(dx, dy) - 1.0) * kSquare;
        if (other != kept.end()) bounds.push_back(other->second + static_cast<float>(kSlope * distance));
      }
    std::sort(bounds.begin(), bounds.end());
    ground[square] = bounds.empty() ? low.height : bounds[std::min<std::size_t>(1, bounds.size() - 1)];
  }
  std::vector<float> local(cloud.size(), kNaN);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (lisco_apps::isReturn(cloud[i])) local[i] = ground.at(squareOf(cloud[i]));
  return local;
}

GroundQuality measureGround(const Cloud& cloud, const std::vector<std::uint8_t>& ground,
                            const std::vector<float>& local, double tolerance, std::vector<std::int32_t>& labels,
                            std::vector<std::uint8_t>& flat_clusters) {
  GroundQuality quality;
  std::vector<std::array<float, 3>> points(cloud.size(), {kNaN, kNaN, kNaN});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!lisco_apps::isReturn(cloud[i])) continue;
    ++quality.returns;
    quality.removed += ground[i] != 0;
    if (cloud[i].z - local[i] > kElevated) {
      ++quality.elevated;
      quality.lost += ground[i] != 0;
    }
    if (ground[i] == 0) points[i] = {cloud[i].x, cloud[i].y, cloud[i].z};
  }
  lisco::LabelParameters parameters;
  parameters.tolerance = static_cast<float>(tolerance);
  parameters.min_size = 10;
  parameters.lasers = std::max<std::size_t>(1, cloud.height);
  labels.assign(cloud.size(), -1);
  quality.clusters = lisco::labelClusters(points.data(), points.size(), sizeof points[0], parameters, labels.data());

  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<std::array<float, 6>> boxes(quality.clusters,
                                          {kInfinity, kInfinity, kInfinity, -kInfinity, -kInfinity, -kInfinity});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (labels[i] < 0) continue;
    auto& box = boxes[static_cast<std::size_t>(labels[i])];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[axis] = std::min(box[axis], points[i][axis]);
      box[axis + 3] = std::max(box[axis + 3], points[i][axis]);
    }
  }
  flat_clusters.clear();
  for (const auto& box : boxes) {
    const float length = std::max(box[3] - box[0], box[4] - box[1]);
    flat_clusters.push_back(box[5] - box[2] < kFlatHeight && length > kFlatLength);
    quality.flat += flat_clusters.back();
  }
  return quality;
}

}  // namespace lisco_benchmarks
