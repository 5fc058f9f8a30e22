// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <gtest/gtest.h>

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

namespace lisco_test {

using Clusters = std::vector<pcl::PointIndices>;

/// What a user of either class decides; the defaults are PCL's.
struct Request {
  double tolerance = 0.5;
  pcl::uindex_t min_size = 1;
  pcl::uindex_t max_size = std::numeric_limits<pcl::uindex_t>::max();
};

/// A user's code, written once for pcl::EuclideanClusterExtraction and pcl::LiscoClusterExtraction: changing
/// the class name is all that migration takes.
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

/// Those of the indices (nullptr: of all points) that are returns: what PCL is to be given, in the same order.
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

/// Indices that are no returns, appended, change nothing: whole vectors are equal, headers and order
/// included. \return whether they are
inline bool expectSame(const Clusters& expected, const Clusters& actual) {
  EXPECT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < std::min(expected.size(), actual.size()); ++i) {
    const bool same =
        expected[i].indices == actual[i].indices && expected[i].header.frame_id == actual[i].header.frame_id &&
        expected[i].header.stamp == actual[i].header.stamp && expected[i].header.seq == actual[i].header.seq;
    if (same) continue;
    ADD_FAILURE() << "cluster " << i << " of " << expected.size() << ": " << expected[i].indices.size()
                  << " points expected, " << actual[i].indices.size() << " found, or others";
    return false;
  }
  return expected.size() == actual.size();
}

/// Both clients' clusters of the same returns are the same vector. \return PCL's
template <typename PointT>
Clusters expectSameAsPcl(const typename pcl::PointCloud<PointT>::ConstPtr& cloud, const pcl::IndicesPtr& indices,
                         const Request& request) {
  Clusters expected;
  Clusters actual;
  // Without a return PCL would be given no index at all, and clears the vector.
  PclClient<PointT>().extract(cloud, returnsOf(*cloud, indices), request, expected);
  LiscoClient<PointT>().extract(cloud, indices, request, actual);
  expectSame(expected, actual);
  return expected;
}

}  // namespace lisco_test
