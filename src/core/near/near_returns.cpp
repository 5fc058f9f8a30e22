// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/near_returns.h"

#include "core/near/constants.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/near/near_returns.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Copies some returns of a ring block side by side, as vectors of consecutive columns: gathering the chosen lanes of a
/// vector takes AVX2 several times as long. Up to kReadBehind more are written.
void copyReturns(const RingBlock& block, const std::uint32_t* elements, ColumnBits which, NearReturn* to) {
  static_assert(kLanes <= kReadBehind, "a vector fits behind the last");
  static_assert(sizeof(NearReturn) == 4 * sizeof(float), "lane 4 i + k is coordinate k");
  const auto at = [](const float* coordinates, std::size_t i) {
    return hn::LoadU(kFloats, coordinates + RingBlock::kMargin + i);
  };
  forEachChain(which & ~(which << 1), which, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += kLanes)
      hn::StoreInterleaved4(at(block.x, i), at(block.y, i), at(block.z, i),
                            hn::BitCast(kFloats, hn::LoadU(kWords, elements + i)), kFloats, &to[i - begin].x);
    to += end - begin;
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(copyReturns);

void NearReturns::add(const RingBlock& block, const std::uint32_t* elements, ColumnBits which) {
  returns.growInSteps(count + RingBlock::kColumns + kReadBehind);
  HWY_DYNAMIC_DISPATCH(copyReturns)(block, elements, which, returns.data() + count);
  count += countBits(which);
}

}  // namespace lisco
#endif
