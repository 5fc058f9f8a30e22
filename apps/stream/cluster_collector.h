// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

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
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t cell = cell_of(indices[i]);
        turn.labels[cell] = label;
        clusters[label - 1].add(turn.cells[cell]);
      }
    });
  }

 private:
  /// A subcluster of an accepted size.
  struct Candidate {
    std::uint32_t size, subcluster;
  };
  std::vector<Candidate> candidates_;               ///< by first points, then by size
  std::vector<std::uint32_t> label_of_subcluster_;  ///< 0: in no cluster
};

}  // namespace lisco_apps
