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

/** \brief Writes subclusters of accepted sizes as PCL's clusters, in the order of their first place (). Keeps its
 * memory.
 */
class LiscoClusterWriter {
 public:
  /** \brief Starts appending clusters to a vector.
   * \param[in] subclusters their number, including those of sizes not accepted
   */
  void start(std::size_t subclusters, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
             std::vector<PointIndices>& clusters) {
    next_index_.assign(subclusters, nullptr);
    header_ = &header;
    min_size_ = min_size;
    max_size_ = max_size;
    clusters_ = &clusters;
  }

  /** \brief Gives the cluster of a subcluster the next place, unless it has one or its size is not accepted.
   * \param[in] size_of callable as std::uint32_t (std::uint32_t subcluster): its number of points
   * \return whether the size is accepted
   */
  template <typename SizeOf>
  bool place(std::uint32_t subcluster, SizeOf&& size_of) {
    index_t*& next = next_index_[subcluster];
    if (next == nullptr) next = begin(size_of(subcluster));
    return (next != &ignored_);
  }

  /** \brief Appends points to the cluster of a subcluster, if its size is accepted. In all, as many points are appended
   * as its size says.
   * \param[in] count at least 1
   * \param[in] point_at callable as index_t (std::size_t i), i below \a count; may be called several times
   */
  template <typename SizeOf, typename PointAt>
  void append(std::uint32_t subcluster, SizeOf&& size_of, std::size_t count, PointAt&& point_at) {
    if (!place(subcluster, size_of)) return;
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
    clusters_->emplace_back();
    clusters_->back().header = *header_;
    clusters_->back().indices.resize(size);
    return (clusters_->back().indices.data());
  }

  std::vector<index_t*> next_index_;  ///< of each subcluster: where it goes; nullptr: undecided
  index_t ignored_ = 0;               ///< where those of sizes not accepted would go
  const PCLHeader* header_ = nullptr;
  uindex_t min_size_ = 1, max_size_ = 1;
  std::vector<PointIndices>* clusters_ = nullptr;
};

}  // namespace pcl::detail
