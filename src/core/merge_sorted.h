// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

/// Sorted items that lie side by side.
struct SortedItems {
  const std::uint64_t* data;
  std::size_t count;
};

/// Merges sorted items. \param to receives all of them; memory of its own
void mergeSorted(const SortedItems& a, const SortedItems& b, std::uint64_t* to);

}  // namespace lisco
