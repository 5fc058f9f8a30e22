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

/** \brief Where the next point of a subcluster goes. */
struct LiscoClusterPlace {
  index_t* next;  ///< nullptr: its cluster has no place yet; if its size is not accepted, where all such points go
};

/** \brief Appends subclusters of accepted sizes to a vector as PCL's clusters, in the order of their first place (). */
template <typename Clusterer>
class LiscoClusterWriter {
 public:
  /** \param[in] clusterer lisco::ColumnClusterer or lisco::WindowClusterer, after update ()
   * \param places memory of the writer, which a caller may keep for the next one
   */
  LiscoClusterWriter(const Clusterer& clusterer, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
                     std::vector<LiscoClusterPlace>& places, std::vector<PointIndices>& clusters)
      : clusterer_(clusterer), header_(header), places_(places), clusters_(clusters) {
    places_.resize(clusterer.subclusterCount());
    std::uint32_t subcluster = 0;
    for (LiscoClusterPlace& place : places_) {
      const std::uint32_t size = clusterer.sizeOf(subcluster++);
      const bool is_accepted = size >= min_size && size <= max_size;
      place = {is_accepted ? nullptr : ignored_};
    }
  }
  LiscoClusterWriter(const LiscoClusterWriter&) = delete;
  LiscoClusterWriter& operator=(const LiscoClusterWriter&) = delete;

  /** \brief Gives the cluster of a subcluster the next place, unless it has one or its size is not accepted. */
  void place(std::uint32_t subcluster) {
    if (places_[subcluster].next == nullptr) places_[subcluster].next = begin(clusterer_.sizeOf(subcluster));
  }

  /** \brief Appends points to the cluster of a subcluster, if its size is accepted. In all, as many points are appended
   * as its size says.
   * \param[in] count at least 1
   * \param[in] point_at callable as index_t (std::size_t i), below \a count; may be called several times
   */
  template <typename PointAt>
  void append(std::uint32_t subcluster, std::size_t count, PointAt&& point_at) {
    place(subcluster);
    index_t* const to = places_[subcluster].next;
    const bool is_accepted = to != ignored_;
    if (count > kMaxIgnored && !is_accepted) return;
    // Those of sizes not accepted are written as well: which sizes follow each other is not foreseen.
    copy(to, count, point_at);
    places_[subcluster].next = to + (count & (std::size_t{0} - std::size_t{is_accepted}));  // without a branch
  }

 private:
  static constexpr std::size_t kMaxIgnored = 64;

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
    clusters_.emplace_back();
    clusters_.back().header = header_;
    clusters_.back().indices.resize(size);
    return (clusters_.back().indices.data());
  }

  const Clusterer& clusterer_;
  const PCLHeader& header_;
  std::vector<LiscoClusterPlace>& places_;  ///< of each subcluster
  index_t ignored_[kMaxIgnored];            ///< where points of subclusters of other sizes go
  std::vector<PointIndices>& clusters_;
};

}  // namespace pcl::detail
