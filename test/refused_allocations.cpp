// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "refused_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> deallocations{0};
std::atomic<std::size_t> refused_allocation{0};  ///< number of the allocation to refuse; 0: none

}  // namespace

// Not inlined: GCC would warn of malloc () and free () beside the other operators.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (++allocations != refused_allocation)
    if (void* const memory = std::malloc(size)) return memory;
  ++deallocations;  // delete of a null pointer
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  if (memory != nullptr) ++deallocations;
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  ::operator delete(memory);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto line = static_cast<std::size_t>(alignment);
  if (++allocations != refused_allocation)
    if (void* const memory = std::aligned_alloc(line, (size + line - 1) / line * line)) return memory;
  ++deallocations;  // delete of a null pointer
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  ::operator delete(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  ::operator delete(memory);
}

namespace lisco_test {

std::size_t allocationCount() {
  return allocations;
}

std::size_t liveAllocations() {
  return allocations - deallocations;
}

RefusedAllocation::RefusedAllocation(std::size_t n) : number_(allocations + n) {
  refused_allocation = number_;
}

RefusedAllocation::~RefusedAllocation() {
  refused_allocation = 0;
}

bool RefusedAllocation::happened() const {
  return allocations >= number_;
}

}  // namespace lisco_test
