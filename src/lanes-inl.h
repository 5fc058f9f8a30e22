// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// What the vector code of several files shares; compiled once for each level of vector instructions.
#if defined(LISCO_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_LANES_INL_H
#undef LISCO_LANES_INL_H
#else
#define LISCO_LANES_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Up to 16 floats at a time, or as many numbers of 32 bits.
using Floats = hn::CappedTag<float, 16>;
using Words = hn::RebindToUnsigned<Floats>;
constexpr Floats kFloats{};
constexpr Words kWords{};
constexpr std::size_t kLanes = hn::MaxLanes(kFloats);  // vectors of unknown length are not among the levels
using FloatVector = hn::Vec<Floats>;
using FloatMask = hn::Mask<Floats>;

/// Bit i of the result is lane i of the mask.
HWY_INLINE std::uint32_t bitsOf(FloatMask mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(kFloats, mask, bytes);
  std::uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

/// PCL's comparison, lane by lane: separate multiplications and additions in its order (see tolerance.h).
HWY_INLINE FloatMask areNeighbours(FloatVector dx, FloatVector dy, FloatVector dz, FloatVector squared_tolerance) {
  return hn::Lt(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)), squared_tolerance);
}

HWY_INLINE FloatMask differ(const std::uint32_t* a, hn::Vec<Words> b) {
  return hn::RebindMask(kFloats, hn::Ne(hn::LoadU(kWords, a), b));
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#endif
