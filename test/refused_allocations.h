// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Counts the allocations of operator new, aligned ones too, and refuses one on request. Programs that include
// refused_allocations.cpp replace operator new.
#pragma once

#include <cstddef>

namespace lisco_test {

/// Calls of operator new so far.
std::size_t allocationCount();

/// Allocations that are not freed yet.
std::size_t liveAllocations();

/// Refuses one allocation while it lives: the n-th from now on, counted from 1.
class RefusedAllocation {
 public:
  explicit RefusedAllocation(std::size_t n);
  ~RefusedAllocation();
  RefusedAllocation(const RefusedAllocation&) = delete;
  RefusedAllocation& operator=(const RefusedAllocation&) = delete;

  bool happened() const;  ///< whether that allocation was asked for

 private:
  std::size_t number_;
};

}  // namespace lisco_test
