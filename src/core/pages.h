// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace lisco {

constexpr std::size_t kPage = std::size_t{1} << 12;      ///< bytes
constexpr std::size_t kHugePage = std::size_t{1} << 21;  ///< bytes

/// Whether the pages of new memory are provided when it is taken, or by the first write to each.
enum class NewPages { kPopulated, kUntouched };

/// Has the system provide the pages of new memory in one call, where it can (Linux 5.14); otherwise the first write to
/// each page causes a page fault. On virtual machines, a fault takes 2 to 10 microseconds, and a page of such a call
/// less than 2 (first_call).
inline void populatePages(void* begin, void* end) noexcept {
#ifdef __linux__
  constexpr int kPopulateWrite = 23;  // MADV_POPULATE_WRITE, which older headers lack
  const auto first = reinterpret_cast<std::uintptr_t>(begin) / kPage * kPage;
  const auto last = (reinterpret_cast<std::uintptr_t>(end) + kPage - 1) / kPage * kPage;
  if (last - first >= 2 * kPage) madvise(reinterpret_cast<void*>(first), last - first, kPopulateWrite);
#else
  (void)begin;
  (void)end;
#endif
}

/// Memory that lies in huge pages, where the system gives them. For std::free (); nullptr if there is none.
inline void* allocateHugePages(std::size_t bytes) noexcept {
  void* data = nullptr;
  if (posix_memalign(&data, kHugePage, bytes) != 0) return nullptr;
#ifdef MADV_HUGEPAGE
  madvise(data, bytes, MADV_HUGEPAGE);  // without huge pages, all is the same but slower
#endif
  void* const fitted = std::realloc(data, bytes);  // returns what alignment took behind the array
  return fitted == nullptr ? data : fitted;
}

}  // namespace lisco
