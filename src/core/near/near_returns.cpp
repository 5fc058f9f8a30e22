// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/near_returns.h"

#include "core/near/constants.h"

namespace lisco {

void NearReturns::add(const RingBlock& block, const RingBlockInfo& info, ColumnBits which) {
  returns.growInSteps(count + RingBlock::kColumns + kReadBehind);
  const float* const x = block.x + RingBlock::kMargin;
  const float* const y = block.y + RingBlock::kMargin;
  const float* const z = block.z + RingBlock::kMargin;
  forEachChain(which & ~(which << 1), which, [&](std::size_t begin, std::size_t end) {
    NearReturn* const to = returns.data() + count;
    for (std::size_t i = 0; i < end - begin; i += kNearStep)
      for (std::size_t k = i; k < i + kNearStep; ++k)
        to[k] = {x[begin + k], y[begin + k], z[begin + k], info.run[begin + k]};
    count += end - begin;
  });
}

}  // namespace lisco
