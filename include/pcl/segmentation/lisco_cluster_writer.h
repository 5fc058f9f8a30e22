// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/segmentation/extract_clusters.h>  // comparePointClusters
#include <pcl/segmentation/lisco_pcl_version.h>

namespace pcl::detail {

/** \brief Sorts clusters by size, the largest first, as EuclideanClusterExtraction::extract () does: by an unstable
 * sort, so that only the same call on the same sequence gives PCL's order among clusters of one size.
 */
inline void sortLiscoClusters(std::vector<PointIndices>& clusters) {
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
}

/** \brief Appends subclusters of accepted sizes to a vector as PCL's clusters, in the order of their first place (). */
template <typename Clusterer>
class LiscoClusterWriter {
 public:
  /** \param[in] clusterer lisco::ColumnClusterer or lisco::WindowClusterer, after update ()
   * \param next_index memory of the writer, which a caller may keep for the next one
   */
  LiscoClusterWriter(const Clusterer& clusterer, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
                     std::vector<index_t*>& next_index, std::vector<PointIndices>& clusters)
      : clusterer_(clusterer),
        header_(header),
        min_size_(min_size),
        max_size_(max_size),
        next_index_(next_index),
        clusters_(clusters) {
    next_index_.assign(clusterer.subclusterCount(), nullptr);
  }
  LiscoClusterWriter(const LiscoClusterWriter&) = delete;
  LiscoClusterWriter& operator=(const LiscoClusterWriter&) = delete;

  /** \brief Gives the cluster of a subcluster the next place, unless it has one or its size is not accepted.
   * \return whether the size is accepted
   */
  bool place(std::uint32_t subcluster) {
    index_t*& next = next_index_[subcluster];
    if (next == nullptr) next = begin(clusterer_.sizeOf(subcluster));
    return (next != &ignored_);
  }

  /** \brief Appends points to the cluster of a subcluster, if its size is accepted. In all, as many points are appended
   * as its size says.
   * \param[in] count at least 1
   * \param[in] point_at callable as index_t (std::size_t i), i below \a count; may be called several times
   */
  template <typename PointAt>
  void append(std::uint32_t subcluster, std::size_t count, PointAt&& point_at) {
    if (!place(subcluster)) return;
    index_t*& next = next_index_[subcluster];
    copy(next, count, point_at);
    next += count;
  }

 private:
  /** \brief Writes four points at a time, the last four again if need be: a branch for each point costs more. */
  template <typename PointAt>
  static void copy(index_t* to, std::size_t count, PointAt&& point_at) {
    constexpr std::size_t kStep = 4;
    if (count < kStep) {
      for (const std::size_t i : {std::size_t{0}, count / 2, count - 1}) to[i] = point_at(i);
      return;
    }
    const auto copy_some = [&](std::size_t first) {
      for (std::size_t i = first; i < first + kStep; ++i) to[i] = point_at(i);
    };
    for (std::size_t first = 0; first + kStep < count; first += kStep) copy_some(first);
    copy_some(count - kStep);
  }

  index_t* begin(std::uint32_t size) {
    static_assert(std::is_nothrow_move_constructible<PointIndices>::value, "clusters that move keep their indices");
    if (size < min_size_ || size > max_size_) return (&ignored_);
    clusters_.emplace_back();
    clusters_.back().header = header_;
    clusters_.back().indices.resize(size);
    return (clusters_.back().indices.data());
  }

  const Clusterer& clusterer_;
  const PCLHeader& header_;
  const uindex_t min_size_, max_size_;
  std::vector<index_t*>& next_index_;  ///< of each subcluster: where it goes; nullptr: undecided
  index_t ignored_ = 0;                ///< where those of sizes not accepted would go
  std::vector<PointIndices>& clusters_;
};

}  // namespace pcl::detail
