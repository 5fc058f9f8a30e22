// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/strided_points.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/strided_points.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Reads four points at a time: 16 bytes of each, but 12 of the last one of all, behind which memory may end.
/// \param stride bytes, at least 12
/// \return number of points read: all but up to three
std::size_t readSideBySide(const unsigned char* xyz, std::ptrdiff_t stride, std::size_t count,
                           const CellSource::Destination& to) {
#if HWY_TARGET == HWY_SCALAR
  static_cast<void>(xyz), static_cast<void>(stride), static_cast<void>(count), static_cast<void>(to);
  return 0;
#else
  constexpr std::size_t kPoints = 4;
  constexpr hn::FixedTag<float, kPoints> kFour{};
  std::size_t i = 0;
  for (; i + kPoints <= count; i += kPoints, xyz += 4 * stride) {
    const auto load = [&](const unsigned char* bytes) {
      return hn::LoadU(kFour, reinterpret_cast<const float*>(bytes));
    };
    const unsigned char* last = xyz + 3 * stride;
    unsigned char copy[kPoints * sizeof(float)] = {};
    if (i + kPoints == count) {
      std::memcpy(copy, last, 3 * sizeof(float));
      last = copy;
    }
    const auto first = load(xyz), second = load(xyz + stride), third = load(xyz + 2 * stride), fourth = load(last);
    const auto front_xy = hn::InterleaveLower(kFour, first, second);
    const auto back_xy = hn::InterleaveLower(kFour, third, fourth);
    const auto front_z = hn::InterleaveUpper(kFour, first, second);
    const auto back_z = hn::InterleaveUpper(kFour, third, fourth);
    hn::StoreU(hn::ConcatLowerLower(kFour, back_xy, front_xy), kFour, to.x + i);
    hn::StoreU(hn::ConcatUpperUpper(kFour, back_xy, front_xy), kFour, to.y + i);
    hn::StoreU(hn::ConcatLowerLower(kFour, back_z, front_z), kFour, to.z + i);
  }
  return i;
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(readSideBySide);

void StridedPoints::read(std::size_t first, std::size_t count, const CellSource::Destination& to) const {
  if (count == 0) return;
  const auto* const from_x = static_cast<const unsigned char*>(x);
  const bool is_side_by_side = y == from_x + sizeof(float) && z == from_x + 2 * sizeof(float);
  std::size_t i = 0;
  if (is_side_by_side && stride >= static_cast<std::ptrdiff_t>(3 * sizeof(float)))
    i = HWY_DYNAMIC_DISPATCH(readSideBySide)(from_x + static_cast<std::ptrdiff_t>(first) * stride, stride, count, to);
  for (; i < count; ++i) {
    const Return point = at(first + i);
    to.x[i] = point.x;
    to.y[i] = point.y;
    to.z[i] = point.z;
  }
}

}  // namespace lisco
#endif
