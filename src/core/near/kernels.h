// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/near/constants.h"
#include "core/neighbour.h"
#include "core/ring_block.h"

namespace lisco {

/// Voxel numbers of a ring block's returns along each axis, modulo 2^32; entry 1 + i is that of return i.
struct VoxelNumbers {
  std::uint32_t of[3][1 + RingBlock::kColumns];
};

/// Consecutive points. Up to kReadBehind floats behind the last are read.
struct PointSpan {
  const float* x;
  const float* y;
  const float* z;
  std::size_t count;
};

/// Numbers the voxels of some returns in float.
/// \param which bit i: return i
/// \param changes bit i is set if return i lies in another voxel than return i - 1
/// \return false, with the numbers undefined, if one is too large for float to be exact enough (kMaxFloatNumber)
bool numberVoxels(const RingBlock& block, std::uint64_t which, float voxels_per_metre, VoxelNumbers& numbers,
                  std::uint64_t& changes);

/// Whether any point of one span is a neighbour of any point of another.
bool haveNeighbours(const PointSpan& a, const Box& a_box, const PointSpan& b, const Box& b_box,
                    float squared_tolerance);

}  // namespace lisco
