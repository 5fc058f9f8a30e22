// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/strided_points.h"

namespace lisco::ground {

/// The returns among points in any order, sorted into columns of the same azimuth and rows of about the same elevation,
/// as a rotating sensor's scan has them. A cell holds one return or none.
class AzimuthColumns {
 public:
  /// Takes the place of the points before, and their memory.
  /// \param count number of points, below 2^31
  /// \param origin position of the sensor, metres
  void sort(const StridedPoints& points, std::size_t count, const std::array<float, 3>& origin);

  /// 16 to 1024.
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return rows_ == 0 ? 0 : cells_.size() / rows_; }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// The number of the point in a cell, or kNone. Rows are numbered from the lowest one up.
  std::uint32_t pointAt(std::size_t row, std::size_t column) const { return cells_[column * rows_ + row]; }

 private:
  void measure(const StridedPoints& points, std::size_t count, const std::array<float, 3>& origin);
  unsigned widen();
  void fill();

  std::vector<std::uint64_t> items_;  // of the returns: bin of azimuth, slope of the ray, number of the point
  std::vector<std::uint64_t> scratch_;
  std::vector<std::uint32_t> sizes_;  // of the bins, in returns
  std::size_t rows_ = 0;
  std::vector<std::uint32_t> lowest_;  // by row: lowest slope of its returns
  std::vector<std::uint32_t> cells_;   // column by column
};

}  // namespace lisco::ground
