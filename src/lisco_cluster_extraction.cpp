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
  constexpr std::uint32_t kUndecided = ~std::uint32_t{0};
  constexpr std::uint32_t kNoCluster = kUndecided - 1;
  cluster_of_subcluster_.assign(clusterer_.subclusterCount(), kUndecided);
  const std::size_t first_cluster = clusters.size();
  const auto decide = [&](std::uint32_t subcluster) {
    if (cluster_of_subcluster_[subcluster] != kUndecided) return;
    const std::uint32_t size = clusterer_.sizeOf(subcluster);
    cluster_of_subcluster_[subcluster] = kNoCluster;
    if (size < min_size || size > max_size) return;
    cluster_of_subcluster_[subcluster] = static_cast<std::uint32_t>(clusters.size() - first_cluster);
    clusters.emplace_back();
    clusters.back().header = header;
    clusters.back().indices.reserve(size);
  };

  // The order of the clusters is that of their first points in the indices; within each, indices ascend.
  if (indices && !std::is_sorted(indices->begin(), indices->end())) {
    std::uint32_t points = 0;
    for (const auto& index : *indices) points = std::max(points, static_cast<std::uint32_t>(index) + 1);
    subcluster_of_point_.assign(points, kNoCluster);
    clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
      for (std::size_t i = 0; i < count; ++i) subcluster_of_point_[cells[i]] = subcluster;
    });
    for (const auto& index : *indices) {
      const std::uint32_t subcluster = subcluster_of_point_[static_cast<std::size_t>(index)];
      if (subcluster != kNoCluster) decide(subcluster);
    }
  }
  clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
    decide(subcluster);
    const std::uint32_t cluster = cluster_of_subcluster_[subcluster];
    if (cluster == kNoCluster) return;
    Indices& members = clusters[first_cluster + cluster].indices;
    members.insert(members.end(), cells, cells + count);  // there is room
  });
}

PCL_INSTANTIATE(LiscoClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters_indices, PCL_XYZ_POINT_TYPES)
