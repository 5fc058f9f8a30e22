// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_cloud_clusterer.h>  // fitsIndexType
#include <pcl/segmentation/lisco_cluster_writer.h>
#include <pcl/segmentation/lisco_column_stream.h>

#include "lisco/return.h"

namespace pcl::detail {

/** \brief The latest columns of a stream. Each cell has an id, its source index in the clustering engine: a running
 * number, modulo 2^32. Keeps its memory, which is that of the most cells held at once.
 *
 * Memory comes from std::allocator, as all memory that the library allocates: see LiscoColumnStream::allocate ().
 */
template <typename PointT>
class LiscoColumnStore {
 public:
  /** \brief Where a point was measured. */
  struct Cell {
    std::uint64_t column;  ///< counted from the last clear ()
    std::uint32_t row;
  };

  /** \brief Drops all columns. */
  void clear() {
    first_column_ = end_column_ = 0;
    first_cell_ = end_cell_ = kFirstId;
  }

  /** \brief Appends a column.
   * \return the id of its first cell; those of the others follow
   */
  std::uint32_t add(const PointT* points, std::size_t rows, double position = 0) {
    reserve(rows);
    if (size() == 0)
      rows_of_each_ = rows;
    else if (rows != rows_of_each_ && rows_of_each_ != kUnlike)
      enterColumns();
    const std::uint32_t first = end_cell_;
    columns_[slotOf(end_column_)] = {first, static_cast<std::uint32_t>(rows), position};
    for (std::size_t row = 0; row < rows; ++row) points_[(first + row) & (points_.size() - 1)] = points[row];
    end_cell_ += static_cast<std::uint32_t>(rows);
    ++end_column_;
    if (rows_of_each_ == kUnlike) enterColumn(end_column_ - 1);
    return (first);
  }

  /** \brief Drops the first column. */
  void dropFirst() {
    first_cell_ += columns_[slotOf(first_column_)].rows;
    ++first_column_;
  }

  /** \brief Numbers of the first column held and of the one after the last. */
  std::uint64_t firstColumn() const { return (first_column_); }
  std::uint64_t endColumn() const { return (end_column_); }
  std::size_t size() const { return (static_cast<std::size_t>(end_column_ - first_column_)); }

  std::size_t rowsOf(std::uint64_t column) const { return (columns_[slotOf(column)].rows); }
  double positionOf(std::uint64_t column) const { return (columns_[slotOf(column)].position); }

  /** \param[in] row less than rowsOf (column) */
  const PointT& at(std::size_t row, std::uint64_t column) const {
    return (pointOf(columns_[slotOf(column)].first_cell + static_cast<std::uint32_t>(row)));
  }
  const PointT& pointOf(std::uint32_t id) const { return (points_[id & (points_.size() - 1)]); }
  Cell cellOf(std::uint32_t id) const {
    if (rows_of_each_ != kUnlike) {
      const auto rows = static_cast<std::uint32_t>(rows_of_each_);
      const std::uint32_t cell = id - first_cell_;
      return {first_column_ + cell / rows, cell % rows};
    }
    const std::uint32_t low_bits = column_of_cell_[id & (points_.size() - 1)];
    const std::uint64_t column = first_column_ + (low_bits - static_cast<std::uint32_t>(first_column_));
    return {column, id - columns_[slotOf(column)].first_cell};
  }

  /** \brief The most rows of some columns. */
  std::size_t heightOf(std::uint64_t first_column, std::uint64_t end_column) const {
    std::size_t height = 0;
    for (std::uint64_t column = first_column; column < end_column; ++column) height = std::max(height, rowsOf(column));
    return (height);
  }

  /** \brief Copies some columns as the points of an organized cloud. Cells that were not given are NaN.
   * \param[out] points array of (end_column - first_column) * heightOf (first_column, end_column) points
   */
  void copyColumns(std::uint64_t first_column, std::uint64_t end_column, PointT* points) const {
    PointT missing{};
    missing.x = missing.y = missing.z = std::numeric_limits<float>::quiet_NaN();
    const auto width = static_cast<std::size_t>(end_column - first_column);
    std::fill_n(points, width * heightOf(first_column, end_column), missing);
    for (std::size_t column = 0; column < width; ++column)
      for (std::size_t row = 0; row < rowsOf(first_column + column); ++row)
        points[row * width + column] = at(row, first_column + column);
  }

 private:
  struct Column {
    std::uint32_t first_cell;  ///< its id
    std::uint32_t rows;
    double position;
  };

  std::size_t slotOf(std::uint64_t column) const { return (static_cast<std::size_t>(column) & (columns_.size() - 1)); }

  /** \brief Grows the vectors, rings whose sizes are powers of two, to take one more column. */
  void reserve(std::size_t rows) {
    if (size() == columns_.size()) {
      std::vector<Column> larger(std::max(2 * columns_.size(), std::size_t{64}));
      for (std::uint64_t column = first_column_; column < end_column_; ++column)
        larger[static_cast<std::size_t>(column) & (larger.size() - 1)] = columns_[slotOf(column)];
      columns_.swap(larger);
    }
    const std::size_t cells = std::uint32_t{end_cell_ - first_cell_};
    if (cells + rows <= points_.size()) return;
    std::size_t capacity = std::max(2 * points_.size(), std::size_t{4096});
    while (capacity < cells + rows) capacity *= 2;
    std::vector<PointT> points(capacity);
    for (std::size_t cell = 0; cell < cells; ++cell)
      points[(first_cell_ + cell) & (capacity - 1)] = points_[(first_cell_ + cell) & (points_.size() - 1)];
    points_.swap(points);
    if (rows_of_each_ == kUnlike) enterColumns();
  }

  /** \brief Enters the columns of all cells, whose ids do not tell them. */
  void enterColumns() {
    column_of_cell_.resize(points_.size());
    rows_of_each_ = kUnlike;
    for (std::uint64_t column = first_column_; column < end_column_; ++column) enterColumn(column);
  }
  void enterColumn(std::uint64_t column) {
    const Column& entered = columns_[slotOf(column)];
    for (std::uint32_t row = 0; row < entered.rows; ++row)
      column_of_cell_[(entered.first_cell + row) & (points_.size() - 1)] = static_cast<std::uint32_t>(column);
  }

  /// Any value is right; of this one, ids wrap around in nearly every stream, so that nearly every test covers it.
  static constexpr std::uint32_t kFirstId = ~std::uint32_t{0} - 100;
  static constexpr std::size_t kUnlike = ~std::size_t{0};

  std::uint64_t first_column_ = 0, end_column_ = 0;
  std::uint32_t first_cell_ = kFirstId, end_cell_ = kFirstId;  ///< ids
  std::vector<Column> columns_;
  std::vector<PointT> points_;
  std::size_t rows_of_each_ = 0;               ///< of the columns held; kUnlike if they differ
  std::vector<std::uint32_t> column_of_cell_;  ///< its lowest 32 bits; only if they differ
};

/** \brief The columns received by LiscoStreamExtraction, LiscoWindowExtraction and LiscoEndlessExtraction: base of
 * their states.
 */
template <typename PointT>
class LiscoReceivedColumns {
 public:
  /** \brief Drops all columns. */
  void clear() {
    store.clear();
    max_rows_ = 0;
  }

  /** \brief Whether a column can be taken; if not, after a PCL_ERROR.
   * \param[in] columns number of columns kept, with this one
   * \param[in] lasers most rows of a column; 0: any number
   * \param[in] caller named in front of the PCL_ERROR
   */
  bool accepts(const PointT* points, std::size_t count, std::size_t columns, std::size_t lasers,
               const char* caller) const {
    const std::size_t rows = std::max(count, max_rows_);
    if (!begun)
      PCL_ERROR("[%s] A column before beginRotation () or beginStream (), or after an exception.\n", caller);
    else if (!points && count > 0)
      PCL_ERROR("[%s] A column without points.\n", caller);
    else if (lasers != 0 && count > lasers)
      PCL_ERROR("[%s] A column of %zu rows, and only %zu lasers were declared.\n", caller, count, lasers);
    else if (!LiscoCloudClusterer::fitsIndexType(rows) || !LiscoCloudClusterer::fitsIndexType(columns) ||
             !LiscoCloudClusterer::fitsIndexType(columns * rows))
      PCL_ERROR("[%s] %zu columns of %zu rows are more points than pcl::index_t can number.\n", caller, columns, rows);
    else
      return (true);
    return (false);
  }

  /** \brief Stores a column that accepts () has passed. Until the caller has clustered it and sets it again, begun is
   * false.
   * \return the column as the engine takes it, with the cells' ids for source indices; valid until the next call
   */
  const lisco::Return* add(const PointT* points, std::size_t count, double position = 0) {
    begun = false;
    max_rows_ = std::max(max_rows_, count);
    column_with_ids_.resize(count);  // may throw: before the column is stored
    std::uint32_t id = store.add(points, count, position);
    for (std::size_t row = 0; row < count; ++row)
      column_with_ids_[row] = {points[row].x, points[row].y, points[row].z, id++};
    return (column_with_ids_.data());
  }

  /** \brief Appends the clusters of some columns as LiscoClusterExtraction does it for their organized cloud;
   * clears them if that is empty.
   * \param[in] clusterer holds the subclusters of just these columns
   * \param[in] settings the sizes that clusters may have, and their header
   */
  template <typename Clusterer>
  void appendClusters(Clusterer& clusterer, std::uint64_t first_column, std::uint64_t end_column,
                      const LiscoColumnStream<PointT>& settings, std::vector<PointIndices>& clusters) {
    if (store.heightOf(first_column, end_column) == 0) {  // an empty cloud
      clusters.clear();
      return;
    }
    const auto width = static_cast<std::size_t>(end_column - first_column);
    LiscoClusterWriter writer(clusterer, settings.getHeader(), settings.getMinClusterSize(),
                              settings.getMaxClusterSize(), places_, clusters);
    clusterer.forEachRun(LiscoRunAppender{writer, LiscoRowMajorIndex{width}}, writer.acceptedSizes());
    sortLiscoClusters(clusters);
  }

  std::size_t maxRows() const { return (max_rows_); }  ///< of any column since the beginning

  bool begun = false;  ///< and left by no exception since
  LiscoColumnStore<PointT> store;

 private:
  std::size_t max_rows_ = 0;
  LiscoClusterPlaces places_;
  std::vector<lisco::Return> column_with_ids_;
};

}  // namespace pcl::detail
