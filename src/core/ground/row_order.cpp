// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/row_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/ground/polar_grid.h"
#include "core/pi.h"

namespace lisco::ground {
namespace {

constexpr float kTurn = static_cast<float>(2.0 * kPi);
constexpr float kSameAzimuth = 0.022F;  // radians
constexpr float kNearAzimuth = 0.04F;   // the same, where no row below is so near
constexpr float kClearly = 0.013F;      // of the slopes of rays

/// Brings a difference of azimuths to -pi to pi.
float wrapped(float angle) {
  if (std::fabs(angle) > kTurn) angle -= kTurn * std::floor(angle / kTurn);
  if (angle >= 0.5F * kTurn) return angle - kTurn;
  return angle < -0.5F * kTurn ? angle + kTurn : angle;
}

std::int32_t rowOf(std::uint64_t key) {
  return static_cast<std::int32_t>(key & 0x7FFFFFFFU);
}

}  // namespace

void RowOrder::begin(std::size_t lasers) {
  lasers_ = lasers;
  latest_.begin(lasers);
  rows_.clear();
  rows_.reserve(lasers);
  order_.clear();
  order_.reserve(lasers);
  rays_.resize(lasers);
  block_ = sort_at_ = 0;
  turn_ = 0.0F;
}

void RowOrder::update(const Block& block) {
  ++block_;
  const Turned turned = latest_.update(block, block_);
  if (turned.rows > 0) {
    const float angle = std::accumulate(turned.angles.begin(), turned.angles.end(), 0.0F);
    turn_ += (angle / static_cast<float>(turned.rows) - turn_) * (turn_ == 0.0F ? 1.0F : 0.25F);
  }
  if (turned.has_new || block_ >= sort_at_) {
    sort();
    sort_at_ = block_ + std::min(block_, 32U);
  }
}

bool RowOrder::areBeside(const Ray& a, const Ray& b) {
  const float apart = std::fabs(a.azimuth - b.azimuth);
  if (apart > kTurn) return std::fabs(wrapped(apart)) < kSameAzimuth;
  return (apart < kSameAzimuth) | (kTurn - apart < kSameAzimuth);
}

void RowOrder::sort() {
  const auto keyOf = [&](std::size_t row) {
    // A slope of -0 is one of 0.
    return std::uint64_t{orderedHeight(latest_.height[row] / latest_.rho[row] + 0.0F)} << 32 | row;
  };
  // Mostly the order is that of the last time.
  for (std::uint64_t& key : order_) key = keyOf(static_cast<std::size_t>(rowOf(key)));
  if (order_.size() < lasers_) {
    order_.clear();
    for (std::size_t row = 0; row < lasers_; ++row)
      if (latest_.block[row] != 0) order_.push_back(keyOf(row));
  }
  if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());

  const auto size = static_cast<std::int32_t>(order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto row = static_cast<std::size_t>(rowOf(order_[i]));
    rays_[i] = {latest_.azimuth[row] + turn_ * static_cast<float>(block_ - latest_.block[row]),
                latest_.height[row] / latest_.rho[row]};
  }
  rows_.clear();
  constexpr std::int32_t kMost = 64;  // rows, looked through
  const auto rayAt = [&](std::int32_t at) -> const Ray& { return rays_[static_cast<std::size_t>(at)]; };
  const auto rowAt = [&](std::int32_t at) {
    return at == kNone ? static_cast<std::int32_t>(lasers_) : rowOf(order_[static_cast<std::size_t>(at)]);
  };
  std::int32_t clearly = 0;  // the first row clearly above row i
  for (std::int32_t i = 0; i < size; ++i) {
    std::int32_t down = kNone;
    for (std::int32_t j = i - 1; j >= 0 && j >= i - kMost && down == kNone; --j)
      if (areBeside(rayAt(i), rayAt(j))) down = j;
    if (down == kNone) {
      float nearest = kNearAzimuth;
      for (std::int32_t j = i - 1; j >= 0 && j >= i - kMost; --j) {
        const float apart = std::fabs(wrapped(rayAt(i).azimuth - rayAt(j).azimuth));
        if (apart < nearest) {
          nearest = apart;
          down = j;
        }
      }
    }
    while (clearly < size && rayAt(clearly).slope <= rayAt(i).slope + kClearly) ++clearly;
    const auto nextBeside = [&](std::int32_t from) {
      for (std::int32_t j = from; j < size && j <= i + kMost; ++j)
        if (areBeside(rayAt(i), rayAt(j))) return j;
      return kNone;
    };
    const std::int32_t up = nextBeside(i + 1);
    const std::int32_t above = up == kNone ? kNone : nextBeside(std::max(up + 1, clearly));
    rows_.push_back({rowAt(i), down, up, rowAt(up), rowAt(above)});
  }
}

}  // namespace lisco::ground
