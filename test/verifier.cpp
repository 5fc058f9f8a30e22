// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "verifier.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lisco_test {
namespace {

constexpr std::uint32_t kNoCluster = ~std::uint32_t{0};

std::string number(std::size_t n) {
  return std::to_string(n);
}

/// Whether the graph of neighbours among the members is connected: grows the reached group by its neighbours until it
/// no longer changes.
bool connected(const std::vector<Point>& points, const std::vector<std::uint32_t>& members, float tolerance) {
  std::vector<std::uint32_t> waiting(members.begin() + 1, members.end());
  std::vector<std::uint32_t> edge{members.front()};
  while (!edge.empty()) {
    const Point from = points[edge.back()];
    edge.pop_back();
    const auto joins = std::partition(waiting.begin(), waiting.end(), [&](std::uint32_t member) {
      return !areNeighbours(from, points[member], tolerance);
    });
    edge.insert(edge.end(), joins, waiting.end());
    waiting.erase(joins, waiting.end());
  }
  return waiting.empty();
}

/// Sweeps along x: once x alone is too far, all further points are, since rounding is monotone.
void checkSeparation(const std::vector<Point>& points, const std::vector<std::uint32_t>& cluster_of, float tolerance,
                     std::vector<std::string>& found) {
  std::vector<std::uint32_t> by_x;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (cluster_of[i] != kNoCluster && isValid(points[i])) by_x.push_back(i);
  std::sort(by_x.begin(), by_x.end(), [&](std::uint32_t a, std::uint32_t b) { return points[a].x < points[b].x; });
  for (std::size_t i = 0; i < by_x.size(); ++i)
    for (std::size_t k = i + 1; k < by_x.size(); ++k) {
      const Point a = points[by_x[i]];
      const Point b = points[by_x[k]];
      if (!areNeighbours({a.x, 0, 0}, {b.x, 0, 0}, tolerance)) break;
      if (cluster_of[by_x[i]] == cluster_of[by_x[k]] || !areNeighbours(a, b, tolerance)) continue;
      found.push_back("separation: neighbours " + number(by_x[i]) + " and " + number(by_x[k]) +
                      " are in different clusters");
      return;
    }
}

}  // namespace

std::vector<std::string> violations(const std::vector<Point>& points, const Clustering& clusters, float tolerance) {
  std::vector<std::string> found;
  std::vector<std::uint32_t> cluster_of(points.size(), kNoCluster);
  for (std::uint32_t c = 0; c < clusters.size(); ++c) {
    const Cluster& cluster = clusters[c];
    if (cluster.members.size() != cluster.reported_size || cluster.members.empty())
      found.push_back("size: cluster " + number(c) + " reports " + number(cluster.reported_size) + " points, holds " +
                      number(cluster.members.size()));
    bool all_exist = !cluster.members.empty();
    for (const std::uint32_t member : cluster.members) {
      if (member >= points.size()) {
        found.push_back("coverage: there is no point " + number(member));
        all_exist = false;
        continue;
      }
      if (!isValid(points[member])) found.push_back("coverage: point " + number(member) + " is no return");
      if (cluster_of[member] != kNoCluster)
        found.push_back("coverage: point " + number(member) + " is in a cluster twice");
      cluster_of[member] = c;
    }
    if (all_exist && !connected(points, cluster.members, tolerance))
      found.push_back("connectivity: cluster " + number(c) + " falls apart");
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (isValid(points[i]) && cluster_of[i] == kNoCluster)
      found.push_back("coverage: point " + number(i) + " is in no cluster");
  checkSeparation(points, cluster_of, tolerance, found);
  return found;
}

}  // namespace lisco_test
