// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/bits.h"
#include "core/growing_array.h"
#include "core/ring_block.h"

namespace lisco {

/// A near return and the element of its run. Side by side in memory: sorting takes returns from anywhere.
struct NearReturn {
  float x, y, z;          ///< metres
  std::uint32_t element;  ///< in UnorderedReturns, which has no runs: the source index
};

/// Near returns in the order in which they are read, collected until VoxelSorter links them.
struct NearReturns {
  GrowingArray<NearReturn> returns;  ///< kReadBehind longer than count, at least
  std::size_t count = 0;

  /// Appends some returns of a ring block.
  /// \param elements of each column; may be read up to kReadBehind behind the last
  /// \param which bit i: return i
  void add(const RingBlock& block, const std::uint32_t* elements, ColumnBits which);
};

}  // namespace lisco
