// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/console/print.h>
#include <pcl/segmentation/extract_clusters.h>       // comparePointClusters
#include <pcl/segmentation/lisco_cloud_clusterer.h>  // fitsIndexType
#include <pcl/segmentation/lisco_cluster_writer.h>
#include <pcl/segmentation/lisco_column_store.h>
#include <pcl/segmentation/lisco_column_stream.h>

#include "lisco/return.h"

namespace pcl {

namespace detail {

/** \brief What the states of the classes that are given one column after the other have in common. */
template <typename PointT>
class LiscoReceivedColumns {
 public:
  /** \brief Whether a column can be taken; if not, after a PCL_ERROR.
   * \param[in] columns number of columns kept, with this one
   * \param[in] lasers most rows of a column; 0: any number
   * \param[in] caller named in front of the PCL_ERROR
   */
  bool accepts(const PointT* points, std::size_t count, std::size_t columns, std::size_t lasers,
               const char* caller) const;

  /** \brief A column with its cells' names, as the engine takes it. Valid until the next call. */
  const lisco::Return* namedColumn(const PointT* points, std::size_t count, std::uint32_t first_name);

  /** \brief Appends the clusters of some columns as LiscoClusterExtraction does it for their organized cloud.
   * \param[in] clusterer holds the subclusters of just these columns
   * \param[in] settings the sizes that clusters may have, and their header
   */
  template <typename Clusterer>
  void appendClusters(Clusterer& clusterer, std::uint64_t first_column, std::uint64_t end_column,
                      const LiscoColumnStream<PointT>& settings, std::vector<PointIndices>& clusters);

  bool begun = false;         ///< and left by no exception since
  std::size_t most_rows = 0;  ///< of any column since the beginning
  LiscoColumnStore<PointT> store;

 private:
  LiscoClusterWriter writer_;
  std::vector<lisco::Return> named_column_;
};

}  // namespace detail

}  // namespace pcl

template <typename PointT>
bool pcl::detail::LiscoReceivedColumns<PointT>::accepts(const PointT* points, std::size_t count, std::size_t columns,
                                                        std::size_t lasers, const char* caller) const {
  const std::size_t rows = std::max(count, most_rows);
  if (!begun)
    PCL_ERROR("[%s] A column before beginRotation () or beginStream (), or after an exception.\n", caller);
  else if (!points && count > 0)
    PCL_ERROR("[%s] A column without points.\n", caller);
  else if (lasers != 0 && count > lasers)
    PCL_ERROR("[%s] A column of %zu rows, and only %zu lasers were declared.\n", caller, count, lasers);
  else if (!LiscoCloudClusterer::fitsIndexType(rows) || !LiscoCloudClusterer::fitsIndexType(columns) ||
           !LiscoCloudClusterer::fitsIndexType(columns * rows))
    PCL_ERROR("[%s] %zu columns of %zu rows are more points than pcl::index_t can number.\n", caller, columns, rows);
  else
    return (true);
  return (false);
}

template <typename PointT>
const lisco::Return* pcl::detail::LiscoReceivedColumns<PointT>::namedColumn(const PointT* points, std::size_t count,
                                                                            std::uint32_t first_name) {
  named_column_.resize(count);
  for (std::size_t row = 0; row < count; ++row)
    named_column_[row] = {points[row].x, points[row].y, points[row].z, first_name + static_cast<std::uint32_t>(row)};
  return (named_column_.data());
}

template <typename PointT>
template <typename Clusterer>
void pcl::detail::LiscoReceivedColumns<PointT>::appendClusters(Clusterer& clusterer, std::uint64_t first_column,
                                                               std::uint64_t end_column,
                                                               const LiscoColumnStream<PointT>& settings,
                                                               std::vector<PointIndices>& clusters) {
  if (store.heightOf(first_column, end_column) == 0) {  // an empty cloud
    clusters.clear();
    return;
  }
  const std::uint64_t width = end_column - first_column;
  writer_.start(clusterer.subclusterCount(), settings.getHeader(), settings.getMinClusterSize(),
                settings.getMaxClusterSize(), clusters);
  clusterer.forEachRun([&](const std::uint32_t* names, std::size_t count, std::uint32_t subcluster) {
    Indices* const members = writer_.indicesOf(subcluster, clusterer.sizeOf(subcluster));
    if (!members) return;
    const auto cell = store.cellOf(names[0]);  // the others lie beside it
    auto index = static_cast<index_t>(cell.row * width + (cell.column - first_column));
    for (std::size_t i = 0; i < count; ++i) members->push_back(index++);  // there is room
  });
  // Not a stable sort: only PCL's own call on PCL's own sequence gives PCL's order among clusters of one size.
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
}
