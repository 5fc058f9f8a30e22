// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Counts what operator new gives out, and refuses what a test tells it to. A program with refused_allocations.cpp in it
// replaces operator new.
#pragma once

#include <cstddef>

namespace lisco_test {

/// Calls of operator new so far.
std::size_t allocationCount();

/// Allocations that have not been given back.
std::size_t liveAllocations();

/// Refuses one allocation, as long as this lives: the n-th from now on, counted from 1.
class RefusedAllocation {
 public:
  explicit RefusedAllocation(std::size_t n);
  ~RefusedAllocation();
  RefusedAllocation(const RefusedAllocation&) = delete;
  RefusedAllocation& operator=(const RefusedAllocation&) = delete;

  bool happened() const;  ///< whether as many were asked for

 private:
  std::size_t number_;
};

}  // namespace lisco_test
