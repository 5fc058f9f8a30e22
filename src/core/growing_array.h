// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/pages.h"

namespace lisco {

/// Elements to make room for where some are needed now and more follow step by step: doubles few, and adds an eighth to
/// many, as doubling would waste memory.
constexpr std::size_t withSpare(std::size_t count) {
  return count + std::max(count / 8, std::min(count, std::size_t{1024})) + 256;
}

/// Makes room in a vector for elements that come step by step.
template <typename T>
void reserveInSteps(std::vector<T>& elements, std::size_t count) {
  if (elements.capacity() < count) elements.reserve(withSpare(count));
}

/// A growing array whose elements have no value until they are written. In a fresh process, the system's work for new
/// pages is most of what a first scan costs more than later ones: growing has it provide them in one call. From 2 MiB
/// on, the array lies in huge pages, where the system gives them. A rest of more than three quarters of a huge page
/// takes a whole one; a smaller rest lies in ordinary pages.
template <typename T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>, "elements are bytes");

 public:
  GrowingArray() = default;
  ~GrowingArray() { std::free(data_); }
  GrowingArray(const GrowingArray& other) {
    grow(other.size_);
    if (other.size_ > 0) std::memcpy(static_cast<void*>(data_), other.data_, other.size_ * sizeof(T));
  }
  GrowingArray(GrowingArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  GrowingArray& operator=(GrowingArray other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }

  std::size_t size() const { return size_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

  /// Exchanges memory with an array of other elements; the values of both are lost.
  template <typename Other>
  void exchangeMemory(GrowingArray<Other>& other) noexcept {
    static_assert(alignof(T) <= alignof(std::max_align_t) && alignof(Other) <= alignof(std::max_align_t));
    T* const data = reinterpret_cast<T*>(other.data_);
    const std::size_t size = other.size_ * sizeof(Other) / sizeof(T);
    other.data_ = reinterpret_cast<Other*>(data_);
    other.size_ = size_ * sizeof(T) / sizeof(Other);
    data_ = data;
    size_ = size;
  }

  /// The same as grow (), for a size that grows step by step.
  void growInSteps(std::size_t size) {
    if (size > size_) grow(withSpare(size));
  }

  /// Gives back the memory behind a size, if it is above. Elements before keep their values, perhaps at another
  /// address.
  void shrink(std::size_t size) {
    if (size >= size_ || size == 0) return;
    void* const data = std::realloc(static_cast<void*>(data_), size * sizeof(T));
    if (data == nullptr) return;  // all is there as before
    data_ = static_cast<T*>(data);
    size_ = size;
  }

  /// Grows to a size, if it is below. Elements that are there keep their values, perhaps at another address.
  /// \param pages untouched: for memory of which an unknown part will be written; see populatePages ()
  /// \throws std::bad_alloc, with nothing changed
  void grow(std::size_t size, NewPages pages = NewPages::kPopulated) {
    if (size <= size_) return;
    if (size > (PTRDIFF_MAX - kHugePage) / sizeof(T)) throw std::bad_alloc();
    std::size_t bytes = size * sizeof(T);
    if (bytes >= kHugePage && bytes % kHugePage > kHugePage / 4 * 3) bytes += kHugePage - bytes % kHugePage;
    // Not std::realloc (), which would write to new pages one by one where it moves the array.
    void* const data = bytes < kHugePage ? std::malloc(bytes) : allocateHugePages(bytes);
    if (data == nullptr) throw std::bad_alloc();
    if (pages == NewPages::kPopulated) populatePages(data, static_cast<char*>(data) + bytes);
    if (size_ > 0) std::memcpy(data, static_cast<const void*>(data_), size_ * sizeof(T));
    std::free(data_);
    data_ = static_cast<T*>(data);
    size_ = bytes / sizeof(T);
  }

 private:
  template <typename Other>
  friend class GrowingArray;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace lisco
