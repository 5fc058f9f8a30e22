// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace lisco {

constexpr std::size_t kHugePage = std::size_t{1} << 21;  ///< bytes

/// Whether the pages of new memory are provided when it is taken, or by the first write to each.
enum class NewPages { kPopulated, kUntouched };

/// Has the system provide the pages of new memory in one call, where it can (Linux 5.14); otherwise the first write to
/// each page causes a page fault. On virtual machines, a fault takes 1 to 10 microseconds, and a page of such a call
/// less than 2, but most of 1 if it is there already (first_call). So the page in the middle tells whether the memory
/// has been in use before, and a few pages are left to their first writes.
inline void populatePages([[maybe_unused]] void* begin, [[maybe_unused]] void* end) noexcept {
#ifdef __linux__
  constexpr int kPopulateWrite = 23;  // MADV_POPULATE_WRITE, which older headers lack
  constexpr std::uintptr_t kFewPages = 8;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto first = reinterpret_cast<std::uintptr_t>(begin) / page;
  const auto count = (reinterpret_cast<std::uintptr_t>(end) + page - 1) / page - first;
  if (count <= kFewPages) return;
  unsigned char middle = 0;
  if (mincore(reinterpret_cast<void*>((first + count / 2) * page), page, &middle) == 0 && (middle & 1) != 0) return;
  madvise(reinterpret_cast<void*>(first * page), count * page, kPopulateWrite);
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
