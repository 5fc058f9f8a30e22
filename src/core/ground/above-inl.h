// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// What the rows above and the columns beside show about the returns of a row; compiled once for each SIMD level.
#if defined(LISCO_ABOVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_ABOVE_INL_H
#undef LISCO_ABOVE_INL_H
#else
#define LISCO_ABOVE_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include "core/ground/follow_rows.h"
#include "core/ground/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

// Distances and heights are metres, slopes metres per metre.
// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.

// What is above a return.
constexpr float kWallWidth = 0.05F, kWallGrowth = 0.003F;  // by which returns of an upright surface differ in distance
constexpr float kKerb = 0.15F;                             // highest one
constexpr float kKerbWidth = 0.1F, kBeyondKerb = 1.0F;     // least and most way up to the ground beyond a kerb
constexpr float kMaxAbove = 3.0F;                          // what is higher hangs over
constexpr float kSteep = 0.6F;                             // slope of a surface that is no ground
constexpr float kSurfaceStep = 0.2F, kSurfaceGrowth = 0.04F;  // returns of one surface are nearer to each other
constexpr float kLineStep = 0.3F, kLineSpan = 2.0F;           // least lengths of a line of three returns
constexpr float kStraight = 0.04F;                            // by which the slopes along a line differ

// The columns beside.
constexpr float kRough = 0.15F, kRoughGrowth = 0.04F;  // of the distances of columns beside each other
constexpr float kSameRay = 0.003F;                     // difference of the slopes of rays

/// A row, and those around it.
struct FollowedRow {
  const float* rho;
  const float* height;
  const float* block_rho;  ///< of all rows
  const float* block_height;
  const RowOrder::Row* row;
  const GroundMap::Sector* sector;
  const Passed* before;  ///< of the rows below
  Passed* passed;
  const GroundReached* inwards;  ///< the ground that these have reached
  GroundReached* followed;
  std::size_t number;  ///< of `followed`
  float unevenness;    ///< Unevenness::value
};

HWY_INLINE Floats select(Mask mask, Floats yes, Floats no) {
  return hn::IfThenElse(mask, yes, no);
}

/// base + growth * distance
HWY_INLINE Floats grown(float base, float growth, Floats distance) {
  return hn::Add(set(base), hn::Mul(set(growth), distance));
}

/// What the rows above show about the returns of a row.
struct Above {
  Mask wall;           ///< upright above the return
  Mask steep;          ///< too steep for ground
  Mask surface;        ///< a rising surface that begins at the return
  Mask seen;           ///< there is a return beyond
  Mask nearer;         ///< there is a return that is nearer
  Floats slope, step;  ///< to the return beyond
  Mask line;           ///< two returns beyond, on a line with this one
  Floats line_slope;
};

HWY_INLINE Above lookUp(const FollowedRow& row, std::size_t k, Floats rho, Floats height, Floats max_slope) {
  const auto least = set(Block::kMinRho);
  const auto wall_width = grown(kWallWidth, kWallGrowth, rho);
  constexpr auto kColumns = static_cast<std::ptrdiff_t>(Block::kColumns);
  const std::ptrdiff_t up = row.row->up_row * kColumns, over = row.row->above_row * kColumns;
  const auto up_rho = hn::LoadU(kLanes, row.block_rho + up + k);
  const auto up_height = hn::LoadU(kLanes, row.block_height + up + k);
  const auto above_rho = hn::LoadU(kLanes, row.block_rho + over + k);
  const auto above_height = hn::LoadU(kLanes, row.block_height + over + k);
  const auto is_up = hn::Gt(up_rho, least), is_above = hn::Gt(above_rho, least);
  const auto up_step = hn::Sub(up_rho, rho), above_step = hn::Sub(above_rho, rho);
  const auto up_rise = hn::Sub(up_height, height), above_rise = hn::Sub(above_height, height);
  const auto isWall = [&](Mask is, Floats step, Floats rise) {
    return hn::And(hn::And(is, hn::And(hn::Gt(rise, set(0.05F)), hn::Lt(rise, set(kMaxAbove)))),
                   hn::Lt(hn::Abs(step), wall_width));
  };
  const auto isSteep = [&](Mask is, Floats step, Floats rise) {
    return hn::And(hn::And(is, hn::And(hn::Gt(rise, set(0.1F)), hn::Lt(rise, set(kMaxAbove)))),
                   hn::And(hn::Gt(step, set(-0.2F)), hn::Gt(rise, hn::Mul(set(kSteep), step))));
  };
  Above above;
  // Beyond a kerb, the ground goes on a little higher.
  const auto beyond_kerb =
      hn::And(hn::And(is_above, hn::Lt(above_rise, set(kKerb))),
              hn::And(hn::Gt(above_step, hn::Add(wall_width, set(kKerbWidth))), hn::Lt(above_step, set(kBeyondKerb))));
  above.wall =
      hn::Or(hn::AndNot(beyond_kerb, isWall(is_up, up_step, up_rise)), isWall(is_above, above_step, above_rise));
  above.steep = hn::Or(isSteep(is_up, up_step, up_rise), isSteep(is_above, above_step, above_rise));

  const auto up_slope = hn::Div(up_rise, hn::Max(up_step, set(0.05F)));
  const auto above_slope = hn::Div(above_rise, hn::Max(above_step, set(0.05F)));
  const auto sees_up = hn::And(is_up, hn::Gt(up_step, set(0.1F)));
  const auto sees_above = hn::And(is_above, hn::Gt(above_step, set(-0.1F)));
  above.seen = hn::Or(sees_up, sees_above);
  above.nearer = hn::Or(hn::And(is_up, hn::Lt(up_step, set(-0.1F))), hn::And(is_above, hn::Lt(above_step, set(-0.1F))));
  above.slope = select(sees_above, above_slope, up_slope);
  above.step = select(sees_above, above_step, up_step);

  const auto nearest = hn::Min(select(hn::And(is_up, hn::Gt(up_step, set(-0.2F))), up_step, set(1e9F)),
                               select(hn::And(is_above, hn::Gt(above_step, set(-0.2F))), above_step, set(1e9F)));
  const auto rises = hn::Or(above.steep, hn::And(above.seen, hn::Gt(above.slope, max_slope)));
  above.surface = hn::And(rises, hn::Lt(nearest, grown(kSurfaceStep, kSurfaceGrowth, rho)));

  const auto further = hn::Sub(above_rho, up_rho);
  const auto further_slope = hn::Div(hn::Sub(above_height, up_height), hn::Max(further, set(kLineStep)));
  above.line_slope = up_slope;
  above.line = hn::And(
      hn::And(hn::And(is_up, is_above), hn::And(hn::Gt(up_step, set(kLineStep)), hn::Gt(further, set(kLineStep)))),
      hn::And(hn::And(hn::Lt(hn::Abs(up_slope), max_slope), hn::Gt(above_step, set(kLineSpan))),
              hn::Lt(hn::Abs(hn::Sub(further_slope, up_slope)), set(kStraight))));
  return above;
}

/// The values of the columns before. For the first column of the block, which has none, that of the second one.
HWY_INLINE Floats leftOf(const float* row, std::size_t k, Floats values) {
  if (k != 0) return hn::LoadU(kLanes, row + k - 1);
  if (hn::MaxLanes(kLanes) == 1) return hn::LoadU(kLanes, row + 1);
  const auto left = hn::Sub(hn::Iota(kLaneInts, 0), hn::Set(kLaneInts, 1));
  return hn::TableLookupLanes(values, hn::IndicesFromVec(kLanes, hn::Abs(left)));
}

/// The values of the columns after. For the last column of the block, which has none, that of the one before.
HWY_INLINE Floats rightOf(const float* row, std::size_t k, Floats values) {
  constexpr auto kStep = hn::MaxLanes(kLanes);
  if (k + kStep != Block::kColumns) return hn::LoadU(kLanes, row + k + 1);
  if (kStep == 1) return hn::LoadU(kLanes, row + k - 1);
  const auto last = hn::Set(kLaneInts, static_cast<std::int32_t>(kStep) - 1);
  const auto right = hn::Add(hn::Iota(kLaneInts, 0), hn::Set(kLaneInts, 1));
  const auto inside = hn::Sub(last, hn::Abs(hn::Sub(right, last)));
  return hn::TableLookupLanes(values, hn::IndicesFromVec(kLanes, inside));
}

/// Whether the same laser's returns in the columns beside are at other distances, as those of leaves are.
HWY_INLINE Mask isRough(const FollowedRow& row, std::size_t k, Floats rho, Floats height) {
  const auto most = grown(kRough, kRoughGrowth, rho);
  Mask seen = hn::Lt(rho, hn::Zero(kLanes)), near = seen;  // none
  const auto look = [&](Floats beside_rho, Floats beside_height) {
    const auto turned = hn::Abs(hn::Sub(hn::Mul(beside_height, rho), hn::Mul(height, beside_rho)));
    const auto same_ray = hn::Lt(turned, hn::Mul(set(kSameRay), hn::Mul(rho, beside_rho)));
    seen = hn::Or(seen, same_ray);
    near = hn::Or(near, hn::And(same_ray, hn::Lt(hn::Abs(hn::Sub(beside_rho, rho)), most)));
  };
  look(leftOf(row.rho, k, rho), leftOf(row.height, k, height));
  look(rightOf(row.rho, k, rho), rightOf(row.height, k, height));
  return hn::AndNot(near, seen);
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#endif
