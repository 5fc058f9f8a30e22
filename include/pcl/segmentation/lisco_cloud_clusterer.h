// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>
#include <pcl/segmentation/lisco_pcl_version.h>

#include "lisco/strided_points.h"

namespace pcl::detail {

/** \brief The part common to LiscoClusterExtraction and extractLiscoClusters (): reads a PCL cloud into the clustering
 * engine and writes its subclusters as PCL's clusters. Keeps its memory from cloud to cloud.
 */
class LISCO_EXPORT LiscoCloudClusterer {
 public:
  LiscoCloudClusterer();
  ~LiscoCloudClusterer();
  LiscoCloudClusterer(const LiscoCloudClusterer& other);
  LiscoCloudClusterer& operator=(const LiscoCloudClusterer& other);

  /** \brief Clusters a cloud.
   * \param[in] indices the points to cluster; nullptr: all
   * \param[in] threads how many may share the work; 0: one for each core
   * \param[in] caller named in front of a PCL_ERROR
   * \return false, after a PCL_ERROR, if an index is not within the cloud or the cloud is too large for index_t
   */
  template <typename PointT>
  bool cluster(const PointCloud<PointT>& cloud, const Indices* indices, float tolerance, unsigned int threads,
               const char* caller) {
    lisco::StridedPoints points;
    if (!cloud.empty()) points = {&cloud[0].x, &cloud[0].y, &cloud[0].z, sizeof(PointT)};
    const auto& origin = cloud.sensor_origin_;
    const Layout layout{cloud.size(), cloud.width, cloud.height, {origin[0], origin[1], origin[2]}};
    return (clusterPoints(layout, points, indices, tolerance, threads, caller));
  }

  /** \brief Appends the clusters of the last cloud whose size is within [min_size, max_size], in the order in which
   * their first points appear in the indices; the indices of each ascend.
   */
  void collect(const Indices* indices, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
               std::vector<PointIndices>& clusters);

  /** \brief Whether point numbers up to \a points fit into index_t and into the engine. */
  static bool fitsIndexType(std::size_t points);

 private:
  struct Layout {
    std::size_t points, width, height;
    std::array<float, 3> sensor_origin;
  };

  bool clusterPoints(const Layout& layout, const lisco::StridedPoints& points, const Indices* indices, float tolerance,
                     unsigned int threads, const char* caller);

  template <typename PointAt>
  void collectPoints(const Indices* indices, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
                     const PointAt& point_at, std::vector<PointIndices>& clusters);

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace pcl::detail
