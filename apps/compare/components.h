// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pcl/segmentation/extract_clusters.h>

#include "compare/baselines.h"

namespace lisco_apps {

/// Converts a component per return to PCL's vector: clusters in the order of first points, then sorted by PCL's call.
class ComponentsToClusters {
 public:
  /// \param component_of the component of the i-th return
  /// \param component_count above all component numbers
  void append(const std::vector<std::uint32_t>& component_of, std::size_t component_count, const Problem& problem,
              Clusters& clusters) {
    size_.assign(component_count, 0);
    for (const std::uint32_t component : component_of) ++size_[component];
    next_.assign(component_count, nullptr);
    const pcl::Indices& returns = *problem.returns;
    for (std::size_t i = 0; i < component_of.size(); ++i) {
      const std::uint32_t component = component_of[i];
      if (size_[component] < problem.min_size || size_[component] > problem.max_size) continue;
      pcl::index_t*& next = next_[component];
      if (next == nullptr) {
        clusters.emplace_back();
        clusters.back().header = problem.cloud->header;
        clusters.back().indices.resize(size_[component]);
        next = clusters.back().indices.data();
      }
      *next++ = returns[i];
    }
    std::sort(clusters.rbegin(), clusters.rend(), pcl::comparePointClusters);
  }

 private:
  std::vector<std::uint32_t> size_;
  std::vector<pcl::index_t*> next_;  ///< where a component's next index goes
};

}  // namespace lisco_apps
