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

#ifdef __linux__
/// The pages that hold some memory.
struct Pages {
  std::uintptr_t size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  std::uintptr_t first, end;

  Pages(const void* begin_of_memory, const void* end_of_memory)
      : first(reinterpret_cast<std::uintptr_t>(begin_of_memory) / size * size),
        end((reinterpret_cast<std::uintptr_t>(end_of_memory) + size - 1) / size * size) {}

  std::uintptr_t count() const { return (end - first) / size; }
  /// Whether the one in the middle has been provided.
  bool areInUse() const {
    unsigned char is_there = 0;
    return mincore(reinterpret_cast<void*>(first + count() / 2 * size), size, &is_there) == 0 && (is_there & 1) != 0;
  }
};
#endif

/// Whether the pages of some memory are likely to have been provided, as those of memory that has been given back.
inline bool arePagesInUse([[maybe_unused]] const void* begin, [[maybe_unused]] const void* end) noexcept {
#ifdef __linux__
  return Pages(begin, end).areInUse();
#else
  return true;
#endif
}

/// Has the system provide the pages of new memory in one call, where it can (Linux 5.14); otherwise the first write to
/// each page causes a page fault. On virtual machines, a fault takes 2 to 10 microseconds, and a page of such a call
/// less than 2, but most of 1 if it is there already (first_call). A few pages are left to their first writes.
inline void populatePages([[maybe_unused]] void* begin, [[maybe_unused]] void* end) noexcept {
#ifdef __linux__
  constexpr int kPopulateWrite = 23;  // MADV_POPULATE_WRITE, which older headers lack
  constexpr std::uintptr_t kFewPages = 8;
  const Pages pages(begin, end);
  if (pages.count() > kFewPages && !pages.areInUse())
    madvise(reinterpret_cast<void*>(pages.first), pages.end - pages.first, kPopulateWrite);
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
