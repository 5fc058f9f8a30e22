// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "lisco/return.h"
#include "oracle.h"

namespace lisco_test {

using Clusters = std::vector<pcl::PointIndices>;

/// Parameters of either class; the defaults are PCL's.
struct Request {
  double tolerance = 0.5;
  pcl::uindex_t min_size = 1;
  pcl::uindex_t max_size = std::numeric_limits<pcl::uindex_t>::max();
};

/// A user's code, for pcl::EuclideanClusterExtraction and pcl::LiscoClusterExtraction alike.
template <typename Extraction>
class Client {
 public:
  using PointCloud = typename Extraction::PointCloud;
  using PointT = typename PointCloud::PointType;

  Client() { extraction.setSearchMethod(std::make_shared<pcl::search::KdTree<PointT>>(false)); }

  /// Appends to the clusters, as both classes do.
  void extract(const typename PointCloud::ConstPtr& cloud, const pcl::IndicesPtr& indices, const Request& request,
               Clusters& clusters) {
    extraction.setInputCloud(cloud);
    extraction.setIndices(indices);
    extraction.setClusterTolerance(request.tolerance);
    extraction.setMinClusterSize(request.min_size);
    extraction.setMaxClusterSize(request.max_size);
    extraction.extract(clusters);
  }

  Extraction extraction;
};

template <typename PointT>
using PclClient = Client<pcl::EuclideanClusterExtraction<PointT>>;
template <typename PointT>
using LiscoClient = Client<pcl::LiscoClusterExtraction<PointT>>;

/// Those of the indices (nullptr: of all points) that are returns, in the same order: PCL's input.
template <typename PointT>
pcl::IndicesPtr returnsOf(const pcl::PointCloud<PointT>& cloud, const pcl::IndicesPtr& indices = nullptr) {
  auto returns = std::make_shared<pcl::Indices>();
  const auto add = [&](pcl::index_t index) {
    const PointT& point = cloud[static_cast<std::size_t>(index)];
    if (lisco::isReturn(point.x, point.y, point.z)) returns->push_back(index);
  };
  if (indices)
    for (const pcl::index_t index : *indices) add(index);
  else
    for (pcl::index_t index = 0; index < static_cast<pcl::index_t>(cloud.size()); ++index) add(index);
  return returns;
}

inline bool areSame(const pcl::PointIndices& a, const pcl::PointIndices& b) {
  return a.indices == b.indices && a.header.frame_id == b.header.frame_id && a.header.stamp == b.header.stamp &&
         a.header.seq == b.header.seq;
}

/// Whole vectors, headers and order included.
inline bool areSame(const Clusters& a, const Clusters& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const pcl::PointIndices& x, const pcl::PointIndices& y) { return areSame(x, y); });
}

/// Whole vectors are equal, headers and order included. \return whether they are
inline bool expectSame(const Clusters& expected, const Clusters& actual) {
  EXPECT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < std::min(expected.size(), actual.size()); ++i) {
    if (areSame(expected[i], actual[i])) continue;
    ADD_FAILURE() << "cluster " << i << " of " << expected.size() << ": " << expected[i].indices.size()
                  << " points expected, " << actual[i].indices.size() << " found, or others";
    return false;
  }
  return expected.size() == actual.size();
}

/// The vector that doc/contract.md defines, from the oracle's components in O(n^2).
/// \param indices which points of the cloud, all of them returns; may repeat
template <typename PointT>
Clusters clustersByDefinition(const pcl::PointCloud<PointT>& cloud, const pcl::Indices& indices,
                              const Request& request) {
  std::vector<bool> is_taken(cloud.size(), false);
  pcl::Indices distinct;
  std::vector<Point> points;
  for (const pcl::index_t index : indices) {
    const PointT& point = cloud[static_cast<std::size_t>(index)];
    if (is_taken[static_cast<std::size_t>(index)]) continue;
    is_taken[static_cast<std::size_t>(index)] = true;
    distinct.push_back(index);
    points.push_back({point.x, point.y, point.z});
  }
  Clusters clusters;
  for (const Cluster& component : trueClusters(points, static_cast<float>(request.tolerance))) {
    if (component.members.size() < request.min_size || component.members.size() > request.max_size) continue;
    pcl::PointIndices& cluster = clusters.emplace_back();
    cluster.header = cloud.header;
    for (const std::uint32_t member : component.members) cluster.indices.push_back(distinct[member]);
    std::sort(cluster.indices.begin(), cluster.indices.end());
  }
  std::sort(clusters.rbegin(), clusters.rend(), pcl::comparePointClusters);
  return clusters;
}

/// Whether each cluster of one vector lies within a cluster of the other.
inline bool isRefinement(const Clusters& fine, const Clusters& coarse, std::size_t points) {
  std::vector<std::size_t> cluster_of(points, 0);
  for (std::size_t number = 0; number < coarse.size(); ++number)
    for (const pcl::index_t index : coarse[number].indices) cluster_of[static_cast<std::size_t>(index)] = number + 1;
  return std::all_of(fine.begin(), fine.end(), [&](const pcl::PointIndices& cluster) {
    const std::size_t first = cluster_of[static_cast<std::size_t>(cluster.indices.front())];
    return first != 0 && std::all_of(cluster.indices.begin(), cluster.indices.end(), [&](pcl::index_t index) {
             return cluster_of[static_cast<std::size_t>(index)] == first;
           });
  });
}

/// Expects equal vectors; if PCL's tree has missed a pair by rounding (doc/contract.md), the vector of the definition,
/// and PCL's components as parts of the true ones.
/// \param returns of the cloud, as given to PCL
template <typename PointT>
bool expectSameUnlessMissed(const typename pcl::PointCloud<PointT>::ConstPtr& cloud, const pcl::IndicesPtr& returns,
                            const Request& request, const Clusters& by_pcl, const Clusters& actual) {
  if (areSame(by_pcl, actual)) return true;
  const Request any_size{request.tolerance};
  const Clusters components = clustersByDefinition(*cloud, *returns, any_size);
  Clusters components_by_pcl;
  PclClient<PointT>().extract(cloud, returns, any_size, components_by_pcl);
  if (areSame(components, components_by_pcl)) return expectSame(by_pcl, actual);  // PCL is right
  EXPECT_TRUE(isRefinement(components_by_pcl, components, cloud->size()));
  return expectSame(clustersByDefinition(*cloud, *returns, request), actual);
}

/// Expects the same vector of both clients on the same returns. \return PCL's
template <typename PointT>
Clusters expectSameAsPcl(const typename pcl::PointCloud<PointT>::ConstPtr& cloud, const pcl::IndicesPtr& indices,
                         const Request& request) {
  Clusters expected;
  Clusters actual;
  // Without a return PCL would be given no index at all, and clears the vector.
  const pcl::IndicesPtr returns = returnsOf(*cloud, indices);
  PclClient<PointT>().extract(cloud, returns, request, expected);
  LiscoClient<PointT>().extract(cloud, indices, request, actual);
  expectSameUnlessMissed<PointT>(cloud, returns, request, expected, actual);
  return expected;
}

}  // namespace lisco_test
