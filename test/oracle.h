// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lisco_test {

/// A point as the oracle takes it; independent of lisco's types.
struct Point {
  float x, y, z;
};

/// One cluster: its members, and its size as reported by the clusterer.
struct Cluster {
  std::vector<std::uint32_t> members;  ///< point numbers
  std::size_t reported_size;
};
using Clustering = std::vector<Cluster>;

/// Whether the point is a return: finite, and not exactly (0, 0, 0).
bool isValid(const Point& point);

/// Whether two points are neighbours, by the arithmetic that the equality contract fixes.
bool areNeighbours(const Point& a, const Point& b, float tolerance);

/// The clusters of all valid points, by comparing every point with every other: members ascend, clusters come
/// in the order of their first members, and singletons are clusters.
Clustering trueClusters(const std::vector<Point>& points, float tolerance);

/// The same clusters in the order trueClusters gives them.
Clustering inOrder(Clustering clusters);

/// The first difference between two clusterings, both in order; empty if they are equal.
std::string difference(const Clustering& expected, const Clustering& actual);

}  // namespace lisco_test
