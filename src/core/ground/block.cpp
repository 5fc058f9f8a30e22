// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/block.h"

#include <algorithm>
#include <cmath>

#include "core/ground/targets.h"
#include "core/pi.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/block.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A laser's cells of a block, or a part of them.
using RowFloats = hn::CappedTag<float, ground::Block::kColumns>;
using RowVector = hn::Vec<RowFloats>;
constexpr RowFloats kRow{};

/// Radians, 0 to 2 pi, within 0.004.
HWY_INLINE RowVector azimuthOf(RowVector x, RowVector y) {
  constexpr float kOctant = static_cast<float>(kPi / 4.0);
  const auto set = [](float value) HWY_ATTR { return hn::Set(kRow, value); };
  const auto zero = hn::Zero(kRow);
  const auto east = hn::Abs(x), north = hn::Abs(y);
  const auto ratio = hn::Div(hn::Min(east, north), hn::Add(hn::Max(east, north), set(1e-30F)));
  auto octants = hn::Mul(ratio, hn::Sub(set(1.2732F), hn::Mul(set(0.2732F), ratio)));
  octants = hn::IfThenElse(hn::Gt(north, east), hn::Sub(set(2.0F), octants), octants);
  octants = hn::IfThenElse(hn::Lt(x, zero), hn::Sub(set(4.0F), octants), octants);
  octants = hn::IfThenElse(hn::Lt(y, zero), hn::Sub(set(8.0F), octants), octants);
  return hn::Mul(octants, set(kOctant));
}

void measureRows(ground::Block& block, const ground::Columns& columns, std::size_t first, const SensorHints& sensor) {
  constexpr float kMaxCoordinate = 1e6F;  // metres; beyond, coordinates are no measurements
  const auto set = [](float value) { return hn::Set(kRow, value); };
  const auto zero = hn::Zero(kRow);
  const auto most = set(kMaxCoordinate);
  const std::size_t rows = block.size / ground::Block::kColumns;
  const auto least = set(ground::Block::kMinRho);
  for (std::size_t row = 0; row < rows; ++row) {
    unsigned returns = 0;
    for (std::size_t k = 0; k < ground::Block::kColumns; k += hn::Lanes(kRow)) {
      const std::size_t from = row * columns.stride + first + k;
      const std::size_t to = row * ground::Block::kColumns + k;
      const auto x_read = hn::LoadU(kRow, columns.x.data() + from);
      const auto y_read = hn::LoadU(kRow, columns.y.data() + from);
      const auto z_read = hn::LoadU(kRow, columns.z.data() + from);
      auto x = hn::Sub(x_read, set(sensor.origin[0]));
      auto y = hn::Sub(y_read, set(sensor.origin[1]));
      auto z = hn::Sub(z_read, set(sensor.origin[2]));
      const auto finite =
          hn::And(hn::Lt(hn::Abs(x), most), hn::And(hn::Lt(hn::Abs(y), most), hn::Lt(hn::Abs(z), most)));
      const auto none = hn::And(hn::Eq(x_read, zero), hn::And(hn::Eq(y_read, zero), hn::Eq(z_read, zero)));
      const auto valid = hn::AndNot(none, finite);
      x = hn::IfThenElseZero(valid, x);
      y = hn::IfThenElseZero(valid, y);
      z = hn::IfThenElseZero(valid, z);
      const auto squared = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
      const auto rho = hn::Sqrt(squared);
      hn::StoreU(rho, kRow, block.rho.data() + to);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(kRow, hn::Gt(rho, least), bits);
      returns |= static_cast<unsigned>(bits[0]) << k;
      const auto horizon = hn::Add(hn::Mul(set(sensor.tilt[0]), x), hn::Mul(set(sensor.tilt[1]), y));
      const auto height = hn::Sub(z, horizon);
      hn::StoreU(height, kRow, block.height.data() + to);
      hn::StoreU(x, kRow, block.x.data() + to);
      hn::StoreU(y, kRow, block.y.data() + to);
      hn::StoreU(azimuthOf(x, y), kRow, block.azimuth.data() + to);
    }
    block.returns[row] = static_cast<std::uint8_t>(returns);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(measureRows);

namespace ground {

void Columns::resize(std::size_t lasers, std::size_t columns) {
  stride = columns;
  for (auto* values : {&x, &y, &z}) values->resize(std::max(values->size(), lasers * columns));
}

void Columns::clear(std::size_t column, std::size_t lasers) {
  for (std::size_t laser = 0; laser < lasers; ++laser)
    for (auto* values : {&x, &y, &z}) (*values)[laser * stride + column] = 0.0F;
}

void Block::resize(std::size_t lasers) {
  size = lasers * kColumns;
  returns.resize(std::max(returns.size(), lasers));
  for (auto* values : {&x, &y, &rho, &height, &azimuth}) {
    values->resize(std::max(values->size(), size + kColumns));
    std::fill_n(values->begin() + static_cast<std::ptrdiff_t>(size), kColumns, 0.0F);
  }
}

void Block::measure(const Columns& columns, std::size_t first, const SensorHints& sensor) {
  HWY_DYNAMIC_DISPATCH(measureRows)(*this, columns, first, sensor);
}

}  // namespace ground
}  // namespace lisco
#endif
