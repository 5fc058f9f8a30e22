// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <algorithm>
#include <cstddef>
#include <memory>

#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <pcl/segmentation/lisco_cluster_writer.h>

template <typename PointT>
std::size_t pcl::LiscoClusterExtraction<PointT>::appendClusters(std::vector<PointIndices>& clusters) {
  // Copies share the list of all points, which initCompute () changes: each gets its own.
  if (fake_indices_ && indices_.use_count() > 1) indices_.reset();
  if (input_ && !indices_) {  // initCompute () lists all points, and takes this memory for them
    fake_indices_ = true;
    indices_ = std::make_shared<Indices>();
    detail::LiscoIndexMemory::reserve(*indices_, input_->size());
  }
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
  detail::sortLiscoClusters(clusters);
}

template <typename PointT>
void pcl::LiscoClusterExtraction<PointT>::extractWithLabels(std::vector<PointIndices>& clusters, Label* labels) {
  const std::size_t first = appendClusters(clusters);

  // The same sort on the sizes alone permutes them as it permutes the clusters, which identifies the new ones: the
  // vector may hold clusters of other clouds, from earlier calls.
  struct Origin {
    std::size_t size, place;
  };
  std::vector<Origin> origins;
  for (const auto& cluster : clusters) origins.push_back({cluster.indices.size(), origins.size()});
  std::sort(origins.rbegin(), origins.rend(), [](const Origin& a, const Origin& b) { return (a.size < b.size); });
  detail::sortLiscoClusters(clusters);

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
