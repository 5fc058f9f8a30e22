// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <pcl/segmentation/lisco_pcl_version.h>

namespace pcl {

namespace detail {

/** \brief The latest columns of a stream. Their cells have names, which the clustering engine is given in place of the
 * points: a running number, modulo 2^32. Keeps its memory, which is that of the most cells that were there at once.
 *
 * Its memory comes from std::allocator, as all memory that the library allocates: see LiscoColumnStream::allocate ().
 */
template <typename PointT>
class LiscoColumnStore {
 public:
  /** \brief Where a point was measured. */
  struct Cell {
    std::uint64_t column;  ///< counted from the last clear ()
    std::uint32_t row;
  };

  /** \brief Forgets all columns. */
  void clear() {
    first_column_ = end_column_ = 0;
    first_cell_ = end_cell_ = kFirstName;
  }

  /** \brief Appends a column.
   * \return the name of its first cell; those of the others follow
   */
  std::uint32_t add(const PointT* points, std::size_t rows, double position = 0) {
    reserve(rows);
    columns_[slotOf(end_column_)] = {end_cell_, static_cast<std::uint32_t>(rows), position};
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t slot = (end_cell_ + row) & (points_.size() - 1);
      points_[slot] = points[row];
      column_of_cell_[slot] = static_cast<std::uint32_t>(end_column_);
    }
    const std::uint32_t first = end_cell_;
    end_cell_ += static_cast<std::uint32_t>(rows);
    ++end_column_;
    return (first);
  }

  /** \brief Forgets the first column. */
  void dropFirst() {
    first_cell_ += columns_[slotOf(first_column_)].rows;
    ++first_column_;
  }

  /** \brief Number of the first column that is there, and of the one after the last. */
  std::uint64_t firstColumn() const { return (first_column_); }
  std::uint64_t endColumn() const { return (end_column_); }
  std::size_t size() const { return (static_cast<std::size_t>(end_column_ - first_column_)); }

  std::size_t rowsOf(std::uint64_t column) const { return (columns_[slotOf(column)].rows); }
  double positionOf(std::uint64_t column) const { return (columns_[slotOf(column)].position); }

  /** \param[in] row less than rowsOf (column) */
  const PointT& at(std::size_t row, std::uint64_t column) const {
    return (pointOf(columns_[slotOf(column)].first_cell + static_cast<std::uint32_t>(row)));
  }
  const PointT& pointOf(std::uint32_t name) const { return (points_[name & (points_.size() - 1)]); }
  Cell cellOf(std::uint32_t name) const {
    const std::uint32_t low_bits = column_of_cell_[name & (points_.size() - 1)];
    const std::uint64_t column = first_column_ + (low_bits - static_cast<std::uint32_t>(first_column_));
    return {column, name - columns_[slotOf(column)].first_cell};
  }

  /** \brief The most rows of some columns. */
  std::size_t heightOf(std::uint64_t first_column, std::uint64_t end_column) const {
    std::size_t height = 0;
    for (std::uint64_t column = first_column; column < end_column; ++column) height = std::max(height, rowsOf(column));
    return (height);
  }

  /** \brief Copies some columns as the points of an organized cloud. Cells that were not given are NaN.
   * \param[out] points room for (end_column - first_column) * heightOf (first_column, end_column) points
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
    std::uint32_t first_cell;  ///< its name
    std::uint32_t rows;
    double position;
  };

  std::size_t slotOf(std::uint64_t column) const { return (static_cast<std::size_t>(column) & (columns_.size() - 1)); }

  /** \brief Makes room for one more column. The vectors are rings whose sizes are powers of two. */
  void reserve(std::size_t rows) {
    if (size() == columns_.size()) {
      std::vector<Column> larger(std::max(2 * columns_.size(), std::size_t{64}));
      for (std::uint64_t column = first_column_; column < end_column_; ++column)
        larger[static_cast<std::size_t>(column) & (larger.size() - 1)] = columns_[slotOf(column)];
      columns_.swap(larger);
    }
    const std::size_t cells = std::uint32_t{end_cell_ - first_cell_};
    if (cells + rows <= points_.size()) return;
    std::size_t room = std::max(2 * points_.size(), std::size_t{4096});
    while (room < cells + rows) room *= 2;
    std::vector<PointT> points(room);
    std::vector<std::uint32_t> column_of_cell(room);
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const std::size_t from = (first_cell_ + cell) & (points_.size() - 1);
      const std::size_t to = (first_cell_ + cell) & (room - 1);
      points[to] = points_[from];
      column_of_cell[to] = column_of_cell_[from];
    }
    points_.swap(points);
    column_of_cell_.swap(column_of_cell);
  }

  /// Any will do. This one lets nearly every stream pass 2^32, which only a long one would otherwise.
  static constexpr std::uint32_t kFirstName = ~std::uint32_t{0} - 100;

  std::uint64_t first_column_ = 0, end_column_ = 0;
  std::uint32_t first_cell_ = kFirstName, end_cell_ = kFirstName;  ///< names
  std::vector<Column> columns_;
  std::vector<PointT> points_;
  std::vector<std::uint32_t> column_of_cell_;  ///< its lowest 32 bits
};

}  // namespace detail

}  // namespace pcl
