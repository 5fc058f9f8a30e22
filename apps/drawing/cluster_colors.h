// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lisco_apps {

/// The points that a picture shows, cell by cell, row by row.
struct PointMap {
  int columns = 0, rows = 0;
  double cell_width = 1, cell_height = 1;  ///< pixels
  std::vector<std::int64_t> points;        ///< index of the point of the cell; kNoPoint: none

  static constexpr std::int64_t kNoPoint = -1;

  std::size_t cellAt(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

/// A picture of clusters.
struct ClusterPicture {
  const PointMap& map;
  const std::vector<std::uint32_t>& labels;  ///< of the points: 0 in no cluster, otherwise 1 + the index of the cluster
};

/// Clusters are neighbours where the gap between cells of them is less than this along both axes of a picture, pixels.
inline constexpr double kNearPixels = 12;
/// They touch where it is less than this; it is 0 between cells that share a side or a corner.
inline constexpr double kTouchingPixels = 4;

/// Colours of clusters, so that neighbours in any of the pictures differ: a greedy colouring, improved by exchanges.
/// Where the colours do not suffice, clusters that touch come before those that are near. They suffice for the touching
/// ones if each group of clusters has one that touches fewer than `colors` others of the group.
/// \param clusters their number
/// \param primary, colors numbers of colours: those from `primary` on are given only where the others are taken
/// \return a colour per cluster, 0..colors-1
std::vector<std::size_t> colorNeighbours(std::size_t clusters, const std::vector<ClusterPicture>& pictures,
                                         std::size_t primary, std::size_t colors);

}  // namespace lisco_apps
