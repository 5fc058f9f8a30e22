// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Vectors of the ground filter: the columns of a block, or bins of the map; compiled once for each SIMD level.
#if defined(LISCO_GROUND_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_GROUND_LANES_INL_H
#undef LISCO_GROUND_LANES_INL_H
#else
#define LISCO_GROUND_LANES_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "core/bits.h"
#include "core/ground/block.h"
#include "core/ground/distance_bins.h"

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using LaneFloats = hn::CappedTag<float, Block::kColumns>;
using LaneInts = hn::RebindToSigned<LaneFloats>;
using LaneWords = hn::RebindToUnsigned<LaneFloats>;
using Floats = hn::Vec<LaneFloats>;
using Mask = hn::Mask<LaneFloats>;
constexpr LaneFloats kLanes{};
constexpr LaneInts kLaneInts{};
constexpr LaneWords kLaneWords{};

HWY_INLINE Floats set(float value) {
  return hn::Set(kLanes, value);
}

/// The lanes of a mask as bits of the columns of a block, from column k on.
HWY_INLINE std::uint8_t bitsOf(Mask mask, std::size_t k) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(kLanes, mask, bits);
  return static_cast<std::uint8_t>(wordOf(bits[0]) << k);
}

/// The inverse.
HWY_INLINE Mask lanesOf(std::uint8_t bits, std::size_t k) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits >> k)};
  return hn::LoadMaskBits(kLanes, bytes);
}

/// distanceBin of each lane
HWY_INLINE hn::Vec<LaneInts> distanceBins(Floats rho, std::int32_t bins) {
  const auto bits = hn::ShiftRight<kDistanceBinShift>(hn::BitCast(kLaneInts, hn::Mul(rho, rho)));
  const auto bin = hn::Max(hn::Sub(bits, hn::Set(kLaneInts, kFirstDistanceBin)), hn::Zero(kLaneInts));
  return hn::Min(bin, hn::Set(kLaneInts, bins - 1));
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#endif
