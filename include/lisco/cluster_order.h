// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace lisco {

/// Numbers the subclusters of a rotation or window as PCL orders its clusters: by size, the largest first, and among
/// equal sizes as PCL's unstable sort leaves them. Keeps its memory.
class LISCO_EXPORT ClusterOrder {
 public:
  static constexpr std::int32_t kNoCluster = -1;  ///< the label of a subcluster whose size is not accepted

  ClusterOrder();
  ~ClusterOrder();
  ClusterOrder(const ClusterOrder&) = delete;
  ClusterOrder& operator=(const ClusterOrder&) = delete;

  /// Numbers the subclusters of min_size to max_size returns.
  /// \param clusterer ColumnClusterer after update (), or WindowClusterer after a window has ended
  template <typename Clusterer>
  void assign(Clusterer& clusterer, std::size_t min_size, std::size_t max_size) {
    start(clusterer.subclusterCount());
    clusterer.forEachRun([&](std::uint32_t, std::uint32_t, std::size_t, std::uint32_t subcluster) {
      if (label_of_[subcluster] != kUnseen) return;
      label_of_[subcluster] = kNoCluster;
      const std::uint32_t size = clusterer.sizeOf(subcluster);
      if (size >= min_size && size <= max_size) add(subcluster, size);
    });
    sort();
  }

  std::size_t count() const { return count_; }  ///< of clusters
  /// Of a subcluster, 0..subclusterCount()-1: 0 if it is the largest cluster and so on, kNoCluster if its size is not
  /// accepted. After assign ().
  std::int32_t labelOf(std::uint32_t subcluster) const { return label_of_[subcluster]; }

 private:
  static constexpr std::int32_t kUnseen = -2;

  void start(std::size_t subclusters);
  void add(std::uint32_t subcluster, std::uint32_t size);
  void sort();

  class LISCO_HIDDEN State;
  std::unique_ptr<State> state_;
  std::int32_t* label_of_ = nullptr;  ///< by subcluster
  std::size_t count_ = 0;
};

}  // namespace lisco
