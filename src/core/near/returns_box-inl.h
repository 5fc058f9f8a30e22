// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The box around returns, several in a vector; compiled once for each SIMD level.
#if defined(LISCO_RETURNS_BOX_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_RETURNS_BOX_INL_H
#undef LISCO_RETURNS_BOX_INL_H
#else
#define LISCO_RETURNS_BOX_INL_H
#endif

#include <cstddef>
#include <limits>

#include "core/lanes-inl.h"
#include "core/near/constants.h"
#include "core/near/near_returns.h"
#include "core/near/voxel_plane.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// The box around returns.
#if HWY_TARGET == HWY_SCALAR
class ReturnsBox {
 public:
  void add(const NearReturn* returns, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) box_.add(returns[i]);
  }
  const BoxLanes& box() const { return box_; }

 private:
  BoxLanes box_ = BoxLanes::empty();
};
#else
class ReturnsBox {
 public:
  ReturnsBox() : lo_(hn::Set(kFloats, std::numeric_limits<float>::infinity())), hi_(hn::Neg(lo_)) {}

  /// \param returns up to kReadBehind are read behind the last
  void add(const NearReturn* returns, std::size_t count) {
    static_assert(kLanes % 4 == 0 && 2 * kLanes <= 4 * kReadBehind,
                  "vectors are whole returns, and fit behind the last");
    const float* const values = &returns->x;
    addVector(values, 4 * count);  // both at once: a branch for each costs more
    addVector(values + kLanes, 4 * count > kLanes ? 4 * count - kLanes : 0);
    std::size_t k = 2 * kLanes;
    for (; k + kLanes <= 4 * count; k += kLanes) {
      const FloatVector coordinates = hn::LoadU(kFloats, values + k);
      lo_ = hn::Min(lo_, coordinates);
      hi_ = hn::Max(hi_, coordinates);
    }
    if (k < 4 * count) addVector(values + k, 4 * count - k);
  }

  BoxLanes box() const {
    float lo[kLanes];
    float hi[kLanes];
    hn::StoreU(lo_, kFloats, lo);
    hn::StoreU(hi_, kFloats, hi);
    BoxLanes box = BoxLanes::empty();
    for (std::size_t k = 0; k < kLanes; k += 4) box.add(BoxLanes(lo + k, hi + k));
    return box;
  }

 private:
  HWY_INLINE void addVector(const float* values, std::size_t count) {
    const FloatVector coordinates = hn::LoadU(kFloats, values);
    const FloatMask used = hn::FirstN(kFloats, count);
    lo_ = hn::IfThenElse(used, hn::Min(lo_, coordinates), lo_);
    hi_ = hn::IfThenElse(used, hn::Max(hi_, coordinates), hi_);
  }

  FloatVector lo_, hi_;  ///< lane 4 i + k is coordinate k
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#endif
