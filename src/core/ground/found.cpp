// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/found.h"

#include <cstddef>

#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/found.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

// Least part of the ground among a row's returns and those of the rows next to it, and what the unevenness takes off.
// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr float kMinGround = 0.285F, kUnevenMinGround = 0.15F;

/// The bits of a row in the lowest byte, and of the rows next to it in the next ones.
HWY_INLINE std::uint32_t together(std::uint8_t row, std::uint8_t down, std::uint8_t up) {
  return std::uint32_t{row} | std::uint32_t{down} << 8 | std::uint32_t{up} << 16;
}

/// Number of bits. Unlike countBits, of which there is one for all levels, this uses the level's instruction.
HWY_INLINE float partOf(std::uint32_t bits) {
  return static_cast<float>(__builtin_popcount(bits));
}

void dropScatteredRows(const RowOrder::Row* rows, Found* found, const std::int32_t* with_ground, std::size_t count,
                       float unevenness, std::int32_t* scattered) {
  const float least_ground = kMinGround - unevenness * kUnevenMinGround;
  std::size_t dropped = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::int32_t i = with_ground[k], down = rows[i].down, up = rows[i].up;
    if ((found[i].higher | found[down].higher | found[up].higher) == 0) continue;
    const std::uint32_t ground = together(found[i].ground, found[down].ground, found[up].ground);
    const std::uint32_t higher = together(found[i].higher, found[down].higher, found[up].higher);
    scattered[dropped] = i;
    dropped += partOf(ground) < least_ground * partOf(ground | higher) ? 1 : 0;
  }
  for (std::size_t k = 0; k < dropped; ++k) {
    Found& row = found[scattered[k]];
    row.ground &= row.known;
    row.reached &= row.known;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(dropScatteredRows);

void dropScattered(const RowOrder::Row* rows, Found* found, const std::vector<std::int32_t>& with_ground,
                   std::size_t count, float unevenness, std::vector<std::int32_t>& scattered) {
  HWY_DYNAMIC_DISPATCH(dropScatteredRows)(rows, found, with_ground.data(), count, unevenness, scattered.data());
}

}  // namespace lisco::ground
#endif
