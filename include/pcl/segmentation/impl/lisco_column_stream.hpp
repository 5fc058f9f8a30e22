// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>

#include <pcl/console/print.h>
#include <pcl/segmentation/extract_clusters.h>       // comparePointClusters
#include <pcl/segmentation/lisco_cloud_clusterer.h>  // fitsIndexType
#include <pcl/segmentation/lisco_column_stream.h>

template <typename PointT>
bool pcl::detail::LiscoColumnStream<PointT>::accepts(const PointT* points, std::size_t count, std::size_t columns,
                                                     const char* caller) {
  const std::size_t rows = std::max(count, most_rows_);
  if (!begun_)
    PCL_ERROR("[%s] A column before beginRotation () or beginStream (), or after an exception.\n", caller);
  else if (!points && count > 0)
    PCL_ERROR("[%s] A column without points.\n", caller);
  else if (lasers_ != 0 && count > lasers_)
    PCL_ERROR("[%s] A column of %zu rows, and only %zu lasers were declared.\n", caller, count, lasers_);
  else if (!LiscoCloudClusterer::fitsIndexType(rows) || !LiscoCloudClusterer::fitsIndexType(columns) ||
           !LiscoCloudClusterer::fitsIndexType(columns * rows))
    PCL_ERROR("[%s] %zu columns of %zu rows are more points than pcl::index_t can number.\n", caller, columns, rows);
  else
    return (true);
  return (false);
}

template <typename PointT>
const lisco::Return* pcl::detail::LiscoColumnStream<PointT>::namedColumn(const PointT* points, std::size_t count,
                                                                         std::uint32_t first_name) {
  named_column_.resize(count);
  for (std::size_t row = 0; row < count; ++row)
    named_column_[row] = {points[row].x, points[row].y, points[row].z, first_name + static_cast<std::uint32_t>(row)};
  return (named_column_.data());
}

template <typename PointT>
template <typename Clusterer>
void pcl::detail::LiscoColumnStream<PointT>::appendClusters(Clusterer& clusterer, std::uint64_t first_column,
                                                            std::uint64_t end_column,
                                                            std::vector<PointIndices>& clusters) {
  if (store_.heightOf(first_column, end_column) == 0) {  // an empty cloud
    clusters.clear();
    return;
  }
  const std::uint64_t width = end_column - first_column;
  writer_.start(clusterer.subclusterCount(), header_, min_pts_per_cluster_, max_pts_per_cluster_, clusters);
  clusterer.forEachRun([&](const std::uint32_t* names, std::size_t count, std::uint32_t subcluster) {
    Indices* const members = writer_.indicesOf(subcluster, clusterer.sizeOf(subcluster));
    if (!members) return;
    const auto cell = store_.cellOf(names[0]);  // the others lie beside it
    auto index = static_cast<index_t>(cell.row * width + (cell.column - first_column));
    for (std::size_t i = 0; i < count; ++i) members->push_back(index++);  // there is room
  });
  // Not a stable sort: only PCL's own call on PCL's own sequence gives PCL's order among clusters of one size.
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
}
