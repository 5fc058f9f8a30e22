// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Clouds as columns, for the tests of the streaming classes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <pcl/segmentation/lisco_endless_extraction.h>
#include <pcl/segmentation/lisco_stream_extraction.h>
#include <pcl/segmentation/lisco_window_extraction.h>

#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {

template <typename PointT>
using Columns = std::vector<pcl::PointCloud<PointT>>;

template <typename PointT>
Columns<PointT> columnsOf(const pcl::PointCloud<PointT>& cloud) {
  Columns<PointT> columns(cloud.width);
  for (std::uint32_t column = 0; column < cloud.width; ++column)
    for (std::uint32_t row = 0; row < cloud.height; ++row)
      columns[column].push_back(cloud[row * std::size_t{cloud.width} + column]);
  return columns;
}

/// Columns without some of the no-returns at their ends, some without any cell, and all at once.
template <typename PointT>
Columns<PointT> trimmed(Random& random, Columns<PointT> columns) {
  const double share = random.chance(0.5) ? 0.0 : random.unit();
  const double emptied = random.chance(0.7) ? 0.0 : 0.3 * random.unit();
  for (auto& column : columns) {
    if (random.chance(emptied)) column.clear();
    while (!column.empty() && random.chance(share) &&
           !lisco::isReturn(column.back().x, column.back().y, column.back().z))
      column.points.pop_back();
  }
  return columns;
}

/// The organized cloud of some columns, as the streaming classes define it.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr organized(const Columns<PointT>& columns, std::size_t first, std::size_t end,
                                                const pcl::PCLHeader& header) {
  std::size_t height = 0;
  for (std::size_t column = first; column < end; ++column) height = std::max(height, columns[column].size());
  PointT missing{};
  missing.x = missing.y = missing.z = std::numeric_limits<float>::quiet_NaN();
  auto cloud = std::make_shared<pcl::PointCloud<PointT>>();
  cloud->points.assign((end - first) * height, missing);
  cloud->width = static_cast<std::uint32_t>(end - first);
  cloud->height = static_cast<std::uint32_t>(height);
  cloud->is_dense = false;
  cloud->header = header;
  for (std::size_t column = first; column < end; ++column)
    for (std::size_t row = 0; row < columns[column].size(); ++row)
      (*cloud)[row * (end - first) + column - first] = columns[column][row];
  return cloud;
}

template <typename PointT>
bool areSamePoint(const PointT& a, const PointT& b) {
  return std::memcmp(&a.x, &b.x, 3 * sizeof(float)) == 0;
}

/// Bit for bit, NaN and negative zeros included.
template <typename PointT>
void expectSameCloud(const pcl::PointCloud<PointT>& expected, const pcl::PointCloud<PointT>& actual) {
  EXPECT_EQ(expected.header, actual.header);
  EXPECT_EQ(expected.width, actual.width);
  EXPECT_EQ(expected.height, actual.height);
  EXPECT_EQ(expected.is_dense, actual.is_dense);
  ASSERT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_TRUE(areSamePoint(expected[i], actual[i])) << "point " << i;
}

/// The clusters of a cloud by LiscoClusterExtraction, which is tested against PCL elsewhere.
template <typename PointT>
Clusters batchClustersOf(const typename pcl::PointCloud<PointT>::Ptr& cloud, const Request& request) {
  Clusters clusters;
  LiscoClient<PointT>().extract(cloud, nullptr, request, clusters);
  return clusters;
}

/// PCL's clusters of the returns of a cloud.
template <typename PointT>
Clusters pclClustersOf(const typename pcl::PointCloud<PointT>::Ptr& cloud, const Request& request) {
  Clusters clusters;
  PclClient<PointT>().extract(cloud, returnsOf(*cloud), request, clusters);
  return clusters;
}

inline pcl::PCLHeader anyHeader(std::uint32_t seq = 7) {
  pcl::PCLHeader header;
  header.frame_id = "lidar";
  header.stamp = 1234567;
  header.seq = seq;
  return header;
}

template <typename Extraction>
void set(Extraction& extraction, const Request& request) {
  extraction.setClusterTolerance(request.tolerance);
  extraction.setMinClusterSize(request.min_size);
  extraction.setMaxClusterSize(request.max_size);
}

/// Adds a column by either overload.
template <typename Extraction, typename PointT>
bool add(Extraction& extraction, Random& random, const pcl::PointCloud<PointT>& column) {
  return random.chance(0.5) ? extraction.addColumn(column)
                            : extraction.addColumn(column.points.data(), column.points.size());
}

/// A rotation by columns gives what PCL gives for its cloud.
template <typename PointT>
void expectRotationSameAsPcl(pcl::LiscoStreamExtraction<PointT>& stream, Random& random, const Columns<PointT>& columns,
                             const Request& request) {
  const auto cloud = organized(columns, 0, columns.size(), anyHeader());
  set(stream, request);
  stream.setHeader(anyHeader());
  stream.beginRotation();
  for (const auto& column : columns) ASSERT_TRUE(add(stream, random, column));
  ASSERT_EQ(stream.getNumberOfColumns(), columns.size());
  Clusters clusters;
  pcl::PointCloud<PointT> streamed;
  ASSERT_TRUE(stream.endRotation(clusters, streamed));
  expectSameUnlessMissed<PointT>(cloud, returnsOf(*cloud), request, pclClustersOf<PointT>(cloud, request), clusters);
  expectSame(batchClustersOf<PointT>(cloud, request), clusters);
  expectSameCloud(*cloud, streamed);
}

/// Windows give what PCL gives for their clouds.
template <typename PointT>
void expectWindowsSameAsPcl(pcl::LiscoWindowExtraction<PointT>& windows, Random& random, const Columns<PointT>& columns,
                            const Request& request, std::size_t window, std::size_t hop) {
  set(windows, request);
  windows.setHeader(anyHeader());
  windows.setWindowSize(window);
  windows.setHop(hop);
  ASSERT_TRUE(windows.beginStream());
  EXPECT_EQ(windows.getNumberOfColumns(), 0U);
  Clusters expected;
  typename pcl::PointCloud<PointT>::Ptr cloud;
  for (std::size_t end = 1; end <= columns.size(); ++end) {
    const bool ends = add(windows, random, columns[end - 1]);
    ASSERT_EQ(ends, end % hop == 0);
    if (ends) {
      cloud = organized(columns, end - std::min(end, window), end, anyHeader());
      expected = pclClustersOf<PointT>(cloud, request);
    }
    // Until the next one ends, the window can be queried.
    if (!cloud || !random.chance(ends ? 0.9 : 0.1)) continue;
    ASSERT_EQ(windows.getNumberOfColumns(), cloud->width);
    Clusters clusters;
    ASSERT_TRUE(windows.extract(clusters));
    ASSERT_TRUE(expectSameUnlessMissed<PointT>(cloud, returnsOf(*cloud), request, expected, clusters))
        << "window of " << window << ", hop of " << hop << ", column " << end;
    pcl::PointCloud<PointT> streamed;
    windows.getWindow(streamed);
    expectSameCloud(*cloud, streamed);
  }
}

}  // namespace lisco_test
