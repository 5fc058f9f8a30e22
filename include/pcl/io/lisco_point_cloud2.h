// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/PointIndices.h>
#include <pcl/for_each_type.h>
#include <pcl/pcl_base.h>  // UNAVAILABLE
#include <pcl/pcl_macros.h>
#include <pcl/point_cloud.h>
#include <pcl/point_struct_traits.h>
#include <pcl/types.h>

#include "lisco/export.h"

namespace pcl {

/** \brief Arranges a driver's point cloud message, as pcl_conversions::toPCL () gives it for a
 * sensor_msgs/PointCloud2, as the organized cloud that LiscoClusterExtraction likes best: a row for each laser, a
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
 * (every point that is finite and not exactly (0, 0, 0)) is in exactly one cell. Fields may come in any order, with any
 * padding. Which rows and columns:
 * - a message of several rows is taken as it is, except that rows and columns are exchanged if its `ring` field says
 *   that its rows are firings; every point keeps a cell, no-returns as well;
 * - a message of one row with a `ring` field gets a row for each ring that occurs, in ascending order. The points
 *   within most of a firing's duration make a column, by the first of the fields `time`, `t`, `timestamp` and
 *   `time_stamp` that has finite and different values, in whatever unit and relative to whatever; without one, by
 *   their azimuth around (0, 0, 0). Points of one ring in one firing (dual returns) go into columns side by side.
 *   No-returns are left out;
 * - any other one is taken as it is, as one row. So is one whose rings and times would leave most cells empty (more
 *   than 16 cells per point, and more than 65536).
 *
 * Fields of PointT are taken from the fields of the same names. Numbers of another type are converted: a value beyond
 * the limits of the type becomes the limit (beyond those of a float: infinite), NaN becomes 0 in an integer. Fields that
 * the message does not have are those of PointT (), without a warning.
 *
 * \param[in] message of this machine's byte order, with fields x, y and z of type FLOAT32 or FLOAT64. A FLOAT64 is
 * rounded to float, as PointT has it, before anything else is done with it.
 * \param[out] cloud receives the header, the points, and in cells without a point NaN. Its sensor pose is not touched,
 * since messages have none.
 * \param[out] point_of_cell for each point of \a cloud its number in the message, UNAVAILABLE if the cell is empty;
 * numbers count row by row
 * \return false, after a PCL_ERROR and with both cleared, if a field x, y or z is missing, if a field that is to be read
 * is of an unknown type, of several elements where one is needed, or reaches beyond point_step, if the rows overlap or
 * reach beyond the data, if there are data but no points, if the byte order is not this machine's, or if there are
 * more points than pcl::index_t can number. A message without points or data gives an empty cloud and true.
 * \ingroup io
 */
template <typename PointT>
bool organizeLiscoCloud(const PCLPointCloud2& message, PointCloud<PointT>& cloud, Indices& point_of_cell);

/** \brief Makes clusters of an arranged cloud those of its message: byte for byte what extract () gives for the
 * message's points in their own order.
 * \param[in] point_of_cell as organizeLiscoCloud () gave it
 * \param[in,out] clusters as extract () gave them for that cloud, appended to nothing. Their indices are replaced by those
 * of the message and ascend; clusters are then brought into the order of their first points, and sorted by size as
 * extract () does it.
 * \return false, after a PCL_ERROR and with \a clusters cleared, if an index is not that of a cell with a point, or comes
 * twice
 * \ingroup io
 */
LISCO_EXPORT bool mapLiscoClusters(const Indices& point_of_cell, std::vector<PointIndices>& clusters);

namespace detail {

/** \brief A field of a point in memory. */
struct LiscoField {
  std::string name;
  std::size_t offset;     ///< bytes, from the beginning of the point
  std::uint8_t datatype;  ///< one of PCLPointField::PointFieldTypes
  std::size_t count;      ///< of elements, at least 1
};

/** \brief Reads a message, which is checked first: any bytes are fine. */
class LISCO_EXPORT LiscoMessageReader {
 public:
  /** \brief Checks the message and arranges its points in cells.
   * \param[in] message must stay as it is while the reader is used
   * \param[in] fields of the points that are to be made
   * \return false, after a PCL_ERROR, if it cannot be read
   */
  bool open(const PCLPointCloud2& message, const std::vector<LiscoField>& fields, const char* caller);

  /** \brief The points of the cells, row by row; UNAVAILABLE in empty ones. */
  Indices& cells() { return (cells_); }
  std::size_t width() const { return (width_); }
  std::size_t height() const { return (height_); }

  /** \brief Copies a point's fields; others stay as they are.
   * \param[in] index of the point in the message
   * \param[out] point memory of a point with the fields given to open ()
   */
  void copyPoint(index_t index, std::uint8_t* point) const;

 private:
  /** \brief From a field of the message to one of the point. */
  struct Copy {
    LiscoField from, to;
    bool is_same_type;
  };

  bool checkLayout(const char* caller);
  bool findField(const std::string& name, const char* caller, LiscoField& field, bool& is_there) const;
  bool arrange(const char* caller);
  bool arrangeByRings(const LiscoField& ring, std::vector<double>& keys);
  bool rowsAreFirings(const LiscoField& ring) const;
  const std::uint8_t* pointAt(std::size_t index) const;

  const PCLPointCloud2* message_ = nullptr;
  std::size_t points_ = 0;
  LiscoField x_, y_, z_;
  std::vector<Copy> copies_;
  Indices cells_;
  std::size_t width_ = 0, height_ = 0;
};

/** \brief Lists the fields of a point type, for for_each_type (). */
template <typename PointT>
struct LiscoFieldLister {
  std::vector<LiscoField>& fields;

  template <typename Tag>
  void operator()() {
    fields.push_back({::pcl::traits::name<PointT, Tag>::value, ::pcl::traits::offset<PointT, Tag>::value,
                      ::pcl::traits::datatype<PointT, Tag>::value, ::pcl::traits::datatype<PointT, Tag>::size});
  }
};

}  // namespace detail

// Not in the library: Eigen's allocator works differently where the code is compiled for AVX, so that what one side has
// allocated by it (every PointCloud), the other side must not free.
template <typename PointT>
bool organizeLiscoCloud(const PCLPointCloud2& message, PointCloud<PointT>& cloud, Indices& point_of_cell) {
  std::vector<detail::LiscoField> fields;
  for_each_type<typename traits::fieldList<PointT>::type>(detail::LiscoFieldLister<PointT>{fields});

  detail::LiscoMessageReader reader;
  cloud.clear();
  point_of_cell.clear();
  if (!reader.open(message, fields, "pcl::organizeLiscoCloud")) return (false);
  point_of_cell.swap(reader.cells());

  PointT missing{};
  missing.x = missing.y = missing.z = std::numeric_limits<float>::quiet_NaN();
  cloud.header = message.header;
  cloud.points.assign(point_of_cell.size(), missing);
  cloud.width = static_cast<std::uint32_t>(reader.width());
  cloud.height = static_cast<std::uint32_t>(reader.height());
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
