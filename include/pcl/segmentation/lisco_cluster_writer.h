// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/segmentation/extract_clusters.h>  // comparePointClusters
#include <pcl/segmentation/lisco_pcl_version.h>

#include "lisco/return.h"

namespace pcl::detail {

/** \brief Sorts clusters by size, the largest first, as EuclideanClusterExtraction::extract () does: by an unstable
 * sort, so that only the same call on the same sequence gives PCL's order among clusters of one size.
 */
inline void sortLiscoClusters(std::vector<PointIndices>& clusters) {
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
}

/** \brief Gives empty indices memory for \a count of them, if there is enough; the system provides new pages in one
 * call where it can: a page fault for each page would take longer.
 */
struct LISCO_EXPORT LiscoIndexMemory {
  static void reserve(Indices& indices, std::size_t count) noexcept;
};

/** \brief Memory of LiscoClusterWriter, which a caller may keep for the next one. */
struct LiscoClusterPlaces {
  std::vector<index_t*> next;  ///< of each subcluster: where its next point goes; nullptr: its cluster has no place yet
  std::vector<index_t*> last;  ///< the same from the last point backwards: behind where the next one goes
  std::vector<std::size_t> order;     ///< of the clusters, by their first points
  std::vector<PointIndices> ordered;  ///< the clusters in that order, while they are moved
};

/** \brief Appends subclusters of accepted sizes to a vector as PCL's clusters, in the order of their first place (). */
template <typename Clusterer>
class LiscoClusterWriter {
 public:
  using From = lisco::RunVisitor::From;

  /** \param[in] clusterer lisco::ColumnClusterer after update (), or lisco::WindowClusterer after a window */
  LiscoClusterWriter(const Clusterer& clusterer, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
                     LiscoClusterPlaces& places, std::vector<PointIndices>& clusters)
      : accepted_{inWord(min_size), inWord(max_size)},
        sizes_(clusterer.sizes()),
        header_(header),
        places_(places),
        clusters_(clusters),
        first_own_(clusters.size()) {
    const std::size_t count = clusterer.subclusterCount();
    places_.next.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      places_.next[i] = sizes_[i] >= min_size && sizes_[i] <= max_size ? nullptr : ignored_;
  }
  LiscoClusterWriter(const LiscoClusterWriter&) = delete;
  LiscoClusterWriter& operator=(const LiscoClusterWriter&) = delete;

  /** \brief The sizes accepted: points of subclusters of other sizes need not be appended. */
  const lisco::SizeRange& acceptedSizes() const { return (accepted_); }

  /** \brief Gives the cluster of a subcluster the next place, unless it has one or its size is not accepted. */
  void place(std::uint32_t subcluster) {
    if (places_.next[subcluster] == nullptr) places_.next[subcluster] = addCluster(sizes_[subcluster]);
  }

  /** \brief Gives all clusters that have none a place, so that a second thread may append () from the last points
   * backwards.
   */
  void placeAll() {
    places_.last.assign(places_.next.size(), ignored(From::kLast));
    for (std::uint32_t i = 0; i < places_.next.size(); ++i) {
      if (places_.next[i] == ignored(From::kFirst)) continue;
      place(i);
      places_.last[i] = places_.next[i] + sizes_[i];
    }
  }

  /** \brief Appends points to the cluster of a subcluster, if its size is accepted. In all, as many points are appended
   * as its size says.
   * \param[in] from the first: behind the points appended so far; the last: fills the cluster from its end backwards,
   * after placeAll ()
   * \param[in] count at least 1
   * \param[in] point_at callable as index_t (std::size_t i), below \a count; may be called several times
   */
  template <typename PointAt>
  void append(From from, std::uint32_t subcluster, std::size_t count, PointAt&& point_at) {
    const bool is_first = from == From::kFirst;
    if (is_first) place(subcluster);
    index_t*& next = is_first ? places_.next[subcluster] : places_.last[subcluster];
    const bool is_accepted = next != ignored(from);
    if (count > kMaxIgnored && !is_accepted) return;
    // Points of sizes that are not accepted are written, too: a branch on the size would be mispredicted.
    copy(is_first ? next : next - count, count, point_at);
    const std::size_t advance = count & (std::size_t{0} - std::size_t{is_accepted});  // without a branch
    next = is_first ? next + advance : next - advance;
  }

  /** \brief Appends points one by one, each to the cluster of its subcluster.
   * \param[in] from the last: in reverse order, as append () does
   * \param[in] point_at callable as index_t (std::size_t i), below \a count
   */
  template <typename PointAt>
  void appendSingle(From from, const std::uint32_t* subclusters, std::size_t count, PointAt&& point_at) {
    if (from == From::kFirst) {
      for (std::size_t i = 0; i < count; ++i) place(subclusters[i]);
      appendPairs<1>(places_.next.data(), ignored(from), subclusters, count, point_at);
    } else {
      appendPairs<-1>(places_.last.data(), ignored(from), subclusters, count, point_at);
    }
  }

  /** \brief Orders the clusters by their first points, which all have been appended, instead of their places. */
  void orderByFirstPoints() {
    places_.order.clear();
    for (std::size_t i = first_own_; i < clusters_.size(); ++i) places_.order.push_back(i);
    std::sort(places_.order.begin(), places_.order.end(), [this](std::size_t a, std::size_t b) {
      return (clusters_[a].indices.front() < clusters_[b].indices.front());
    });
    places_.ordered.clear();
    for (const std::size_t i : places_.order) places_.ordered.push_back(std::move(clusters_[i]));
    std::move(places_.ordered.begin(), places_.ordered.end(),
              clusters_.begin() + static_cast<std::ptrdiff_t>(first_own_));
  }

 private:
  /// Longest run of a size not accepted that is written to ignored (); a branch skips longer ones.
  static constexpr std::size_t kMaxIgnored = 64;

  /// Points from which on the memory of a cluster's indices has several pages.
  static constexpr std::uint32_t kLargeCluster = 4096;

  /** \brief A size, of those that subclusters may have; larger ones become the largest. */
  static std::uint32_t inWord(uindex_t size) {
    return (static_cast<std::uint32_t>(std::min<uindex_t>(size, std::numeric_limits<std::uint32_t>::max())));
  }

  /** \brief The place of points of sizes that are not accepted. */
  index_t* ignored(From from) { return (from == From::kFirst ? ignored_ : ignored_from_last_ + kMaxIgnored); }

  /** \brief Writes four points at a time, the last four again if need be: a branch for each point costs more. */
  template <typename PointAt>
  static void copy(index_t* to, std::size_t count, PointAt&& point_at) {
    constexpr std::size_t kStep = 4;
    if (count < kStep) {
      for (const std::size_t i : {std::size_t{0}, count / 2, count - 1}) to[i] = point_at(i);  // 1, 2 or 3 points
      return;
    }
    const auto copy_some = [&](std::size_t first) {
      for (std::size_t i = first; i < first + kStep; ++i) to[i] = point_at(i);
    };
    for (std::size_t first = 0; first + kStep < count; first += kStep) copy_some(first);
    copy_some(count - kStep);
  }

  /** \brief Writes two points at a time: the place of the second does not wait for that of the first to be written.
   * \tparam kStep 1: forwards; -1: backwards, where places are behind the points
   * \param[in] next the places, by subcluster
   */
  template <std::ptrdiff_t kStep, typename PointAt>
  static void appendPairs(index_t** next, const index_t* ignored, const std::uint32_t* subclusters, std::size_t count,
                          PointAt&& point_at) {
    constexpr std::ptrdiff_t kAt = kStep > 0 ? 0 : -1;
    const auto number = [count](std::size_t i) { return (kStep > 0 ? i : count - 1 - i); };
    const auto stepOf = [ignored](const index_t* place) { return (std::ptrdiff_t{place != ignored} * kStep); };
    std::size_t i = 0;
    for (; i + 1 < count; i += 2) {
      const std::uint32_t a = subclusters[number(i)];
      const std::uint32_t b = subclusters[number(i + 1)];
      index_t* const place_a = next[a];
      index_t* const place_b = next[b] + std::ptrdiff_t{a == b} * stepOf(next[b]);
      place_a[kAt] = point_at(number(i));
      place_b[kAt] = point_at(number(i + 1));
      next[a] = place_a + stepOf(place_a);
      next[b] = place_b + stepOf(place_b);
    }
    if (i == count) return;
    index_t*& place = next[subclusters[number(i)]];
    place[kAt] = point_at(number(i));
    place += stepOf(place);
  }

  /** \brief Not inlined, so that place (), which is called for each run, is. */
  [[gnu::noinline]] index_t* addCluster(std::uint32_t size) {
    static_assert(std::is_nothrow_move_constructible<PointIndices>::value, "clusters that move keep their indices");
    clusters_.emplace_back();
    clusters_.back().header = header_;
    if (size >= kLargeCluster) LiscoIndexMemory::reserve(clusters_.back().indices, size);
    clusters_.back().indices.resize(size);
    return (clusters_.back().indices.data());
  }

  const lisco::SizeRange accepted_;
  const std::uint32_t* const sizes_;  ///< of subclusters
  const PCLHeader& header_;
  LiscoClusterPlaces& places_;
  index_t ignored_[kMaxIgnored];            ///< where points of subclusters of other sizes go
  index_t ignored_from_last_[kMaxIgnored];  ///< the same, from the last backwards
  std::vector<PointIndices>& clusters_;
  const std::size_t first_own_;  ///< of the clusters, the first that this writer adds
};

/** \brief Indices of the points of a cloud stored row by row, a row per laser. */
struct LiscoRowMajorIndex {
  std::size_t width;  ///< of the cloud

  index_t operator()(std::size_t laser, std::size_t column) const {
    return (static_cast<index_t>(laser * width + column));
  }
};

/** \brief Appends what lisco::ColumnClusterer::forEachRun () visits, by place.
 * \tparam PointAt callable as index_t (std::size_t laser, std::size_t column)
 */
template <typename Writer, typename PointAt>
struct LiscoRunAppender {
  using From = lisco::RunVisitor::From;

  Writer& writer;
  PointAt point_at;

  void operator()(From from, std::uint32_t laser, std::uint32_t column, std::size_t count,
                  std::uint32_t subcluster) const {
    writer.append(from, subcluster, count, [&](std::size_t i) { return point_at(laser, column + i); });
  }
  void operator()(From from, std::uint32_t laser, const std::uint32_t* columns, std::size_t count,
                  const std::uint32_t* subclusters) const {
    writer.appendSingle(from, subclusters, count, [&](std::size_t i) { return point_at(laser, columns[i]); });
  }
  template <typename Columns, typename Subclusters>
  void operator()(std::uint32_t laser, Columns columns, std::size_t count, Subclusters subclusters) const {
    (*this)(From::kFirst, laser, columns, count, subclusters);
  }
};
template <typename Writer, typename PointAt>
LiscoRunAppender(Writer&, PointAt) -> LiscoRunAppender<Writer, PointAt>;

}  // namespace pcl::detail
