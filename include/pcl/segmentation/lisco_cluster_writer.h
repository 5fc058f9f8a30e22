// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/segmentation/lisco_pcl_version.h>

namespace pcl::detail {

/** \brief Writes subclusters of accepted sizes as PCL's clusters, in the order of their first indicesOf (). Keeps its
 * memory.
 */
class LiscoClusterWriter {
 public:
  /** \brief Starts appending clusters to a vector.
   * \param[in] subclusters their number, including those of sizes not accepted
   */
  void start(std::size_t subclusters, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
             std::vector<PointIndices>& clusters) {
    cluster_of_subcluster_.assign(subclusters, kUndecided);
    header_ = &header;
    min_size_ = min_size;
    max_size_ = max_size;
    clusters_ = &clusters;
    first_cluster_ = clusters.size();
  }

  /** \brief The cluster's indices, with capacity for all of them; nullptr if the size is not accepted. Valid until the
   * next call.
   * \param[in] size the subcluster's number of points
   */
  Indices* indicesOf(std::uint32_t subcluster, std::uint32_t size) {
    std::uint32_t& cluster = cluster_of_subcluster_[subcluster];
    if (cluster == kUndecided) {
      const bool wanted = size >= min_size_ && size <= max_size_;
      cluster = wanted ? static_cast<std::uint32_t>(clusters_->size() - first_cluster_) : kNoCluster;
      if (wanted) {
        clusters_->emplace_back();
        clusters_->back().header = *header_;
        clusters_->back().indices.reserve(size);
      }
    }
    return (cluster == kNoCluster ? nullptr : &(*clusters_)[first_cluster_ + cluster].indices);
  }

 private:
  static constexpr std::uint32_t kUndecided = ~std::uint32_t{0};
  static constexpr std::uint32_t kNoCluster = kUndecided - 1;

  std::vector<std::uint32_t> cluster_of_subcluster_;  ///< number among those appended
  const PCLHeader* header_ = nullptr;
  uindex_t min_size_ = 1, max_size_ = 1;
  std::vector<PointIndices>* clusters_ = nullptr;
  std::size_t first_cluster_ = 0;
};

}  // namespace pcl::detail
