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

void ClusterOrder::start(std::size_t subclusters) {
  state_->clusters.clear();
  state_->label_of.assign(subclusters, kUnseen);
  label_of_ = state_->label_of.data();
}

void ClusterOrder::add(std::uint32_t subcluster, std::uint32_t size) {
  state_->clusters.push_back({size, subcluster});
}

void ClusterOrder::sort() {
  std::vector<State::Cluster>& clusters = state_->clusters;
  // In the order of first returns until here. The sort is unstable: among equal sizes, only PCL's own call on the same
  // sequence gives PCL's order.
  std::sort(clusters.rbegin(), clusters.rend(),
            [](const State::Cluster& a, const State::Cluster& b) { return a.size < b.size; });
  for (std::size_t label = 0; label < clusters.size(); ++label)
    label_of_[clusters[label].subcluster] = static_cast<std::int32_t>(label);
  count_ = clusters.size();
}

}  // namespace lisco
