// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "oracle.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace lisco_test {

bool isValid(const Point& point) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) return false;
  return point.x != 0.0F || point.y != 0.0F || point.z != 0.0F;
}

// Repeats the library's arithmetic on purpose, so that an error there shows. Compiled with -ffp-contract=off.
bool areNeighbours(const Point& a, const Point& b, float tolerance) {
  const float dx = a.x - b.x;
  const float dy = a.y - b.y;
  const float dz = a.z - b.z;
  const float xx = dx * dx;
  const float yy = dy * dy;
  const float zz = dz * dz;
  const float xx_yy = xx + yy;
  const float d2 = xx_yy + zz;
  const double wide = static_cast<double>(tolerance);
  const auto r2 = static_cast<float>(wide * wide);
  return d2 < r2;
}

Clustering trueClusters(const std::vector<Point>& points, float tolerance) {
  std::vector<std::uint32_t> returns;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (isValid(points[i])) returns.push_back(i);
  Clustering clusters;
  std::vector<bool> taken(points.size(), false);
  for (auto seed = returns.begin(); seed != returns.end(); ++seed) {
    if (taken[*seed]) continue;
    taken[*seed] = true;
    std::vector<std::uint32_t> members{*seed};
    for (std::size_t next = 0; next < members.size(); ++next)
      for (auto other = seed + 1; other != returns.end(); ++other) {
        if (taken[*other] || !areNeighbours(points[members[next]], points[*other], tolerance)) continue;
        taken[*other] = true;
        members.push_back(*other);
      }
    std::sort(members.begin(), members.end());
    clusters.push_back({members, members.size()});
  }
  return clusters;
}

Clustering inOrder(Clustering clusters) {
  for (Cluster& cluster : clusters) std::sort(cluster.members.begin(), cluster.members.end());
  std::sort(clusters.begin(), clusters.end(), [](const Cluster& a, const Cluster& b) { return a.members < b.members; });
  return clusters;
}

std::string difference(const Clustering& expected, const Clustering& actual) {
  const auto print = [](std::ostream& out, const Clustering& clusters, std::size_t i) {
    if (i >= clusters.size()) {
      out << "nothing";
      return;
    }
    out << "size " << clusters[i].reported_size << " {";
    constexpr std::size_t kMaxPrinted = 40;
    for (std::size_t k = 0; k < std::min(kMaxPrinted, clusters[i].members.size()); ++k)
      out << (k > 0 ? " " : "") << clusters[i].members[k];
    out << (clusters[i].members.size() > kMaxPrinted ? " ...}" : "}");
  };
  for (std::size_t i = 0; i < std::max(expected.size(), actual.size()); ++i) {
    if (i < expected.size() && i < actual.size() && expected[i].members == actual[i].members &&
        expected[i].reported_size == actual[i].reported_size)
      continue;
    std::ostringstream out;
    out << expected.size() << " clusters expected, " << actual.size() << " found; the first to differ is " << i
        << ": expected ";
    print(out, expected, i);
    out << ", found ";
    print(out, actual, i);
    return out.str();
  }
  return {};
}

}  // namespace lisco_test
