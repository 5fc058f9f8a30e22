// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Andrew's monotone chain, after points inside of an octagon of extreme points have been discarded (Akl and
// Toussaint): sorting is what takes the time, and few points of a cluster remain.
#include "core/convex_hull.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lisco {
namespace {

constexpr std::size_t kWorthDiscarding = 64;  ///< points; fewer are sorted as quickly
constexpr std::size_t kDirections = 8;        ///< of extreme points
constexpr std::size_t kSample = 256;          ///< points, among which the extremes are searched for

/// Positive if a, b, c turn to the left.
double orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::vector<PlanePoint> monotoneChain(std::vector<PlanePoint> points) {
  std::sort(points.begin(), points.end(),
            [](const PlanePoint& a, const PlanePoint& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end(),
                           [](const PlanePoint& a, const PlanePoint& b) { return a.x == b.x && a.y == b.y; }),
               points.end());
  if (points.size() < 3) return points;
  std::vector<PlanePoint> hull;
  const auto append = [&hull](const PlanePoint& point, std::size_t first) {
    while (hull.size() >= first + 2 && orientation(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
    hull.push_back(point);
  };
  for (const PlanePoint& point : points) append(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) append(*point, lower);
  hull.pop_back();  // the first again
  return hull;
}

/// The points that are farthest in eight directions, of about kSample points.
std::array<PlanePoint, kDirections> extremesOf(const std::vector<PlanePoint>& points) {
  std::array<PlanePoint, kDirections> extremes;
  extremes.fill(points.front());
  constexpr double kAlong[kDirections / 2][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  const std::size_t step = (points.size() + kSample - 1) / kSample;
  for (std::size_t i = 0; i < points.size(); i += step)
    for (std::size_t direction = 0; direction < kDirections; ++direction) {
      const double sign = direction % 2 == 0 ? 1 : -1;
      const auto along = [&](const PlanePoint& p) {
        return sign * (kAlong[direction / 2][0] * p.x + kAlong[direction / 2][1] * p.y);
      };
      if (along(points[i]) > along(extremes[direction])) extremes[direction] = points[i];
    }
  return extremes;
}

}  // namespace

std::vector<PlanePoint> convexHull(const std::vector<PlanePoint>& points) {
  if (points.size() < kWorthDiscarding) return monotoneChain(points);
  const auto extremes = extremesOf(points);
  const std::vector<PlanePoint> octagon = monotoneChain({extremes.begin(), extremes.end()});
  if (octagon.size() < 3) return monotoneChain(points);
  struct Edge {
    PlanePoint from, to;
  };
  std::array<Edge, kDirections> edges;  // the last one fills the array, whose fixed size is quicker
  for (std::size_t i = 0; i < kDirections; ++i) {
    const std::size_t corner = std::min(i, octagon.size() - 1);
    edges[i] = {octagon[corner], octagon[corner + 1 < octagon.size() ? corner + 1 : 0]};
  }
  std::vector<PlanePoint> outside(octagon);
  for (const PlanePoint& point : points) {
    double least = orientation(edges[0].from, edges[0].to, point);
    for (std::size_t i = 1; i < kDirections; ++i)
      least = std::min(least, orientation(edges[i].from, edges[i].to, point));
    if (!(least > 0)) outside.push_back(point);
  }
  return monotoneChain(std::move(outside));
}

}  // namespace lisco
