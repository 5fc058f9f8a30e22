// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>
#include <pcl/segmentation/lisco_column_stream.h>

namespace pcl {

/** \brief Euclidean clusters of a rotating LiDAR's scan, while the sensor turns: columns are clustered as they arrive,
 * the subclusters so far are available at any time, and the clusters right after the last column.
 *
 * \code
 * pcl::LiscoStreamExtraction<pcl::PointXYZI> stream;
 * stream.setClusterTolerance (0.4);                        // metres
 * stream.setMinClusterSize (10);
 * stream.beginRotation ();
 * while (...)
 *   stream.addColumn (points, 64);                         // the points that the lasers measured in this step
 * std::vector<pcl::PointIndices> clusters;
 * pcl::PointCloud<pcl::PointXYZI> cloud;                   // organized: a row for each laser, a column for each step
 * stream.endRotation (clusters, cloud);
 * \endcode
 *
 * endRotation () gives, byte for byte, the vector that LiscoClusterExtraction::extract () gives for the organized cloud
 * of these columns. In that cloud a point has the index row * width + column; its width is the number of columns, its
 * height the most rows of any column.
 *
 * The rows of a column are its lasers, always in the same order; a laser without a return is NaN or (0, 0, 0), columns
 * may have fewer rows than others or none. Points of each column are copied.
 *
 * One object for all rotations keeps its memory, and estimates the sensor from the last rotation, which decides the
 * speed, never the result. It is for one thread at a time; any number may work side by side. \ingroup segmentation
 */
template <typename PointT>
class LiscoStreamExtraction : public detail::LiscoColumnStream<PointT> {
  using Base = detail::LiscoColumnStream<PointT>;

 public:
  using PointCloud = typename Base::PointCloud;  ///< of its points

  /** \brief Begin a rotation. Discards one that has not been ended. */
  void beginRotation();

  /** \brief Add the next column of the rotation.
   * \param[in] points one of each laser; copied
   * \param[in] count number of rows, may be 0
   * \return false, after a PCL_ERROR and without effect: outside a rotation; if \a points is null and \a count is not
   * 0; if there are more rows than lasers declared; if the organized cloud would have more points than pcl::index_t can
   * number
   */
  bool addColumn(const PointT* points, std::size_t count);

  /** \brief The same; the points of the cloud are the rows. */
  inline bool addColumn(const PointCloud& column) { return (addColumn(column.points.data(), column.size())); }

  /** \brief End the rotation.
   * \param[in,out] clusters receives the clusters after those it already holds; then all are sorted by size, largest
   * first, as LiscoClusterExtraction::extract () does it. Cleared if the rotation has no cells.
   * \return false, after a PCL_ERROR and with \a clusters cleared, if no rotation has begun
   */
  bool endRotation(std::vector<PointIndices>& clusters);

  /** \brief The same, and the organized cloud.
   * \param[out] cloud the one that the indices refer to; empty if no rotation has begun
   */
  inline bool endRotation(std::vector<PointIndices>& clusters, PointCloud& cloud) {
    const bool ended = endRotation(clusters);
    if (ended)
      getCloud(cloud);
    else
      cloud.clear();
    return (ended);
  }

  LiscoStreamExtraction();
  ~LiscoStreamExtraction();
  /** \brief A copy continues from the same column. */
  LiscoStreamExtraction(const LiscoStreamExtraction& other);
  /** \brief The same. */
  LiscoStreamExtraction& operator=(const LiscoStreamExtraction& other);

  /** \brief Number of columns added, which is the width of the cloud so far. */
  std::size_t getNumberOfColumns() const;

  /** \brief Number of subclusters, of any size. This and the functions below describe the columns so far of this
   * rotation, or the last rotation until the next one begins. They do the work that is left of these columns.
   */
  std::size_t getNumberOfSubclusters();

  /** \brief Number of points of each subcluster.
   * \param[out] sizes one for each subcluster, by its number
   */
  void getSubclusterSizes(std::vector<pcl::uindex_t>& sizes);

  /** \brief The number of the subcluster that a point is in; -1 if there is no return, or no such row or column.
   * Numbers hold until the next column is added.
   */
  pcl::index_t getSubcluster(std::size_t row, std::size_t column);

  /** \brief The subclusters of accepted sizes: the clusters if the rotation ended here. The width of the cloud is the
   * number of columns so far, and changes the points' indices with every column.
   * \param[out] clusters as of endRotation (); replaces former content
   */
  void getSubclusters(std::vector<PointIndices>& clusters);

  /** \brief The organized cloud of the columns so far. Cells that were not given are NaN. */
  inline void getCloud(PointCloud& cloud) const {
    Base::allocate(getNumberOfColumns(), numberOfRows(), cloud);
    copyColumns(cloud.points.data());
    cloud.header = header_;
    cloud.sensor_origin_ = getSensorOrigin();
    cloud.sensor_orientation_ = Eigen::Quaternionf::Identity();
  }

  /** \brief Position of the sensor, metres, in the coordinates of the points (default: the origin). Decides the speed
   * only, and is the sensor_origin_ of the cloud.
   */
  inline void setSensorOrigin(const Eigen::Vector4f& origin) { sensor_origin_ = {origin[0], origin[1], origin[2]}; }
  /** \brief Get the position of the sensor. */
  inline Eigen::Vector4f getSensorOrigin() const {
    return (Eigen::Vector4f(sensor_origin_[0], sensor_origin_[1], sensor_origin_[2], 0.0F));
  }

  /** \brief Set how many columns are clustered together, 1..64 (default 64, which is the least work); other values are
   * clamped. With fewer, fewer columns are left to be read at the end. Takes effect when the next rotation begins; it
   * changes no result.
   */
  inline void setBlockColumns(std::size_t columns) { block_columns_ = columns; }
  /** \brief Get how many columns are clustered together. */
  inline std::size_t getBlockColumns() const { return (block_columns_); }

 private:
  using Base::cluster_tolerance_;
  using Base::header_;
  using Base::lasers_;

  void update();
  std::size_t numberOfRows() const;
  /** \brief Fills the points of getCloud (). */
  void copyColumns(PointT* points) const;

  std::array<float, 3> sensor_origin_{};
  std::size_t block_columns_ = 64;

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/segmentation/impl/lisco_stream_extraction.hpp>
#endif
