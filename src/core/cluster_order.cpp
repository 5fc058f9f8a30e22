// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/cluster_order.h"

#include <algorithm>
#include <vector>

namespace lisco {

class ClusterOrder::State {
 public:
  struct Cluster {
    std::uint32_t size, subcluster;
  };

  std::vector<Cluster> clusters;       ///< of accepted sizes
  std::vector<std::int32_t> label_of;  ///< by subcluster
};

ClusterOrder::ClusterOrder() : state_(std::make_unique<State>()) {}
ClusterOrder::~ClusterOrder() = default;

void ClusterOrder::assign(ColumnClusterer& clusterer, std::size_t min_size, std::size_t max_size) {
  constexpr std::int32_t kUnseen = -2;
  std::vector<State::Cluster>& clusters = state_->clusters;
  std::vector<std::int32_t>& label_of = state_->label_of;
  clusters.clear();
  label_of.assign(clusterer.subclusterCount(), kUnseen);
  clusterer.forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t subcluster) {
    if (label_of[subcluster] != kUnseen) return;
    label_of[subcluster] = kNoCluster;
    const std::uint32_t size = clusterer.sizeOf(subcluster);
    if (size >= min_size && size <= max_size) clusters.push_back({size, subcluster});
  });
  // In the order of first returns now. The sort is unstable: among equal sizes, only PCL's own call on the same sequence
  // gives PCL's order.
  std::sort(clusters.rbegin(), clusters.rend(),
            [](const State::Cluster& a, const State::Cluster& b) { return a.size < b.size; });
  for (std::size_t label = 0; label < clusters.size(); ++label)
    label_of[clusters[label].subcluster] = static_cast<std::int32_t>(label);
  label_of_ = label_of.data();
  count_ = clusters.size();
}

}  // namespace lisco
