// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "lisco/sensor_hints.h"

template <typename PointT>
bool pcl::detail::LiscoCloudClusterer::cluster(const PointCloud<PointT>& cloud, const Indices* indices, float tolerance,
                                               unsigned int threads, const char* caller) {
  if (!select(cloud.size(), indices, caller)) return (false);

  // Lasers are the cloud's rows and columns its columns; what is not organized is the work of one laser.
  const bool organized = selection_ != Selection::kFew && cloud.height > 1 &&
                         static_cast<std::size_t>(cloud.width) * cloud.height == cloud.size();
  const std::size_t lasers = organized ? cloud.height : 1;
  const std::size_t columns = (selection_ == Selection::kFew ? few_points_.size() : cloud.size()) / lasers;
  const std::array<float, 3> sensor{cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2]};
  const PointT* const points = cloud.points.data();
  const auto return_at = [points](std::size_t point) {
    return (lisco::Return{points[point].x, points[point].y, points[point].z, static_cast<std::uint32_t>(point)});
  };
  const auto cluster = [&](const auto& cell_at) {
    lisco::Parameters parameters;
    parameters.tolerance = tolerance;
    parameters.sensor = lisco::estimateSensor(columns, lasers, sensor, lisco::CellSource(cell_at));
    parameters.expected_returns = columns * lasers;
    parameters.threads = threads;
    clusterer_.begin(parameters);
    clusterer_.addColumns(columns, lasers, cell_at);
    clusterer_.update();
  };
  switch (selection_) {
    case Selection::kAll:
      cluster([&](std::size_t laser, std::size_t column) { return (return_at(laser * columns + column)); });
      break;
    case Selection::kMany:
      cluster([&](std::size_t laser, std::size_t column) {
        const std::size_t point = laser * columns + column;
        return (is_selected_[point] ? return_at(point) : lisco::kNoReturn);
      });
      break;
    case Selection::kFew:
      cluster(
          [&](std::size_t, std::size_t column) { return (return_at(static_cast<std::size_t>(few_points_[column]))); });
      break;
  }
  return (true);
}

template <typename PointT>
std::size_t pcl::LiscoClusterExtraction<PointT>::appendClusters(std::vector<PointIndices>& clusters) {
  if (!initCompute() || input_->empty() || indices_->empty()) {
    clusters.clear();
    return (0);
  }
  const std::size_t first = clusters.size();
  const Indices* const indices = fake_indices_ ? nullptr : indices_.get();
  if (clusterer_.cluster(*input_, indices, static_cast<float>(cluster_tolerance_), threads_,
                         "pcl::LiscoClusterExtraction::extract"))
    clusterer_.collect(indices, input_->header, min_pts_per_cluster_, max_pts_per_cluster_, clusters);
  else
    clusters.clear();
  deinitCompute();
  return (std::min(first, clusters.size()));
}

template <typename PointT>
void pcl::LiscoClusterExtraction<PointT>::extract(std::vector<PointIndices>& clusters) {
  appendClusters(clusters);
  // Not a stable sort: only PCL's own call on PCL's own sequence gives PCL's order among clusters of one size.
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
}

template <typename PointT>
void pcl::LiscoClusterExtraction<PointT>::extractWithLabels(std::vector<PointIndices>& clusters, Label* labels) {
  const std::size_t first = appendClusters(clusters);

  // The same sort on the sizes alone moves them as it moves the clusters, which tells where each came from:
  // the vector may hold clusters of other clouds, from calls before this one.
  struct Origin {
    std::size_t size, place;
  };
  std::vector<Origin> origins;
  for (const auto& cluster : clusters) origins.push_back({cluster.indices.size(), origins.size()});
  std::sort(origins.rbegin(), origins.rend(), [](const Origin& a, const Origin& b) { return (a.size < b.size); });
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);

  for (std::size_t number = 0; number < clusters.size(); ++number)
    if (origins[number].place >= first)
      for (const auto& point : clusters[number].indices)
        labels[static_cast<std::size_t>(point)].label = static_cast<std::uint32_t>(number + 1);
}

template <typename PointT>
void pcl::extractLiscoClusters(const PointCloud<PointT>& cloud, float tolerance, std::vector<PointIndices>& clusters,
                               unsigned int min_pts_per_cluster, unsigned int max_pts_per_cluster) {
  detail::LiscoCloudClusterer clusterer;
  if (clusterer.cluster(cloud, nullptr, tolerance, 1, "pcl::extractLiscoClusters"))
    clusterer.collect(nullptr, cloud.header, min_pts_per_cluster, max_pts_per_cluster, clusters);
  else
    clusters.clear();
}

template <typename PointT>
void pcl::extractLiscoClusters(const PointCloud<PointT>& cloud, const Indices& indices, float tolerance,
                               std::vector<PointIndices>& clusters, unsigned int min_pts_per_cluster,
                               unsigned int max_pts_per_cluster) {
  detail::LiscoCloudClusterer clusterer;
  if (clusterer.cluster(cloud, &indices, tolerance, 1, "pcl::extractLiscoClusters"))
    clusterer.collect(&indices, cloud.header, min_pts_per_cluster, max_pts_per_cluster, clusters);
  else
    clusters.clear();
}

#define PCL_INSTANTIATE_LiscoClusterExtraction(T) template class LISCO_EXPORT pcl::LiscoClusterExtraction<T>;
#define PCL_INSTANTIATE_extractLiscoClusters(T)            \
  template void LISCO_EXPORT pcl::extractLiscoClusters<T>( \
      const pcl::PointCloud<T>&, float, std::vector<pcl::PointIndices>&, unsigned int, unsigned int);
#define PCL_INSTANTIATE_extractLiscoClusters_indices(T)                                                          \
  template void LISCO_EXPORT pcl::extractLiscoClusters<T>(const pcl::PointCloud<T>&, const pcl::Indices&, float, \
                                                          std::vector<pcl::PointIndices>&, unsigned int,         \
                                                          unsigned int);
