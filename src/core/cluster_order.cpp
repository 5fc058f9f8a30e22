// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/cluster_order.h"

#include <algorithm>

namespace lisco {

void ClusterOrder::assign(ColumnClusterer& clusterer, std::size_t min_size, std::size_t max_size) {
  constexpr std::int32_t kUnseen = -2;
  clusters_.clear();
  label_of_.assign(clusterer.subclusterCount(), kUnseen);
  clusterer.forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t subcluster) {
    if (label_of_[subcluster] != kUnseen) return;
    label_of_[subcluster] = kNoCluster;
    const std::uint32_t size = clusterer.sizeOf(subcluster);
    if (size >= min_size && size <= max_size) clusters_.push_back({size, subcluster});
  });
  // In the order of first returns now. The sort is unstable: among equal sizes, only PCL's own call on the same sequence
  // gives PCL's order.
  std::sort(clusters_.rbegin(), clusters_.rend(), [](const Cluster& a, const Cluster& b) { return a.size < b.size; });
  for (std::size_t label = 0; label < clusters_.size(); ++label)
    label_of_[clusters_[label].subcluster] = static_cast<std::int32_t>(label);
}

}  // namespace lisco
