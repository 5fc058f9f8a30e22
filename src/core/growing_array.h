// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace lisco {

/// Elements to make room for where some are needed now and more follow step by step: some to spare, but less than
/// doubling would waste.
constexpr std::size_t withSpare(std::size_t count) {
  return count + count / 8 + 256;
}

/// Makes room in a vector for elements that come step by step.
template <typename T>
void reserveInSteps(std::vector<T>& elements, std::size_t count) {
  if (elements.capacity() < count) elements.reserve(withSpare(count));
}

/// A growing array whose elements have no value until they are written: growing touches no new memory. In a fresh
/// process, first writes to pages are most of what a first scan costs more than later ones. From 2 MiB on, the array
/// lies in huge pages, where the system gives them. A rest of more than three quarters of a huge page takes a whole
/// one; a smaller rest lies in ordinary pages.
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
  /// \throws std::bad_alloc, with nothing changed
  void grow(std::size_t size) {
    if (size <= size_) return;
    if (size > (PTRDIFF_MAX - kHugePage) / sizeof(T)) throw std::bad_alloc();
    const std::size_t bytes = size * sizeof(T);
    void* data = nullptr;
    if (bytes < kHugePage) {
      data = std::realloc(static_cast<void*>(data_), bytes);
    } else {
      const std::size_t rest = bytes % kHugePage;
      const std::size_t rounded = rest > kHugePage / 4 * 3 ? bytes - rest + kHugePage : bytes;
      data = allocateHugePages(rounded);
      if (size_ > 0) std::memcpy(data, static_cast<const void*>(data_), size_ * sizeof(T));
      std::free(data_);
      size = rounded / sizeof(T);
    }
    if (data == nullptr) throw std::bad_alloc();
    data_ = static_cast<T*>(data);
    size_ = size;
  }

 private:
  template <typename Other>
  friend class GrowingArray;
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;  ///< bytes

  static void* allocateHugePages(std::size_t bytes) {
    void* data = nullptr;
    if (posix_memalign(&data, kHugePage, bytes) != 0) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    madvise(data, bytes, MADV_HUGEPAGE);  // without huge pages, all is the same but slower
#endif
    void* const fitted = std::realloc(data, bytes);  // returns what alignment took behind the array
    return fitted == nullptr ? data : fitted;
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace lisco
