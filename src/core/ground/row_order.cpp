// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/row_order.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace lisco::ground {
namespace {

constexpr float kTurn = static_cast<float>(2.0 * kPi);
constexpr float kSameAzimuth = 0.022F;  // radians
constexpr float kNearAzimuth = 0.04F;   // radians; for the row below, if none has the same azimuth
constexpr float kClearly = 0.013F;      // difference of the slopes of rays

/// Brings a difference of azimuths to -pi to pi.
float wrapped(float angle) {
  if (std::fabs(angle) > kTurn) angle -= kTurn * std::floor(angle / kTurn);
  if (angle >= 0.5F * kTurn) return angle - kTurn;
  return angle < -0.5F * kTurn ? angle + kTurn : angle;
}

}  // namespace

void RowOrder::begin(std::size_t lasers) {
  seen_.assign(lasers, Seen());
  rows_.clear();
  rows_.reserve(lasers);
  order_.reserve(lasers);
  now_.assign(lasers, 0.0F);
  block_ = sort_at_ = 0;
  turn_ = 0.0F;
}

void RowOrder::update(const Block& block) {
  ++block_;
  bool is_new = false;
  float turned = 0.0F;
  int count = 0;
  for (std::size_t row = 0; row < seen_.size(); ++row) {
    if (block.returns[row] == 0) continue;
    const std::size_t at = row * Block::kColumns + 31 - static_cast<std::size_t>(__builtin_clz(block.returns[row]));
    Seen& seen = seen_[row];
    const float azimuth = block.azimuth[at];
    if (seen.block == 0) is_new = true;
    if (seen.block != 0 && seen.block + 1 == block_) {
      turned += wrapped(azimuth - seen.azimuth);
      ++count;
    }
    seen = {block.x[at], block.y[at], block.rho[at], block.height[at], azimuth, block_};
  }
  if (count > 0) turn_ += (turned / static_cast<float>(count) - turn_) * (turn_ == 0.0F ? 1.0F : 0.25F);
  if (is_new || block_ >= sort_at_) {
    sort();
    sort_at_ = std::min(2 * block_, block_ + 32);
  }
}

void RowOrder::sort() {
  order_.clear();
  for (std::size_t row = 0; row < seen_.size(); ++row) {
    if (seen_[row].block == 0) continue;
    order_.push_back(static_cast<std::int32_t>(row));
    now_[row] = seen_[row].azimuth + turn_ * static_cast<float>(block_ - seen_[row].block);
  }
  std::sort(order_.begin(), order_.end(), [&](std::int32_t a, std::int32_t b) {
    const float slope_a = seen_[static_cast<std::size_t>(a)].slope(),
                slope_b = seen_[static_cast<std::size_t>(b)].slope();
    return slope_a != slope_b ? slope_a < slope_b : a < b;
  });
  rows_.clear();
  constexpr std::int32_t kMaxApart = 64;  // in the order of rows, of two that are compared
  const auto size = static_cast<std::int32_t>(order_.size());
  const auto seenAt = [&](std::int32_t at) -> const Seen& {
    return seen_[static_cast<std::size_t>(order_[static_cast<std::size_t>(at)])];
  };
  const auto nowAt = [&](std::int32_t at) {
    return now_[static_cast<std::size_t>(order_[static_cast<std::size_t>(at)])];
  };
  for (std::int32_t i = 0; i < size; ++i) {
    Row row{order_[static_cast<std::size_t>(i)], kNone, kNone, kNone};
    const auto apart = [&](std::int32_t j) { return std::fabs(wrapped(nowAt(i) - nowAt(j))); };
    float nearest = kNearAzimuth;
    for (std::int32_t j = i - 1; j >= 0 && j >= i - kMaxApart && nearest >= kSameAzimuth; --j)
      if (apart(j) < nearest) {
        nearest = apart(j);
        row.down = j;
      }
    for (std::int32_t j = i + 1; j < size && j <= i + kMaxApart && row.above == kNone; ++j)
      if (apart(j) < kSameAzimuth) {
        if (row.up == kNone) row.up = j;
        if (j != row.up && seenAt(j).slope() > seenAt(i).slope() + kClearly) row.above = j;
      }
    rows_.push_back(row);
  }
}

}  // namespace lisco::ground
