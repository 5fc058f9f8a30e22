// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/row_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/bits.h"
#include "core/ground/column_profile.h"
#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/row_order.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using AzimuthFloats = hn::CappedTag<float, RowOrder::kPadding>;
constexpr AzimuthFloats kAzimuths{};
constexpr auto kStep = static_cast<std::int32_t>(hn::MaxLanes(kAzimuths));

// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr float kSameAzimuth = 0.022F;  // radians
constexpr float kNearAzimuth = 0.04F;   // radians; for the row below, if none has the same azimuth
constexpr float kClearly = 0.013F;      // difference of the slopes of rays
constexpr std::int32_t kMaxApart = 64;  // in the order of rows, of two that are compared

/// Of the azimuths from position j on, those beside another one, as bits.
HWY_INLINE unsigned besideAt(const float* azimuths, std::int32_t j, float azimuth) {
  const auto apart = hn::Abs(hn::Sub(hn::LoadU(kAzimuths, azimuths + j), hn::Set(kAzimuths, azimuth)));
  const auto nearer = hn::Min(apart, hn::Sub(hn::Set(kAzimuths, kTurn), apart));
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(kAzimuths, hn::Lt(nearer, hn::Set(kAzimuths, kSameAzimuth)), bits);
  return wordOf(bits[0]);
}

/// The first position before `end` with an azimuth beside that of i, or kNone.
HWY_INLINE std::int32_t nextBeside(const float* azimuths, std::int32_t i, std::int32_t from, std::int32_t end) {
  for (std::int32_t j = from; j < end; j += kStep) {
    const unsigned bits = besideAt(azimuths, j, azimuths[i]);
    const std::int32_t found = j + __builtin_ctz(bits | 0x100U);
    if (bits != 0) return found < end ? found : RowOrder::kNone;
  }
  return RowOrder::kNone;
}

/// The last position below i with an azimuth beside its own; else the one with the nearest, or kNone.
HWY_INLINE std::int32_t lastBeside(const float* azimuths, std::int32_t i) {
  const std::int32_t first = std::max(0, i - kMaxApart);
  for (std::int32_t j = i - kStep; j > first - kStep; j -= kStep) {
    const unsigned bits = besideAt(azimuths, j, azimuths[i]);
    const std::int32_t found = j + 31 - __builtin_clz(bits | 1U);
    if (bits != 0) {
      if (found >= first) return found;
      break;
    }
  }
  std::int32_t down = RowOrder::kNone;
  float nearest = kNearAzimuth;
  for (std::int32_t j = i - 1; j >= first; --j) {
    const float apart = std::fabs(azimuths[i] - azimuths[j]), nearer = std::min(apart, kTurn - apart);
    if (nearer < nearest) {
      nearest = nearer;
      down = j;
    }
  }
  return down;
}

/// Finds the rows below and above each.
/// \param row_of the rows in the block, by position; that of kNone is `none`
void linkRows(const float* azimuths, const float* slopes, const std::uint64_t* keys, std::int32_t none,
              std::vector<RowOrder::Row>& rows) {
  const auto rowAt = [=](std::int32_t at) { return at == RowOrder::kNone ? none : RowOrder::rowOf(keys[at]); };
  const auto size = static_cast<std::int32_t>(rows.size());
  std::int32_t clearly = 0;  // the first row clearly above row i
  for (std::int32_t i = 0; i < size; ++i) {
    while (clearly < size && slopes[clearly] <= slopes[i] + kClearly) ++clearly;
    const std::int32_t end = std::min(size, i + kMaxApart + 1);
    const std::int32_t up = nextBeside(azimuths, i, i + 1, end);
    const std::int32_t above =
        up == RowOrder::kNone ? RowOrder::kNone : nextBeside(azimuths, i, std::max(up + 1, clearly), end);
    rows[static_cast<std::size_t>(i)] = {rowAt(i), lastBeside(azimuths, i), up, rowAt(up), rowAt(above)};
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(linkRows);

void RowOrder::begin(std::size_t lasers) {
  lasers_ = lasers;
  latest_.begin(lasers);
  rows_.clear();
  order_.clear();
  azimuths_.resize(std::max(azimuths_.size(), lasers + 2 * kPadding));
  slopes_.resize(std::max(slopes_.size(), lasers));
  reserve();
  block_ = sort_at_ = 0;
  turn_ = 0.0F;
}

void RowOrder::reserve() {
  rows_.reserve(slopes_.size());
  order_.reserve(slopes_.size());
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

void RowOrder::sort() {
  const auto keyOf = [&](std::size_t row) {
    // A slope of -0 is one of 0.
    return std::uint64_t{orderedBits(latest_.height[row] / latest_.rho[row] + 0.0F)} << 32 | row;
  };
  // Mostly the order is that of the last time.
  for (std::uint64_t& key : order_) key = keyOf(static_cast<std::size_t>(rowOf(key)));
  if (order_.size() < lasers_) {
    order_.clear();
    for (std::size_t row = 0; row < lasers_; ++row)
      if (latest_.block[row] != 0) order_.push_back(keyOf(row));
  }
  if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());

  float* const azimuths = azimuths_.data() + kPadding;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const auto row = static_cast<std::size_t>(rowOf(order_[i]));
    const float azimuth = latest_.azimuth[row] + turn_ * static_cast<float>(block_ - latest_.block[row]);
    azimuths[i] = azimuth - kTurn * std::floor(azimuth / kTurn);
    slopes_[i] = latest_.height[row] / latest_.rho[row];
  }
  rows_.resize(order_.size());
  HWY_DYNAMIC_DISPATCH(linkRows)(azimuths, slopes_.data(), order_.data(), static_cast<std::int32_t>(lasers_), rows_);
}

}  // namespace lisco::ground
#endif
