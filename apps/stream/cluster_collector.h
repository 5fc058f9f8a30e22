// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "lisco/cluster_features.h"
#include "stream.h"

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
    constexpr std::uint32_t kUnseen = ~std::uint32_t{0};
    candidates_.clear();
    label_of_subcluster_.assign(clusterer.subclusterCount(), kUnseen);
    clusterer.forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t subcluster) {
      if (std::exchange(label_of_subcluster_[subcluster], 0) != kUnseen) return;
      const std::uint32_t size = clusterer.sizeOf(subcluster);
      if (size >= options.min_size && size <= options.max_size) candidates_.push_back({size, subcluster});
    });
    // The sort is unstable: among equal sizes, only PCL's own call on the same sequence gives PCL's order.
    std::sort(candidates_.rbegin(), candidates_.rend(),
              [](const Candidate& a, const Candidate& b) { return a.size < b.size; });
    clusters.assign(candidates_.size(), {});
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      clusters[i].id = label_of_subcluster_[candidates_[i].subcluster] = static_cast<std::uint32_t>(i + 1);
    clusterer.forEachRun([&](const std::uint32_t* indices, std::size_t count, std::uint32_t subcluster) {
      const std::uint32_t label = label_of_subcluster_[subcluster];
      if (label == 0) return;
      for (std::size_t i = 0; i < count; ++i) turn.labels[cell_of(indices[i])] = label;
    });
  }

  /// Computes the features of the clusters of the last collect ().
  void measure(const Turn& turn, std::vector<FoundCluster>& clusters) {
    next_point_.clear();
    std::size_t points = 0;
    for (const Candidate& candidate : candidates_) {
      next_point_.push_back(points);
      points += candidate.size;
    }
    points_.resize(points);
    for (std::size_t cell = 0; cell < turn.cells.size(); ++cell)
      if (const std::uint32_t label = turn.labels[cell]; label != 0)
        points_[next_point_[label - 1]++] = {turn.cells[cell].x, turn.cells[cell].y, turn.cells[cell].z};
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      const std::size_t size = candidates_[i].size;
      clusters[i].features = lisco::clusterFeatures(&points_[next_point_[i] - size], size, sizeof points_[0]);
    }
  }

 private:
  /// A subcluster of an accepted size.
  struct Candidate {
    std::uint32_t size, subcluster;
  };
  std::vector<Candidate> candidates_;               ///< by first points, then by size
  std::vector<std::uint32_t> label_of_subcluster_;  ///< 0: in no cluster
  std::vector<std::array<float, 3>> points_;        ///< of the clusters, one cluster after the other
  std::vector<std::size_t> next_point_;             ///< of each cluster
};

}  // namespace lisco_apps
