// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include <pcl/PCLHeader.h>
#include <pcl/point_cloud.h>
#include <pcl/segmentation/lisco_pcl_version.h>

namespace pcl::detail {

/** \brief The part common to the classes that receive one column after the other. Errors are reported by PCL_ERROR
 * and change nothing but the output arguments. An exception (memory was refused, or a callback threw) ends the rotation
 * or stream, unless it comes from writing clusters out: no column is taken and nothing is delivered until the next one
 * begins.
 */
template <typename PointT>
class LiscoColumnStream {
 public:
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief Set the cluster tolerance: points nearer to each other than this belong together. Takes effect when the
   * next rotation or stream begins.
   * \param[in] tolerance metres (default 0). A negative one acts as its absolute value; with 0 or NaN every point is a
   * cluster of its own.
   */
  inline void setClusterTolerance(double tolerance) { cluster_tolerance_ = tolerance; }
  /** \brief Get the cluster tolerance in metres. */
  inline double getClusterTolerance() const { return (cluster_tolerance_); }

  /** \brief Set the least number of points of a cluster (default 1). Takes effect where clusters are written next; in
   * LiscoEndlessExtraction when the next stream begins.
   */
  inline void setMinClusterSize(pcl::uindex_t min_cluster_size) { min_pts_per_cluster_ = min_cluster_size; }
  /** \brief Get the least number of points of a cluster. */
  inline pcl::uindex_t getMinClusterSize() const { return (min_pts_per_cluster_); }

  /** \brief Set the largest number of points of a cluster (default: no limit). Takes effect as the least one. */
  inline void setMaxClusterSize(pcl::uindex_t max_cluster_size) { max_pts_per_cluster_ = max_cluster_size; }
  /** \brief Get the largest number of points of a cluster. */
  inline pcl::uindex_t getMaxClusterSize() const { return (max_pts_per_cluster_); }

  /** \brief Declare the number of lasers: a column with more rows is an error (default 0: any number). Columns may
   * always have fewer. Takes effect with the next column.
   */
  inline void setNumberOfLasers(std::size_t lasers) { lasers_ = lasers; }
  /** \brief Get the number of lasers, as it was set. */
  inline std::size_t getNumberOfLasers() const { return (lasers_); }

  /** \brief Set the header that clusters and clouds are given from now on. */
  inline void setHeader(const PCLHeader& header) { header_ = header; }
  /** \brief Get the header of clusters and clouds. */
  inline const PCLHeader& getHeader() const { return (header_); }

 protected:
  /** \brief Allocates an organized cloud.
   *
   * Eigen's allocator, which every PointCloud uses, works differently in code compiled for AVX: the library must not
   * free what its user has allocated, nor the reverse. Users' clouds are therefore allocated here, by their compiler,
   * and filled by the library.
   */
  static inline void allocate(std::size_t width, std::size_t height, PointCloud& cloud) {
    cloud.points.resize(width * height);
    cloud.width = static_cast<std::uint32_t>(width);
    cloud.height = static_cast<std::uint32_t>(height);
    cloud.is_dense = false;
  }

  double cluster_tolerance_ = 0;
  pcl::uindex_t min_pts_per_cluster_ = 1;
  pcl::uindex_t max_pts_per_cluster_ = std::numeric_limits<pcl::uindex_t>::max();
  std::size_t lasers_ = 0;
  PCLHeader header_;
};

}  // namespace pcl::detail
