// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>

#include "core/sorted_element.h"

namespace lisco {

/// Fixed-capacity vector, without memory of the heap; ignores elements beyond its capacity.
template <typename T, std::size_t kCapacity = 256>
class Sample {
 public:
  void push_back(const T& element) {
    if (size_ < kCapacity) elements_[size_++] = element;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }
  T* begin() { return elements_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return elements_.data(); }
  const T* end() const { return begin() + size_; }
  const T& operator[](std::size_t i) const { return elements_[i]; }

 private:
  std::array<T, kCapacity> elements_;
  std::size_t size_ = 0;
};

/// The element at a part (0 to 1) of the sample's ascending order. The sample is not empty.
template <typename T, std::size_t kCapacity>
T quantile(Sample<T, kCapacity>& sample, double part) {
  return sortedElement(sample, static_cast<std::size_t>(part * static_cast<double>(sample.size() - 1)));
}

}  // namespace lisco
