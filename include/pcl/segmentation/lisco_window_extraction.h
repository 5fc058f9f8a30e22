// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <memory>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>
#include <pcl/segmentation/lisco_column_stream.h>

namespace pcl {

/** \brief Euclidean clusters of the last W columns, every H columns, without clustering from scratch.
 *
 * \code
 * pcl::LiscoWindowExtraction<pcl::PointXYZI> windows;
 * windows.setClusterTolerance (0.4);
 * windows.setWindowSize (1800);
 * windows.setHop (100);
 * windows.beginStream ();
 * while (...)
 *   if (windows.addColumn (points, 64)) {                  // a window ends with this column
 *     std::vector<pcl::PointIndices> clusters;
 *     windows.extract (clusters);
 *     ...
 *   }
 * \endcode
 *
 * extract () gives, byte for byte, the vector that LiscoClusterExtraction::extract () gives for the organized cloud of
 * the window's columns: row * width + column is the index of a point, the width the number of columns, the height the
 * most rows of any of them. Columns are as for LiscoStreamExtraction. \ingroup segmentation
 */
template <typename PointT>
class LiscoWindowExtraction : public detail::LiscoColumnStream<PointT> {
  using Base = detail::LiscoColumnStream<PointT>;

 public:
  using PointCloud = typename Base::PointCloud;  ///< of its points

  /** \brief Begin a stream. Discards the last one.
   * \return false, after a PCL_ERROR and without effect, if the window is not a positive multiple of the hop,
   * or has more columns than pcl::index_t can number
   */
  bool beginStream();

  /** \brief Add the next column.
   * \param[in] points one of each laser; copied
   * \param[in] count number of rows, may be 0
   * \return whether a window ends with this column. The first windows are shorter: all columns so far. Also false,
   * after a PCL_ERROR and without effect: before beginStream (), or after an exception; if \a points is null and count
   * is not 0; if there are more rows than lasers declared; if a window and a hop of as many rows would have more points
   * than pcl::index_t can number
   */
  bool addColumn(const PointT* points, std::size_t count);

  /** \brief The same; the points of the cloud are the rows. */
  inline bool addColumn(const PointCloud& column) { return (addColumn(column.points.data(), column.size())); }

  /** \brief Extract the clusters of the last window that ended, until the next one ends.
   * \param[in,out] clusters receives the clusters after those it already holds; then all are sorted by size, largest
   * first, as LiscoClusterExtraction::extract () does it. Cleared if the window has no cells.
   * \return false, after a PCL_ERROR and with \a clusters cleared, if no window has ended
   */
  bool extract(std::vector<PointIndices>& clusters);

  /** \brief The organized cloud that the indices refer to, of the last window that ended, until the next one ends.
   * Empty if no window has ended.
   */
  inline void getWindow(PointCloud& cloud) const {
    Base::allocate(getNumberOfColumns(), numberOfRows(), cloud);
    copyColumns(cloud.points.data());
    cloud.header = header_;
    cloud.sensor_origin_ = Eigen::Vector4f::Zero();
    cloud.sensor_orientation_ = Eigen::Quaternionf::Identity();
  }

  LiscoWindowExtraction();
  ~LiscoWindowExtraction();
  /** \brief A copy continues from the same column. */
  LiscoWindowExtraction(const LiscoWindowExtraction& other);
  /** \brief The same. */
  LiscoWindowExtraction& operator=(const LiscoWindowExtraction& other);

  /** \brief Number of columns of the last window that ended, 0 before the first. */
  std::size_t getNumberOfColumns() const;

  /** \brief Set W, the number of columns of a window: a positive multiple of the hop (default 0: it must be set). Takes
   * effect when the next stream begins.
   */
  inline void setWindowSize(std::size_t columns) { window_size_ = columns; }
  /** \brief Get the number of columns of a window. */
  inline std::size_t getWindowSize() const { return (window_size_); }

  /** \brief Set H, after how many columns the next window ends, 1 or more (default 1). Takes effect when the next
   * stream begins.
   */
  inline void setHop(std::size_t columns) { hop_ = columns; }
  /** \brief Get after how many columns the next window ends. */
  inline std::size_t getHop() const { return (hop_); }

 private:
  using Base::cluster_tolerance_;
  using Base::header_;
  using Base::lasers_;

  std::size_t numberOfRows() const;
  /** \brief Fills the points of getWindow (). */
  void copyColumns(PointT* points) const;

  std::size_t window_size_ = 0;
  std::size_t hop_ = 1;

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/segmentation/impl/lisco_window_extraction.hpp>
#endif
