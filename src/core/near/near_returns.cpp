// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/near_returns.h"

#include <algorithm>

namespace lisco {

void NearReturns::add(const RingBlock& block, const RingBlockInfo& info, ColumnBits which) {
  if (returns.size() < count + RingBlock::kColumns) returns.grow(count + std::max(count / 4, 4 * RingBlock::kColumns));
  const float* const x = block.x + RingBlock::kMargin;
  const float* const y = block.y + RingBlock::kMargin;
  const float* const z = block.z + RingBlock::kMargin;
  forEachChain(which & ~(which << 1), which, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) returns[count++] = {x[i], y[i], z[i], info.run[i]};
  });
}

}  // namespace lisco
