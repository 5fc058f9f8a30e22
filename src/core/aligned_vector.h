// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include "core/pages.h"

namespace lisco {

/// Allocates at the beginning of lines of the cache, so that no vector of the processor lies in two of them; new pages
/// are provided in one call.
template <typename T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};  ///< bytes

  LineAllocator() = default;
  template <typename Other>
  explicit LineAllocator(const LineAllocator<Other>& /*other*/) {}

  T* allocate(std::size_t count) {
    T* const memory = static_cast<T*>(::operator new(count * sizeof(T), kLine));
    populatePages(memory, memory + count);
    return memory;
  }
  void deallocate(T* memory, std::size_t /*count*/) { ::operator delete(memory, kLine); }

  friend bool operator==(const LineAllocator& /*a*/, const LineAllocator& /*b*/) { return true; }
  friend bool operator!=(const LineAllocator& /*a*/, const LineAllocator& /*b*/) { return false; }
};

template <typename T>
using AlignedVector = std::vector<T, LineAllocator<T>>;

}  // namespace lisco
