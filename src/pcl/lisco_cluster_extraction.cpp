// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <limits>

#include <pcl/console/print.h>
#include <pcl/impl/instantiate.hpp>
#include <pcl/segmentation/impl/lisco_cluster_extraction.hpp>

bool pcl::detail::LiscoCloudClusterer::fitsIndexType(std::size_t points) {
  // The engine numbers points and runs with 31 bits.
  return (points <= static_cast<std::size_t>(std::numeric_limits<index_t>::max()) && points < std::size_t{1} << 31);
}

bool pcl::detail::LiscoCloudClusterer::select(std::size_t points, const Indices* indices, const char* caller) {
  if (!fitsIndexType(points)) {
    PCL_ERROR("[%s] The cloud has %zu points, more than pcl::index_t can number.\n", caller, points);
    return (false);
  }
  if (indices)
    for (const auto& index : *indices)
      if (index < 0 || static_cast<std::size_t>(index) >= points) {
        PCL_ERROR("[%s] Index %lld is not within the cloud of %zu points.\n", caller, static_cast<long long>(index),
                  points);
        return (false);
      }

  // A small part of a cloud is sorted out beforehand, so that the rest of the cloud costs nothing.
  constexpr std::size_t kSmallPart = 8;
  selection_ = !indices ? Selection::kAll : indices->size() < points / kSmallPart ? Selection::kFew : Selection::kMany;
  if (selection_ == Selection::kFew) {
    few_points_ = *indices;
    std::sort(few_points_.begin(), few_points_.end());
    few_points_.erase(std::unique(few_points_.begin(), few_points_.end()), few_points_.end());
  } else if (selection_ == Selection::kMany) {
    is_selected_.assign(points, 0);
    for (const auto& index : *indices) is_selected_[static_cast<std::size_t>(index)] = 1;
  }
  return (true);
}

void pcl::detail::LiscoCloudClusterer::collect(const Indices* indices, const PCLHeader& header, uindex_t min_size,
                                               uindex_t max_size, std::vector<PointIndices>& clusters) {
  writer_.start(clusterer_.subclusterCount(), header, min_size, max_size, clusters);

  // The order of the clusters is that of their first points in the indices; within each, indices ascend.
  if (indices && !std::is_sorted(indices->begin(), indices->end())) {
    std::uint32_t points = 0;
    for (const auto& index : *indices) points = std::max(points, static_cast<std::uint32_t>(index) + 1);
    constexpr std::uint32_t kNone = lisco::ColumnClusterer::kNone;
    subcluster_of_point_.assign(points, kNone);
    clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
      for (std::size_t i = 0; i < count; ++i) subcluster_of_point_[cells[i]] = subcluster;
    });
    for (const auto& index : *indices) {
      const std::uint32_t subcluster = subcluster_of_point_[static_cast<std::size_t>(index)];
      if (subcluster != kNone) writer_.indicesOf(subcluster, clusterer_.sizeOf(subcluster));
    }
  }
  clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
    Indices* const members = writer_.indicesOf(subcluster, clusterer_.sizeOf(subcluster));
    if (members) members->insert(members->end(), cells, cells + count);  // there is room
  });
}

PCL_INSTANTIATE(LiscoClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters_indices, PCL_XYZ_POINT_TYPES)
