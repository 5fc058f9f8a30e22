// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/block.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/ground/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

void measureRows(Block& block, const Columns& columns, std::size_t first, const SensorHints& sensor) {
  constexpr float kMaxCoordinate = 1e6F;  // metres; beyond, coordinates are no measurements
  const auto most = hn::BitCast(kLaneInts, set(kMaxCoordinate));
  const std::size_t rows = block.size / Block::kColumns;
  const auto least = set(Block::kMinRho);
  // Copies: the compiler must assume that storing the bytes of `returns` changes any other array.
  const std::array<float, 3> origin = sensor.origin;
  const std::array<float, 2> tilt = sensor.tilt;
  const float* const x_from = columns.x.data() + first;
  const float* const y_from = columns.y.data() + first;
  const float* const z_from = columns.z.data() + first;
  float* const block_rho = block.rho.data();
  float* const block_height = block.height.data();
  std::uint32_t* const last_columns = block.last.data();
  float* const last_x = block.last_x.data();
  float* const last_y = block.last_y.data();
  float* const last_rho = block.last_rho.data();
  float* const last_height = block.last_height.data();
  std::uint8_t* const block_returns = block.returns.data();
  const std::size_t stride = columns.stride;
  for (std::size_t row = 0; row < rows; ++row) {
    unsigned returns = 0;
    for (std::size_t k = 0; k < Block::kColumns; k += hn::Lanes(kLanes)) {
      const std::size_t from = row * stride + k;
      const std::size_t to = row * Block::kColumns + k;
      const auto x_read = hn::LoadU(kLanes, x_from + from);
      const auto y_read = hn::LoadU(kLanes, y_from + from);
      const auto z_read = hn::LoadU(kLanes, z_from + from);
      const auto x = hn::Sub(x_read, set(origin[0]));
      const auto y = hn::Sub(y_read, set(origin[1]));
      const auto z = hn::Sub(z_read, set(origin[2]));
      // As integers, the magnitudes of floats are in their order, and those of NaN above all.
      const auto magnitude = [](Floats value) HWY_ATTR { return hn::BitCast(kLaneInts, hn::Abs(value)); };
      const auto largest = hn::Max(hn::Max(magnitude(x), magnitude(y)), magnitude(z));
      const auto any = hn::BitCast(kLaneInts, hn::Abs(hn::Or(hn::Or(x_read, y_read), z_read)));
      const auto is_return =
          hn::RebindMask(kLanes, hn::AndNot(hn::Eq(any, hn::Zero(kLaneInts)), hn::Lt(largest, most)));
      const auto squared = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
      const auto rho = hn::Sqrt(hn::IfThenElseZero(is_return, squared));
      hn::StoreU(rho, kLanes, block_rho + to);
      returns |= unsigned{bitsOf(hn::Gt(rho, least), k)};
      const auto horizon = hn::Add(hn::Mul(set(tilt[0]), x), hn::Mul(set(tilt[1]), y));
      const auto height = hn::IfThenElseZero(is_return, hn::Sub(z, horizon));
      hn::StoreU(height, kLanes, block_height + to);
    }
    block_returns[row] = static_cast<std::uint8_t>(returns);
    const std::size_t last = 31 - static_cast<std::size_t>(__builtin_clz(returns | 1U));
    last_columns[row] = static_cast<std::uint32_t>(last);
    last_x[row] = x_from[row * stride + last] - origin[0];
    last_y[row] = y_from[row * stride + last] - origin[1];
    last_rho[row] = block_rho[row * Block::kColumns + last];
    last_height[row] = block_height[row * Block::kColumns + last];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(measureRows);

void Columns::resize(std::size_t lasers, std::size_t columns) {
  stride = columns;
  for (auto* values : {&x, &y, &z}) values->resize(std::max(values->size(), lasers * columns));
}

void Columns::clear(std::size_t column, std::size_t lasers) {
  for (std::size_t laser = 0; laser < lasers; ++laser) set(laser, column, kNoReturn);
}

void Block::resize(std::size_t lasers) {
  size = lasers * kColumns;
  returns.resize(std::max(returns.size(), lasers));
  last.resize(std::max(last.size(), lasers));
  for (auto* values : {&rho, &height}) {
    values->resize(std::max(values->size(), size + kColumns));
    std::fill_n(values->begin() + static_cast<std::ptrdiff_t>(size), kColumns, 0.0F);
  }
  for (auto* values : {&last_x, &last_y, &last_rho, &last_height}) {
    values->resize(std::max(values->size(), lasers + kColumns - 1));
    std::fill_n(values->begin() + static_cast<std::ptrdiff_t>(lasers), kColumns - 1, 0.0F);
  }
}

void Block::measure(const Columns& columns, std::size_t first, const SensorHints& sensor) {
  HWY_DYNAMIC_DISPATCH(measureRows)(*this, columns, first, sensor);
}

}  // namespace lisco::ground
#endif
