// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "core/growing_array.h"

namespace lisco {

/// The bins of a row of a range image, from one of them on. A row has four planes, one after the other: x, y, z and the
/// element of each bin.
template <typename Float, typename Element>
struct BinPlanes {
  Float* first;
  std::size_t bins;  ///< of a plane

  /// Metres; NaN where a bin is free.
  Float* x() const { return first; }
  Float* y() const { return first + bins; }
  Float* z() const { return first + 2 * bins; }
  Element* element() const { return reinterpret_cast<Element*>(first + 3 * bins); }

  BinPlanes from(std::ptrdiff_t bin) const { return {first + bin, bins}; }
};
using RowBins = BinPlanes<const float, const std::uint32_t>;
using WritableRowBins = BinPlanes<float, std::uint32_t>;

/// Inserts a row behind each `layers` rows: the next layer of each laser.
/// \param next_of callable as Row (const Row& first), of the first row of a laser
template <typename Row, typename NextOf>
void insertLayer(std::vector<Row>& rows, std::size_t layers, NextOf&& next_of) {
  const std::size_t lasers = rows.size() / layers;
  rows.resize(lasers * (layers + 1));
  for (std::size_t laser = lasers; laser-- > 0;) {
    Row* const to = rows.data() + laser * (layers + 1);
    for (std::size_t layer = layers; layer-- > 0;) to[layer] = rows[laser * layers + layer];
    to[layers] = next_of(*to);
  }
}

/// The rows of a range image. Their memory is taken for many at once: a *chunk*. Rows with memory stay where they are
/// when others get some. Rows that are opened one after the other touch a chunk from its beginning on.
class ImageCells {
 public:
  ImageCells() = default;
  ImageCells(const ImageCells& other)
      : first_chunk_(other.first_chunk_),
        more_chunks_(other.more_chunks_),
        rows_(other.rows_),
        rows_with_memory_(other.rows_with_memory_),
        current_(other.current_),
        row_size_(other.row_size_) {
    for (std::size_t i = 0; i < chunkCount(); ++i) moveRows(other.chunk(i), chunk(i));
  }
  ImageCells(ImageCells&&) noexcept = default;
  ImageCells& operator=(const ImageCells& other) { return *this = ImageCells(other); }
  ImageCells& operator=(ImageCells&&) noexcept = default;

  /// Starts without rows. Keeps its memory.
  /// \param bins of a row
  void clear(std::size_t bins) {
    row_size_ = bins;
    rows_with_memory_ = current_ = 0;
    for (std::size_t i = 0; i < chunkCount(); ++i) chunk(i).rows = 0;
    rows_.clear();
  }

  /// Adds rows without memory behind the last one.
  void addRows(std::size_t count) { rows_.resize(rows_.size() + count, nullptr); }
  /// Adds a row without memory behind each `layers` rows.
  void addLayer(std::size_t layers) {
    insertLayer(rows_, layers, [](const float*) { return nullptr; });
  }
  /// Exchanges two rows, with their memory.
  void swapRows(std::size_t a, std::size_t b) { std::swap(rows_[a], rows_[b]); }
  std::size_t rowCount() const { return rows_.size(); }
  std::size_t rowSize() const { return row_size_; }

  bool hasMemory(std::size_t row) const { return rows_[row] != nullptr; }
  std::size_t rowsWithMemory() const { return rows_with_memory_; }
  /// Gives a row memory, whose bins have no values yet; populate () before they are written.
  /// \param expected number of rows that will get some, this one included; where they come one by one, a chunk has an
  ///        eighth of the rows before at least
  void giveMemory(std::size_t row, std::size_t expected) {
    while (sizeOf(chunk(current_).rows + 1) > chunk(current_).floats.size()) {
      if (Chunk& empty = chunk(current_); empty.rows == 0) {  // its memory may move
        empty.floats.grow(sizeOf(std::max({expected, rows_with_memory_ / 8, std::size_t{1}})), NewPages::kUntouched);
        empty.populated = 0;
      } else if (++current_ == chunkCount()) {
        more_chunks_.emplace_back();
      }
    }
    Chunk& taken = chunk(current_);
    rows_[row] = taken.floats.data() + sizeOf(taken.rows++);
    ++rows_with_memory_;
  }

  /// Has the system provide the pages of a row with memory, and some behind it. Rows are expected in the order in which
  /// they got it; one after a later one is left to its first writes.
  void populate(std::size_t row) {
    constexpr std::size_t kAtATime = std::size_t{1} << 15;  // floats: a system call takes as long as a few pages
    for (std::size_t i = 0; i < chunkCount(); ++i) {
      Chunk& taken = chunk(i);
      if (!taken.has(rows_[row])) continue;
      float* const floats = taken.floats.data();
      const auto begin = static_cast<std::size_t>(rows_[row] - floats);
      if (begin + sizeOf(1) <= taken.populated) return;
      const std::size_t end = std::min(begin + std::max(sizeOf(1), kAtATime), taken.floats.size());
      populatePages(floats + std::max(begin, taken.populated), floats + end);
      taken.populated = end;
      return;
    }
  }

  /// The bins of a row with memory, from one on.
  RowBins at(std::size_t row, std::size_t bin) const { return {rows_[row] + bin, row_size_}; }
  WritableRowBins at(std::size_t row, std::size_t bin) { return {rows_[row] + bin, row_size_}; }

  /// Gives each row more bins, all of them in one chunk.
  /// \param bins of a row, more than before
  /// \param used of those before, from the first on; the others become free
  void widenRows(std::size_t bins, std::size_t used) {
    Chunk wide;
    wide.floats.grow(rows_with_memory_ * kPlanes * bins);
    wide.populated = wide.floats.size();
    for (float*& row : rows_) {
      if (row == nullptr) continue;
      float* const to = wide.floats.data() + wide.rows++ * kPlanes * bins;
      for (std::size_t plane = 0; plane < kPlanes; ++plane)
        std::memcpy(to + plane * bins, row + plane * row_size_, used * sizeof(float));
      std::fill(to + used, to + bins, std::numeric_limits<float>::quiet_NaN());
      row = to;
    }
    first_chunk_ = std::move(wide);
    more_chunks_.clear();
    current_ = 0;
    row_size_ = bins;
  }

  /// Removes all rows, and gives back the memory that as many rows of some bins each do not need.
  void shrinkTo(std::size_t bins) {
    row_size_ = bins;
    for (std::size_t i = 0; i < chunkCount(); ++i) chunk(i).floats.shrink(sizeOf(chunk(i).rows));
    clear(bins);
  }

  /// Removes all rows, and exchanges the memory of the first ones with an array of other elements, whose values are
  /// lost.
  template <typename Other>
  void exchangeMemory(GrowingArray<Other>& other) noexcept {
    clear(row_size_);
    first_chunk_.floats.exchangeMemory(other);
    first_chunk_.populated = first_chunk_.floats.size();
  }
  /// Number of rows for which there is memory, if they have so many bins.
  std::size_t capacityFor(std::size_t bins) const {
    std::size_t rows = 0;
    for (std::size_t i = 0; i < chunkCount(); ++i) rows += chunk(i).floats.size() / (kPlanes * bins);
    return rows;
  }
  /// Of the memory that exchangeMemory () exchanges.
  std::size_t exchangedBytes() const { return bytesOf(first_chunk_); }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < chunkCount(); ++i) sum += bytesOf(chunk(i));
    return sum;
  }

 private:
  struct Chunk {
    GrowingArray<float> floats;
    std::size_t rows = 0;       ///< in use, from the first on
    std::size_t populated = 0;  ///< floats, from the first on, whose pages need no populate ()

    bool has(const float* row) const {
      constexpr std::less<const float*> isBefore;
      return !isBefore(row, floats.data()) && isBefore(row, floats.data() + floats.size());
    }
  };
  static constexpr std::size_t kPlanes = 4;
  static_assert(sizeof(float) == sizeof(std::uint32_t), "the planes are of one size");

  std::size_t chunkCount() const { return 1 + more_chunks_.size(); }
  Chunk& chunk(std::size_t i) { return i == 0 ? first_chunk_ : more_chunks_[i - 1]; }
  const Chunk& chunk(std::size_t i) const { return i == 0 ? first_chunk_ : more_chunks_[i - 1]; }

  /// Of some rows, in floats.
  std::size_t sizeOf(std::size_t rows) const { return rows * kPlanes * row_size_; }
  static std::size_t bytesOf(const Chunk& chunk) { return chunk.floats.size() * sizeof(float); }

  /// Lets the rows of a chunk be those of its copy.
  void moveRows(const Chunk& from, Chunk& to) {
    for (float*& row : rows_)
      if (row != nullptr && from.has(row)) row = to.floats.data() + (row - from.floats.data());
  }

  Chunk first_chunk_;  ///< outside of the vector, so that an image without rows has no memory
  std::vector<Chunk> more_chunks_;
  std::vector<float*> rows_;  ///< by number; nullptr: it has no memory
  std::size_t rows_with_memory_ = 0;
  std::size_t current_ = 0;   ///< chunk that may have room for another row
  std::size_t row_size_ = 0;  ///< bins
};

}  // namespace lisco
