// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The vectors that doc/contract.md promises, by brute force, independent of PCL and the engine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "column_streams.h"
#include "oracle.h"
#include "pcl_stream.h"

namespace lisco_test {

/// The clusters of a cloud's points of the sizes asked for, in the order of their first points; not yet sorted.
template <typename PointT>
Clusters trueClustersOf(const pcl::PointCloud<PointT>& cloud, const Request& request) {
  std::vector<Point> points;
  for (const PointT& point : cloud) points.push_back({point.x, point.y, point.z});
  Clusters clusters;
  for (const Cluster& cluster : trueClusters(points, static_cast<float>(request.tolerance))) {
    if (cluster.members.size() < request.min_size || cluster.members.size() > request.max_size) continue;
    clusters.emplace_back();
    clusters.back().header = cloud.header;
    clusters.back().indices.assign(cluster.members.begin(), cluster.members.end());
  }
  return clusters;
}

/// Appends a cloud's clusters to a vector as extract () promises it.
template <typename PointT>
void appendTrueClusters(const pcl::PointCloud<PointT>& cloud, const Request& request, Clusters& clusters) {
  if (cloud.empty()) return clusters.clear();
  for (const auto& cluster : trueClustersOf(cloud, request)) clusters.push_back(cluster);
  std::sort(clusters.rbegin(), clusters.rend(), pcl::comparePointClusters);
}

/// The columns of a stream, as the streaming classes take them.
inline Columns<pcl::PointXYZ> columnsOf(const EndlessStream& stream) {
  Columns<pcl::PointXYZ> columns(stream.columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (const lisco::Return& cell : stream.columns[i].cells) columns[i].push_back({cell.x, cell.y, cell.z});
  return columns;
}

/// A tolerance as the stream has it, and any sizes.
inline Request requestFor(Random& random, const EndlessStream& stream) {
  Request request;
  request.tolerance = static_cast<double>(stream.parameters.tolerance);
  if (random.chance(0.5)) request.min_size = static_cast<pcl::uindex_t>(random.below(5));
  if (random.chance(0.2)) request.max_size = static_cast<pcl::uindex_t>(random.below(30));
  return request;
}

/// The deliveries of the sizes asked for.
inline std::vector<Delivery> wanted(std::vector<Delivery> deliveries, const Request& request) {
  const auto is_unwanted = [&](const Delivery& delivery) {
    return delivery.members.size() < request.min_size || delivery.members.size() > request.max_size;
  };
  deliveries.erase(std::remove_if(deliveries.begin(), deliveries.end(), is_unwanted), deliveries.end());
  return deliveries;
}

/// A user's deliveries of an endless stream, compared with the points that were given.
class EndlessReceiver {
 public:
  using Extraction = pcl::LiscoEndlessExtraction<pcl::PointXYZ>;

  /// Makes the next columns those of this stream, counted from its first.
  void expect(const EndlessStream& stream, const pcl::PCLHeader& header) {
    stream_ = &stream;
    header_ = header;
    deliveries_.clear();
    column = 0;
  }

  void receive(const Extraction::Cluster& cluster) {
    Delivery delivery{{}, cluster.is_cut, cluster.is_continued, cluster.first_position, cluster.last_position,
                      0,  column};
    EXPECT_EQ(cluster.cloud.header, header_);
    EXPECT_EQ(cluster.cloud.width, cluster.cloud.size());
    EXPECT_EQ(cluster.cloud.height, 1U);
    ASSERT_EQ(cluster.cells.size(), cluster.cloud.size());
    for (std::size_t i = 0; i < cluster.cells.size(); ++i) {
      const auto& place = cluster.cells[i];
      ASSERT_LT(place.column, stream_->columns.size());
      const StreamColumn& source = stream_->columns[static_cast<std::size_t>(place.column)];
      ASSERT_LT(place.row, source.cells.size());
      const lisco::Return& cell = source.cells[place.row];
      ASSERT_TRUE(areSamePoint(cluster.cloud[i], pcl::PointXYZ(cell.x, cell.y, cell.z)));
      delivery.members.push_back(cell.source_index);
    }
    std::sort(delivery.members.begin(), delivery.members.end());
    deliveries_.push_back(delivery);
  }

  const std::vector<Delivery>& deliveries() const { return deliveries_; }

  std::size_t column = 0;  ///< that is being added

 private:
  const EndlessStream* stream_ = nullptr;
  pcl::PCLHeader header_;
  std::vector<Delivery> deliveries_;
};

}  // namespace lisco_test
