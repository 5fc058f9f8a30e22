// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>

#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco {

/// Fixed-capacity vector, without memory of the heap; ignores elements beyond its capacity.
template <typename T>
class Sample {
 public:
  static constexpr std::size_t kCapacity = 512;

  void push_back(const T& element) {
    if (size_ < kCapacity) elements_[size_++] = element;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return elements_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return elements_.data(); }
  const T* end() const { return begin() + size_; }

 private:
  std::array<T, kCapacity> elements_;
  std::size_t size_ = 0;
};

/// Estimates the sensor from a few pairs of cells near each other.
class SensorEstimator {
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

  /// \param declared_origin position that the cloud states for its sensor; used if the cloud does not lie around (0, 0,
  /// 0)
  SensorHints estimate(const std::array<float, 3>& declared_origin) const;

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

}  // namespace lisco
