// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/growing_array.h"

namespace lisco {

/// The bins of a range image. A row has four planes, one after the other: x, y, z and the element of each bin. A bin
/// has one index in all of them. Rows that are opened one after the other touch memory from its beginning on.
class ImageCells {
 public:
  ImageCells() = default;
  ImageCells(const ImageCells& other) : floats_(other.floats_) { setRowSize(other.row_size_); }
  ImageCells& operator=(const ImageCells& other) {
    floats_ = other.floats_;
    setRowSize(other.row_size_);
    return *this;
  }

  /// Sets the bins of a row, which makes room for other rows than before.
  void setRowSize(std::size_t bins) {
    row_size_ = bins;
    float* const first = floats_.data();
    if (first == nullptr) return;
    x = first;
    y = first + bins;
    z = first + 2 * bins;
    element = reinterpret_cast<std::uint32_t*>(first + 3 * bins);
  }

  /// Index of the first bin of a row.
  std::size_t firstOf(std::size_t row) const { return row * kPlanes * row_size_; }

  /// Makes room for some rows, and for an eighth more than before if they come one by one. Their bins have no values
  /// yet.
  void reserveRows(std::size_t rows) {
    if (firstOf(rows) <= floats_.size()) return;
    floats_.grow(std::max(firstOf(rows), floats_.size() + floats_.size() / 8));
    setRowSize(row_size_);
  }

  /// Exchanges the memory of the bins, all free, with an array of other elements, whose values are lost. setRowSize ()
  /// comes next.
  template <typename Other>
  void exchangeMemory(GrowingArray<Other>& other) noexcept {
    floats_.exchangeMemory(other);
    x = y = z = nullptr;
    element = nullptr;
  }
  std::size_t bytes() const { return floats_.size() * sizeof(float); }

  /// Moves some rows apart, so that each has as many bins as setRowSize () says.
  /// \param former number of bins of a row
  /// \param used of these, from the first on; the others become free
  void widenRows(std::size_t rows, std::size_t former, std::size_t used) {
    reserveRows(rows);
    for (std::size_t plane = kPlanes * rows; plane-- > 0;) {
      float* const to = x + plane * row_size_;
      std::memmove(to, x + plane * former, used * sizeof(float));
      if (plane % kPlanes == 0) std::fill(to + used, to + row_size_, std::numeric_limits<float>::quiet_NaN());
    }
  }

  float *x = nullptr, *y = nullptr, *z = nullptr;
  std::uint32_t* element = nullptr;

 private:
  static constexpr std::size_t kPlanes = 4;
  static_assert(sizeof(float) == sizeof(std::uint32_t), "the planes are of one size");

  GrowingArray<float> floats_;
  std::size_t row_size_ = 0;
};

}  // namespace lisco
