// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/latest_returns.h"

#include <algorithm>

#include "core/ground/direction.h"
#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/latest_returns.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/ground/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

/// Radians, 0 to 2 pi, within 0.004.
HWY_INLINE Floats roughAzimuthOf(Floats x, Floats y) {
  constexpr float kOctant = static_cast<float>(kPi / 4.0);
  const auto zero = hn::Zero(kLanes);
  const auto east = hn::Abs(x), north = hn::Abs(y);
  const auto ratio = hn::Div(hn::Min(east, north), hn::Add(hn::Max(east, north), set(1e-30F)));
  auto octants = hn::Mul(ratio, hn::Sub(set(1.2732F), hn::Mul(set(0.2732F), ratio)));
  octants = hn::IfThenElse(hn::Gt(north, east), hn::Sub(set(2.0F), octants), octants);
  octants = hn::IfThenElse(hn::Lt(x, zero), hn::Sub(set(4.0F), octants), octants);
  octants = hn::IfThenElse(hn::Lt(y, zero), hn::Sub(set(8.0F), octants), octants);
  return hn::Mul(octants, set(kOctant));
}

/// Enters a block's last returns.
void updateLatest(const Block& block, std::size_t lasers, std::uint32_t number, LatestReturns& latest, Turned& turned) {
  constexpr float kSectorsPerRadian = static_cast<float>(kSectors) / kTurn;
  constexpr std::size_t kStep = hn::MaxLanes(kLanes);
  const auto sector_mask = hn::Set(kLaneInts, static_cast<std::int32_t>(kSectors) - 1);
  const auto before = hn::Set(kLaneWords, number - 1), now = hn::Set(kLaneWords, number);
  std::size_t rows = 0;
  bool has_new = false;
  for (std::size_t first = 0; first < lasers; first += Block::kColumns)
    for (std::size_t k = 0; k < Block::kColumns; k += kStep) {
      const std::size_t i = first + k;
      const auto rho = hn::LoadU(kLanes, &block.last_rho[i]);
      const auto x = hn::LoadU(kLanes, &block.last_x[i]), y = hn::LoadU(kLanes, &block.last_y[i]);
      const auto has = hn::Gt(rho, set(Block::kMinRho));
      const auto azimuth = roughAzimuthOf(x, y);
      const auto azimuth_before = hn::LoadU(kLanes, &latest.azimuth[i]);
      const auto seen = hn::LoadU(kLaneWords, &latest.block[i]);
      const auto is_first = hn::RebindMask(kLanes, hn::Eq(seen, hn::Zero(kLaneWords)));
      has_new = has_new || !hn::AllFalse(kLanes, hn::And(has, is_first));
      const auto follows = hn::And(hn::AndNot(is_first, has), hn::RebindMask(kLanes, hn::Eq(seen, before)));
      auto angle = hn::Sub(azimuth, azimuth_before);
      angle = hn::IfThenElse(hn::Ge(angle, set(0.5F * kTurn)), hn::Sub(angle, set(kTurn)),
                             hn::IfThenElse(hn::Lt(angle, set(-0.5F * kTurn)), hn::Add(angle, set(kTurn)), angle));
      float* const sum = &turned.angles[k];
      hn::StoreU(hn::Add(hn::LoadU(kLanes, sum), hn::IfThenElseZero(follows, angle)), kLanes, sum);
      rows += hn::CountTrue(kLanes, follows);

      const auto enter = [&](Floats value, float* to)
                             HWY_ATTR { hn::StoreU(hn::IfThenElse(has, value, hn::LoadU(kLanes, to)), kLanes, to); };
      enter(x, &latest.x[i]);
      enter(y, &latest.y[i]);
      enter(rho, &latest.rho[i]);
      enter(hn::LoadU(kLanes, &block.last_height[i]), &latest.height[i]);
      enter(azimuth, &latest.azimuth[i]);
      const auto sector = hn::And(hn::ConvertTo(kLaneInts, hn::Mul(azimuth, set(kSectorsPerRadian))), sector_mask);
      std::int32_t* const sectors = &latest.sector[i];
      hn::StoreU(hn::IfThenElse(hn::RebindMask(kLaneInts, has), sector, hn::LoadU(kLaneInts, sectors)), kLaneInts,
                 sectors);
      hn::StoreU(hn::IfThenElse(hn::RebindMask(kLaneWords, has), now, seen), kLaneWords, &latest.block[i]);
    }
  turned.rows = rows;
  turned.has_new = has_new;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(updateLatest);

void LatestReturns::begin(std::size_t lasers) {
  lasers_ = lasers;
  // Sizes never shrink: a copy of a vector has no capacity beyond its size.
  const std::size_t size = std::max(x.size(), lasers + Block::kColumns - 1);
  for (auto* values : {&y, &height, &azimuth}) values->assign(size, 0.0F);
  for (auto* values : {&x, &rho}) values->assign(size, 1.0F);
  sector.assign(size, 0);
  block.assign(size, 0);
}

Turned LatestReturns::update(const Block& from, std::uint32_t number) {
  Turned turned;
  HWY_DYNAMIC_DISPATCH(updateLatest)(from, lasers_, number, *this, turned);
  return turned;
}

}  // namespace lisco::ground
#endif
