// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Shared by the vector code of several files; compiled once for each SIMD level.
#if defined(LISCO_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_LANES_INL_H
#undef LISCO_LANES_INL_H
#else
#define LISCO_LANES_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include <hwy/highway.h>

#include "core/bits.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Up to 16 floats, or as many 32-bit integers.
using Floats = hn::CappedTag<float, 16>;
using Words = hn::RebindToUnsigned<Floats>;
constexpr Floats kFloats{};
constexpr Words kWords{};
constexpr std::size_t kLanes = hn::MaxLanes(kFloats);  // vectors of unknown length are not among the levels
using FloatVector = hn::Vec<Floats>;
using FloatMask = hn::Mask<Floats>;

/// Bit i of the result is lane i of the mask.
HWY_INLINE std::uint32_t bitsOf(FloatMask mask) {
  std::uint8_t bytes[(kLanes + 7) / 8];
  hn::StoreMaskBits(kFloats, mask, bytes);
  // An integer of their size: filling up a larger one takes two more instructions.
  std::conditional_t<sizeof bytes == 1, std::uint8_t, std::uint16_t> bits;
  static_assert(sizeof bits == sizeof bytes);
  std::memcpy(&bits, bytes, sizeof bits);
  return wordOf(bits);
}

/// The mask of the lowest kLanes bits: the inverse of bitsOf.
HWY_INLINE FloatMask lanesOf(std::uint64_t bits) {
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof bytes);
  return hn::LoadMaskBits(kFloats, bytes);
}

/// The bits of the lanes that hold the next `count` elements: all, or fewer at the end of a list.
HWY_INLINE std::uint32_t lanesBelow(std::size_t count) {
  return count < kLanes ? (1U << count) - 1 : ~0U;
}

/// The bits of the kLanes columns from k on, shifted to 0.
HWY_INLINE std::uint64_t bitsAt(std::uint64_t bits, std::size_t k) {
  return bits >> k & ((std::uint64_t{1} << kLanes) - 1);
}

/// squaredDistance (neighbour.h) < squared_tolerance, lane by lane: separate multiplications and additions in its
/// order.
HWY_INLINE FloatMask areNeighbours(FloatVector dx, FloatVector dy, FloatVector dz, FloatVector squared_tolerance) {
  return hn::Lt(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)), squared_tolerance);
}

/// isReturn, lane by lane.
HWY_INLINE FloatMask areReturns(FloatVector x, FloatVector y, FloatVector z) {
  const FloatVector largest = hn::Set(kFloats, std::numeric_limits<float>::max());
  const FloatVector zero = hn::Zero(kFloats);
  const FloatMask finite =
      hn::And(hn::Le(hn::Abs(x), largest), hn::And(hn::Le(hn::Abs(y), largest), hn::Le(hn::Abs(z), largest)));
  const FloatMask origin = hn::And(hn::Eq(x, zero), hn::And(hn::Eq(y, zero), hn::Eq(z, zero)));
  return hn::AndNot(origin, finite);
}

HWY_INLINE FloatMask differ(const std::uint32_t* a, hn::Vec<Words> b) {
  return hn::RebindMask(kFloats, hn::Ne(hn::LoadU(kWords, a), b));
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#endif
