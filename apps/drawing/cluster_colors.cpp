// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/cluster_colors.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace lisco_apps {
namespace {

constexpr std::size_t kMaxOfBlock = 32;  ///< clusters of a block that are told apart: more cannot be, in 12 x 12 pixels

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  ///< of clusters, the lower one first

/// Adds the pairs of clusters in one square block of kNearPixels, or in adjacent ones.
void addNeighbours(const ClusterPicture& picture, Pairs& pairs) {
  const PointMap& map = picture.map;
  const std::vector<std::uint32_t>& labels = picture.labels;
  const auto blocksOf = [](int cells, double size) { return static_cast<std::size_t>(cells * size / kNearPixels) + 1; };
  const std::size_t columns = blocksOf(map.columns, map.cell_width);
  const std::size_t rows = blocksOf(map.rows, map.cell_height);
  std::vector<std::vector<std::uint32_t>> clusters_in(columns * rows);
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const std::int64_t point = map.points[map.cellAt(row, column)];
      if (point == PointMap::kNoPoint || labels[static_cast<std::size_t>(point)] == 0) continue;
      const auto block = static_cast<std::size_t>(row * map.cell_height / kNearPixels) * columns +
                         static_cast<std::size_t>(column * map.cell_width / kNearPixels);
      std::vector<std::uint32_t>& clusters = clusters_in[block];
      const std::uint32_t cluster = labels[static_cast<std::size_t>(point)] - 1;
      if (clusters.size() < kMaxOfBlock && std::find(clusters.begin(), clusters.end(), cluster) == clusters.end())
        clusters.push_back(cluster);
    }
  const auto addPairs = [&pairs](const std::vector<std::uint32_t>& some, const std::vector<std::uint32_t>& others) {
    for (const std::uint32_t a : some)
      for (const std::uint32_t b : others)
        if (a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  };
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::vector<std::uint32_t>& here = clusters_in[row * columns + column];
      if (here.empty()) continue;
      addPairs(here, here);
      if (column + 1 < columns) addPairs(here, clusters_in[row * columns + column + 1]);
      if (row + 1 == rows) continue;
      for (std::size_t below = column == 0 ? 0 : column - 1; below < std::min(columns, column + 2); ++below)
        addPairs(here, clusters_in[(row + 1) * columns + below]);
    }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

using Neighbours = std::vector<std::vector<std::uint32_t>>;

/// Takes away the cluster with the fewest neighbours, again and again. \return the order, last one first
std::vector<std::uint32_t> smallestLast(const Neighbours& neighbours) {
  std::vector<std::size_t> degree;
  std::set<std::pair<std::size_t, std::uint32_t>> rest;
  for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
    degree.push_back(neighbours[i].size());
    rest.emplace(degree[i], i);
  }
  std::vector<std::uint32_t> order;
  while (!rest.empty()) {
    const std::uint32_t taken = rest.begin()->second;
    rest.erase(rest.begin());
    order.push_back(taken);
    for (const std::uint32_t other : neighbours[taken])
      if (rest.erase({degree[other], other}) != 0) rest.emplace(--degree[other], other);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<std::size_t> colorNeighbours(std::size_t clusters, const std::vector<ClusterPicture>& pictures,
                                         std::size_t primary, std::size_t colors) {
  Pairs pairs;
  for (const ClusterPicture& picture : pictures) addNeighbours(picture, pairs);
  Neighbours neighbours(clusters);
  for (const auto& [a, b] : pairs) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }

  const std::size_t none = colors;
  std::vector<std::size_t> color_of(clusters, none);
  std::vector<std::size_t> used(colors, 0);  // by all clusters: the colours are used about equally often
  for (const std::uint32_t cluster : smallestLast(neighbours)) {
    std::vector<std::size_t> taken(colors, 0);
    for (const std::uint32_t other : neighbours[cluster])
      if (color_of[other] != none) ++taken[color_of[other]];
    const auto cost = [&](std::size_t color) { return std::make_tuple(taken[color], color >= primary, used[color]); };
    std::size_t best = 0;
    for (std::size_t color = 1; color < colors; ++color)
      if (cost(color) < cost(best)) best = color;
    color_of[cluster] = best;
    ++used[best];
  }
  return color_of;
}

}  // namespace lisco_apps
