// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/PCLPointField.h>
#include <pcl/PointIndices.h>
#include <pcl/common/io.h>  // getFields
#include <pcl/pcl_base.h>   // UNAVAILABLE
#include <pcl/point_cloud.h>
#include <pcl/segmentation/lisco_pcl_version.h>
#include <pcl/types.h>

namespace pcl {

/** \brief Arranges a driver's point cloud message, as pcl_conversions::toPCL () gives it for a
 * sensor_msgs/PointCloud2, as the organized cloud for which LiscoClusterExtraction is fastest: a row for each laser, a
 * column for each firing.
 *
 * \code
 * pcl::PointCloud<pcl::PointXYZI>::Ptr cloud (new pcl::PointCloud<pcl::PointXYZI>);
 * pcl::Indices point_of_cell;
 * if (pcl::organizeLiscoCloud (message, *cloud, point_of_cell))
 * {
 *   ec.setInputCloud (cloud);
 *   ec.extract (clusters);
 *   pcl::mapLiscoClusters (point_of_cell, clusters);   // now they index the points of the message
 * }
 * \endcode
 *
 * The arrangement decides how long extract () takes, never which points belong together. Every return of the message
 * (a point that is finite and not exactly (0, 0, 0)) is in exactly one cell. Fields may have any order and padding.
 * Rows and columns:
 * - a message of several rows is taken as it is, except that rows and columns are exchanged if its `ring` field says
 *   that its rows are firings; every point keeps a cell, no-returns as well;
 * - a message of one row with a field `ring` or `channel` gets a row for each that occurs, in ascending order. The
 *   points within three quarters of the time between firings make a column, by the first of the fields `time`, `t`,
 *   `timestamp` and `time_stamp` that has finite and different values, of any unit and origin; without one, by their
 *   azimuth around (0, 0, 0). Points of one ring in one firing (dual returns) go into columns side by side. No-returns
 *   are left out;
 * - any other message becomes one row. So does one with rings that are not within 0..65535, and one whose rings and
 *   times would leave most cells empty (more than 16 cells per point, and more than 65536).
 *
 * Fields of PointT are taken from the fields of the same names. Numbers of another type are converted: a value beyond
 * the limits of the type becomes the limit (beyond those of a float: infinite), NaN becomes 0 in an integer. Fields
 * that are missing in the message, or have another number of elements there, are those of PointT (), without a warning.
 *
 * \param[in] message of this machine's byte order, with fields x, y and z of type FLOAT32 or FLOAT64. A FLOAT64 is
 * rounded to float, as PointT has it, first of all.
 * \param[out] cloud receives the header, the points, and in cells without a point NaN. Its sensor pose stays as it is.
 * \param[out] point_of_cell for each point of \a cloud its number in the message, UNAVAILABLE if the cell is empty;
 * numbers count row by row
 * \return false, after a PCL_ERROR and with both cleared, if x, y or z is missing; if one of them, or the ring or time
 * that points are arranged by, has several elements; if a field to be read is of an unknown type or reaches beyond
 * point_step; if the rows overlap or reach beyond the data; if there are data but no points; if the byte order is not
 * this machine's; or if there are more points than pcl::index_t can number. A message without points or data gives an
 * empty cloud and true.
 * \ingroup io
 */
template <typename PointT>
bool organizeLiscoCloud(const PCLPointCloud2& message, PointCloud<PointT>& cloud, Indices& point_of_cell);

/** \brief Converts clusters of an arranged cloud to those of its message: byte for byte what extract () gives for the
 * message's points in their own order.
 * \param[in] point_of_cell as organizeLiscoCloud () gave it
 * \param[in,out] clusters those of extract () for that cloud, called with an empty vector. Their indices are
 * replaced by those of the message and ascend; clusters are ordered by their first points, then sorted by size as
 * extract () does it.
 * \return false, after a PCL_ERROR and with \a clusters cleared, if an index is not that of a cell with a point, or
 * occurs twice
 * \ingroup io
 */
LISCO_EXPORT bool mapLiscoClusters(const Indices& point_of_cell, std::vector<PointIndices>& clusters);

namespace detail {

/** \brief Reads a message of any content, after checking it. */
class LISCO_EXPORT LiscoMessageReader {
 public:
  LiscoMessageReader();
  ~LiscoMessageReader();
  LiscoMessageReader(const LiscoMessageReader&) = delete;
  LiscoMessageReader& operator=(const LiscoMessageReader&) = delete;

  /** \brief Checks the message and arranges its points in cells.
   * \param[in] message must stay as it is while the reader is used
   * \param[in] fields of the points that are to be made
   * \param[out] cells the points of the cells, row by row; UNAVAILABLE in empty ones
   * \return false, after a PCL_ERROR, if it cannot be read
   */
  bool open(const PCLPointCloud2& message, const std::vector<PCLPointField>& fields, const char* caller,
            Indices& cells);
  /** \brief Columns and rows of the cells. */
  std::uint32_t width() const;
  std::uint32_t height() const;

  /** \brief Copies a point's fields; others stay as they are.
   * \param[in] index of the point in the message
   * \param[out] point memory of a point with the fields given to open ()
   */
  void copyPoint(index_t index, std::uint8_t* point) const;

 private:
  class LISCO_HIDDEN State;
  std::unique_ptr<State> state_;
};

}  // namespace detail

// In the header, since Eigen's allocator, which every PointCloud uses, works differently in code compiled for AVX: the
// library must not free what its user has allocated, nor the reverse.
template <typename PointT>
bool organizeLiscoCloud(const PCLPointCloud2& message, PointCloud<PointT>& cloud, Indices& point_of_cell) {
  detail::LiscoMessageReader reader;
  cloud.clear();
  point_of_cell.clear();
  if (!reader.open(message, getFields<PointT>(), "pcl::organizeLiscoCloud", point_of_cell)) return (false);

  PointT missing{};
  missing.x = missing.y = missing.z = std::numeric_limits<float>::quiet_NaN();
  cloud.header = message.header;
  cloud.points.assign(point_of_cell.size(), missing);
  cloud.width = reader.width();
  cloud.height = reader.height();
  cloud.is_dense = message.is_dense != 0;
  for (std::size_t cell = 0; cell < point_of_cell.size(); ++cell) {
    if (point_of_cell[cell] == UNAVAILABLE) {
      cloud.is_dense = false;
      continue;
    }
    reader.copyPoint(point_of_cell[cell], reinterpret_cast<std::uint8_t*>(&cloud.points[cell]));
  }
  return (true);
}

}  // namespace pcl
