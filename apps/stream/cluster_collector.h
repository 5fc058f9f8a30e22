// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/cluster_features.h"
#include "lisco/cluster_order.h"
#include "stream/stream.h"

namespace lisco_apps {

/// Numbers the subclusters of a clusterer that are clusters, in PCL's order, and labels the cells of a turn.
class ClusterCollector {
 public:
  /// \param clusterer lisco::ColumnClusterer or lisco::WindowClusterer
  /// \param cell_of the cell of a source index
  /// \param turn receives the labels
  /// \param clusters receives the clusters, largest first
  template <typename Clusterer, typename CellOf>
  void collect(Clusterer& clusterer, const StreamOptions& options, CellOf&& cell_of, Turn& turn,
               std::vector<FoundCluster>& clusters) {
    order_.assign(clusterer, options.min_size, options.max_size);
    sizes_.assign(order_.count(), 0);
    clusterer.forEachRun([&](const std::uint32_t* indices, std::size_t count, std::uint32_t subcluster) {
      const std::int32_t label = order_.labelOf(subcluster);
      if (label == lisco::ClusterOrder::kNoCluster) return;
      sizes_[static_cast<std::size_t>(label)] += count;
      for (std::size_t i = 0; i < count; ++i) turn.labels[cell_of(indices[i])] = static_cast<std::uint32_t>(label) + 1;
    });
    clusters.assign(order_.count(), {});
    for (std::size_t i = 0; i < clusters.size(); ++i) clusters[i].id = static_cast<std::uint32_t>(i + 1);
  }

  /// Computes the features of the clusters of the last collect ().
  void measure(const Turn& turn, std::vector<FoundCluster>& clusters) {
    next_point_.clear();
    std::size_t points = 0;
    for (const std::size_t size : sizes_) {
      next_point_.push_back(points);
      points += size;
    }
    points_.resize(points);
    for (std::size_t cell = 0; cell < turn.cells.size(); ++cell)
      if (const std::uint32_t label = turn.labels[cell]; label != 0)
        points_[next_point_[label - 1]++] = {turn.cells[cell].x, turn.cells[cell].y, turn.cells[cell].z};
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      clusters[i].features = lisco::clusterFeatures(&points_[next_point_[i] - sizes_[i]], sizes_[i], sizeof points_[0]);
    }
  }

 private:
  lisco::ClusterOrder order_;
  std::vector<std::size_t> sizes_;            ///< of the clusters
  std::vector<std::array<float, 3>> points_;  ///< of the clusters, one cluster after the other
  std::vector<std::size_t> next_point_;       ///< of each cluster
};

}  // namespace lisco_apps
