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

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace lisco {

/// A growing array whose elements have no value until they are written: growing touches no new memory. In a fresh
/// process, first writes to pages are most of what a first scan costs more than later ones. From 2 MiB on, the array
/// begins with huge pages, where the system gives them.
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

  /// Grows to a size, if it is below. Elements that are there keep their values, perhaps at another address.
  /// \throws std::bad_alloc, with nothing changed
  void grow(std::size_t size) {
    if (size <= size_) return;
    if (size > (PTRDIFF_MAX - kHugePage) / sizeof(T)) throw std::bad_alloc();
    std::size_t bytes = size * sizeof(T);
    // Half a huge page and more at the end becomes a whole one.
    if (bytes >= kHugePage && bytes % kHugePage > kHugePage / 2) bytes = (bytes / kHugePage + 1) * kHugePage;
    void* data = nullptr;
    if (bytes < kHugePage || size_ * sizeof(T) >= kHugePage) {
      data = std::realloc(static_cast<void*>(data_), bytes);  // of large arrays, the system moves the pages
    } else {
      if (posix_memalign(&data, kHugePage, bytes) != 0) data = nullptr;
      if (data != nullptr && size_ > 0) std::memcpy(data, static_cast<const void*>(data_), size_ * sizeof(T));
      if (data != nullptr) std::free(data_);
    }
#ifdef MADV_HUGEPAGE
    if (data != nullptr && bytes >= kHugePage) useHugePages(data, bytes);
#endif
    if (data == nullptr) throw std::bad_alloc();
    data_ = static_cast<T*>(data);
    size_ = bytes / sizeof(T);
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;  ///< bytes

#ifdef MADV_HUGEPAGE
  /// Without huge pages, all is the same but slower.
  static void useHugePages(void* data, std::size_t bytes) {
    const auto first = reinterpret_cast<std::uintptr_t>(data);
    const std::uintptr_t begin = (first + kHugePage - 1) / kHugePage * kHugePage;
    if (begin < first + bytes) madvise(reinterpret_cast<void*>(begin), first + bytes - begin, MADV_HUGEPAGE);
  }
#endif

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace lisco
