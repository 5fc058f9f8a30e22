// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <limits>

#include <pcl/console/print.h>
#include <pcl/impl/instantiate.hpp>
#include <pcl/segmentation/impl/lisco_cluster_extraction.hpp>

bool pcl::detail::LiscoCloudClusterer::fitsIndexType(std::size_t points) {
  // The engine numbers points, runs and patches with 31 bits.
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
  few_ = indices && indices->size() < points / kSmallPart;
  few_points_.clear();
  if (few_) {
    few_points_ = *indices;
    std::sort(few_points_.begin(), few_points_.end());
    few_points_.erase(std::unique(few_points_.begin(), few_points_.end()), few_points_.end());
    head_of_cell_.assign(few_points_.size(), kSelected);
    return (true);
  }
  head_of_cell_.assign(points, indices ? kNotSelected : kSelected);
  if (indices)
    for (const auto& index : *indices) head_of_cell_[static_cast<std::size_t>(index)] = kSelected;
  return (true);
}

std::uint32_t pcl::detail::LiscoCloudClusterer::headOf(index_t point) const {
  const std::size_t cell =
      few_ ? static_cast<std::size_t>(std::lower_bound(few_points_.begin(), few_points_.end(), point) -
                                      few_points_.begin())
           : static_cast<std::size_t>(point);
  return (head_of_cell_[cell]);
}

void pcl::detail::LiscoCloudClusterer::collect(const Indices* indices, const PCLHeader& header, uindex_t min_size,
                                               uindex_t max_size, std::vector<PointIndices>& clusters) {
  clusterer_.forEachRun([this](const std::uint32_t* cells, std::size_t count, std::uint32_t head) {
    for (std::size_t i = 0; i < count; ++i) head_of_cell_[cells[i]] = head;
  });

  constexpr std::uint32_t kUndecided = ~std::uint32_t{0};
  constexpr std::uint32_t kNoCluster = kUndecided - 1;
  cluster_of_head_.assign(clusterer_.headLimit(), kUndecided);
  const std::size_t first_cluster = clusters.size();
  const auto decide = [&](std::uint32_t head) {
    const std::uint32_t size = clusterer_.weight(head);
    cluster_of_head_[head] = kNoCluster;
    if (size < min_size || size > max_size) return;
    cluster_of_head_[head] = static_cast<std::uint32_t>(clusters.size() - first_cluster);
    clusters.emplace_back();
    clusters.back().header = header;
    clusters.back().indices.reserve(size);
  };
  const auto decide_once = [&](std::uint32_t head) {
    if (head < kSelected && cluster_of_head_[head] == kUndecided) decide(head);
  };

  // The order of the clusters is that of their first points in the indices; within each, indices ascend.
  if (indices)
    for (const auto& index : *indices) decide_once(headOf(index));
  for (std::size_t cell = 0; cell < head_of_cell_.size(); ++cell) {
    const std::uint32_t head = head_of_cell_[cell];
    decide_once(head);
    if (head < kSelected && cluster_of_head_[head] != kNoCluster)
      clusters[first_cluster + cluster_of_head_[head]].indices.push_back(few_ ? few_points_[cell]
                                                                              : static_cast<index_t>(cell));
  }
}

PCL_INSTANTIATE(LiscoClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters_indices, PCL_XYZ_POINT_TYPES)
