// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <array>
#include <cstddef>

#include "lisco/column_clusterer.h"
#include "lisco/export.h"
#include "lisco/return.h"

namespace lisco {

/// A few things, so that none of the heap's memory is needed. What comes after kMost of them is ignored.
template <typename T>
class Sample {
 public:
  static constexpr std::size_t kMost = 512;

  void push_back(const T& one) {
    if (size_ < kMost) all_[size_++] = one;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return all_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return all_.data(); }
  const T* end() const { return begin() + size_; }

 private:
  std::array<T, kMost> all_;
  std::size_t size_ = 0;
};

/// A few pairs of adjacent cells, by which a whole cloud is judged before it is clustered.
class LISCO_EXPORT ScanSurvey {
 public:
  /// Two returns of one laser in adjacent columns.
  void addAlongRow(const Return& a, const Return& b) { along_row_.push_back({a, b}); }
  /// A return of a laser that has none in the next column.
  void addAlone() { ++alone_; }
  /// Two returns of one laser, b `columns` columns after a, less than half a turn.
  void addFurtherAlongRow(const Return& a, const Return& b, std::size_t columns) {
    further_.push_back({a, b, columns});
  }
  /// Two returns of adjacent lasers in one column.
  void addAlongColumn(const Return& a, const Return& b) { along_column_.push_back({a, b}); }

  /// Where the cloud was seen from, and in what steps. Never changes the result, only the speed.
  /// \param sensor where the cloud says its sensor stands; used if the cloud does not lie around (0, 0, 0)
  Parameters judge(const std::array<float, 3>& sensor, bool organized) const;

 private:
  struct Pair {
    Return a, b;
  };
  struct FurtherPair {
    Return a, b;
    std::size_t columns;
  };
  Sample<Pair> along_row_, along_column_;
  Sample<FurtherPair> further_;
  std::size_t alone_ = 0;
};

/// Looks at about a hundred cells of an organized cloud (lasers > 1) or of an unorganized one (lasers == 1).
/// \param cell_at callable as Return (std::size_t laser, std::size_t column)
template <typename CellAt>
Parameters surveyScan(std::size_t columns, std::size_t lasers, const std::array<float, 3>& sensor, CellAt&& cell_at) {
  constexpr std::size_t kSmall = 4096;  // below this a view is not worth its layout
  constexpr std::size_t kRows = 8;
  constexpr std::size_t kPlaces = 128;
  constexpr std::size_t kFurther = 32;  // columns; less than half a turn of any sensor
  const auto valid = [](const Return& r) { return isReturn(r.x, r.y, r.z); };

  ScanSurvey survey;
  if (columns * lasers >= kSmall) {
    const std::size_t row_step = std::max<std::size_t>(1, lasers / kRows);
    const std::size_t places_per_row = std::max<std::size_t>(1, kPlaces * row_step / lasers);
    const std::size_t column_step = std::max<std::size_t>(1, columns / places_per_row);
    for (std::size_t laser = row_step / 2; laser < lasers; laser += row_step)
      for (std::size_t column = column_step / 2; column < columns; column += column_step) {
        const Return cell = cell_at(laser, column);
        if (!valid(cell)) continue;
        const Return right = column + 1 < columns ? cell_at(laser, column + 1) : kNoReturn;
        const Return below = laser + 1 < lasers ? cell_at(laser + 1, column) : kNoReturn;
        if (valid(right))
          survey.addAlongRow(cell, right);
        else
          survey.addAlone();
        const Return further = column + kFurther < columns ? cell_at(laser, column + kFurther) : kNoReturn;
        if (lasers > 1 && valid(further)) survey.addFurtherAlongRow(cell, further, kFurther);
        if (valid(below)) survey.addAlongColumn(cell, below);
      }
  }
  Parameters parameters = survey.judge(sensor, lasers > 1);
  parameters.expected_returns = columns * lasers;
  constexpr std::size_t kLeastShare = 4;  // of a turn; a strip for all of it would be mostly empty
  if (static_cast<std::size_t>(parameters.view.steps_per_turn) > kLeastShare * columns)
    parameters.view.steps_per_turn = 0;
  return parameters;
}

}  // namespace lisco
