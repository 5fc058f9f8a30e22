// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/column_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/ground/column_profile.h"
#include "core/ground/distance_bins.h"
#include "core/ground/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ground/column_line.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

// Loops that the compiler vectorizes, for each SIMD level.

HWY_BEFORE_NAMESPACE();
namespace lisco::ground {
namespace HWY_NAMESPACE {

// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr float kNear = 25.0F;         // metres; beyond, the ground may be higher or lower
constexpr std::size_t kMaxCells = 48;  // of a column
constexpr float kMinReach = 1.12F;     // of a cell's distance by that of the one before
constexpr float kSameSlope = 0.08F;    // metres per metre
constexpr float kLevel = 0.1F;         // metres per metre
constexpr float kEnough = 0.5F;        // of the most weight
constexpr float kWindow = 0.1F;        // metres, of heights that agree
constexpr float kLowSensor = 0.3F;     // metres; a line less deep beneath the sensor may be on the table it stands on
constexpr float kBeyondTable = 2.2F;   // metres; such a line counts if its second cell is further out than a table is
constexpr float kTableGap = 1.75F;     // and less than this many times as far as its first
constexpr float kBelowTable = 0.1F;    // metres, by which the floor beside a table is lower at least
constexpr float kRoom = 10.0F;         // metres, distance up to which that floor is looked for
static_assert(kMaxCells <= kMaxLines);

AgreedHeight agreedHeight(const ColumnLine* lines, std::size_t size, float window, float enough) {
  std::array<float, kMaxLines> heights, support{};
  for (std::size_t i = 0; i < size; ++i) heights[i] = lines[i].height;
  for (std::size_t j = 0; j < size; ++j) {
    const float height = lines[j].height, weight = sureWeight(lines[j]);
    for (std::size_t i = 0; i < size; ++i) support[i] += std::fabs(heights[i] - height) < window ? weight : 0.0F;
  }
  float most = 0.0F;
  for (std::size_t i = 0; i < size; ++i) most = std::max(most, support[i]);
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < size; ++i)
    if (support[i] >= enough * most) lowest = std::min(lowest, heights[i]);
  float sum = 0.0F, weight = 0.0F;
  for (std::size_t i = 0; i < size; ++i)
    if (std::fabs(heights[i] - (lowest + window)) < 2.0F * window) {
      sum += lines[i].weight * heights[i];
      weight += lines[i].weight;
    }
  return {weight > 0.0F ? sum / weight : 0.0F, weight};
}

/// Collects a column's near returns. \return their direction
HWY_INLINE Direction collect(const Block& block, const Columns& columns, std::size_t first, std::size_t column,
                             const std::array<float, 3>& origin, ColumnLineFinder::Returns& returns,
                             ColumnProfile& profile) {
  float* const rho = returns.rho.data();
  float* const height = returns.height.data();
  float* const x = returns.x.data();
  float* const y = returns.y.data();
  std::uint64_t* const lowest = returns.lowest.data();
  std::uint32_t* const bins = returns.bins.data();
  std::uint32_t* const levels = returns.levels.data();
  // Written always, counted if near.
  std::size_t count = 0;
  for (std::size_t i = column, from = first + column; i < block.size; i += Block::kColumns, from += columns.stride) {
    const float distance = block.rho[i];
    rho[count] = distance;
    height[count] = block.height[i];
    x[count] = columns.x[from] - origin[0];
    y[count] = columns.y[from] - origin[1];
    count += static_cast<std::size_t>((distance > Block::kMinRho) & (distance < kNear));
  }
  for (std::size_t i = 0; i < count; ++i) {
    x[i] /= rho[i];
    y[i] /= rho[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    bins[i] = static_cast<std::uint32_t>(distanceBin(rho[i], static_cast<std::int32_t>(kBins)));
    levels[i] = levelOf(height[i]);
  }
  for (std::size_t i = 0; i < count; ++i) lowest[i] = lowestOf(rho[i], height[i]);
  Direction sum{0.0F, 0.0F};
  for (std::size_t i = 0; i < count; ++i) {
    profile.add(bins[i], lowest[i], levels[i]);
    sum.x += x[i];
    sum.y += y[i];
  }
  const float length = std::max(std::sqrt(sum.x * sum.x + sum.y * sum.y), 1e-3F);
  return {sum.x / length, sum.y / length};
}

bool findLine(const Block& block, const Columns& columns, std::size_t first, std::size_t column,
              const ColumnLineFinder::Setting& setting, ColumnLineFinder::Returns& returns, ColumnLine& line) {
  ColumnProfile profile;  // of all azimuths: lasers of a column may be staggered
  const Direction direction = collect(block, columns, first, column, setting.origin, returns, profile);

  struct Low {
    float rho, height;
  };
  std::array<Low, kMaxCells + 1> lows;
  std::size_t size = 0;
  forEachBin(profile, [&](std::size_t bin) {
    const Cell& cell = profile.cells[bin];
    lows[size] = {cell.lowRho(), cell.low()};
    size += static_cast<std::size_t>((size < kMaxCells) & isBare(cell.low(), cell.levels));
  });
  // For each of these, the first clearly beyond it, and the slope to there.
  std::array<std::size_t, kMaxCells + 1> beyond;
  std::array<float, kMaxCells> slopes;
  beyond[size] = size;
  for (std::size_t i = 0, j = 0; i < size; ++i) {
    j = std::max(j, i + 1);
    while (j < size && lows[j].rho < kMinReach * lows[i].rho) ++j;
    beyond[i] = j;
  }
  const auto slopeOf = [&](std::size_t i, std::size_t j) {
    return (lows[j].height - lows[i].height) / (lows[j].rho - lows[i].rho);
  };
  for (std::size_t i = 0; i < size && beyond[i] < size; ++i) slopes[i] = slopeOf(i, beyond[i]);
  // Whether the column has returns below a line, as those of the floor are beyond a table.
  const auto isPassedBelow = [&](float height, float slope) {
    bool is_below = false;
    forEachBin(profile, [&](std::size_t bin) {
      const float rho = profile.cells[bin].lowRho(), below = height + slope * rho - profile.cells[bin].low();
      is_below = is_below || (rho < kRoom && below > kBelowTable);
    });
    return is_below;
  };
  // Lines through three cells, or through two that are nearly level.
  std::array<ColumnLine, kMaxCells> lines;
  std::size_t count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t j = beyond[i];
    if (j == size) break;
    float slope = slopes[i];
    float weight = 0.5F;
    const std::size_t k = beyond[j];
    if (k < size && std::fabs(slopes[j] - slope) < kSameSlope && std::fabs(slope) < setting.max_slope) {
      slope = slopeOf(i, k);
      weight = 1.0F;
    } else if (std::fabs(slope) > kLevel) {
      continue;
    }
    const float height = lows[i].height - slope * lows[i].rho;
    const bool is_far = lows[j].rho > kBeyondTable && lows[j].rho < kTableGap * lows[i].rho;
    if ((height > -kLowSensor && !is_far) || (height > -kTable && isPassedBelow(height, slope))) continue;
    if (height < setting.highest) lines[count++] = {height, slope, weight, lows[i].rho, direction};
  }
  const AgreedHeight agreed = agreedHeight(lines.data(), count, kWindow, kEnough);
  if (agreed.weight == 0.0F) return false;
  line = {agreed.height, 0.0F, agreed.weight, 0.0F, direction};
  float weight = 0.0F;
  for (std::size_t i = 0; i < count; ++i)
    if (std::fabs(lines[i].height - agreed.height) < 2.0F * kWindow) {
      line.slope += lines[i].weight * lines[i].slope;
      weight += lines[i].weight;
      if (line.rho == 0.0F) line.rho = lines[i].rho;
    }
  line.slope = weight > 0.0F ? line.slope / weight : 0.0F;
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco::ground
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco::ground {

HWY_EXPORT(agreedHeight);
HWY_EXPORT(findLine);

AgreedHeight lowestAgreed(const ColumnLine* lines, std::size_t size, float window, float enough) {
  return HWY_DYNAMIC_DISPATCH(agreedHeight)(lines, size, window, enough);
}

void ColumnLineFinder::begin(const Setting& setting, std::size_t lasers) {
  setting_ = setting;
  for (auto* values : {&returns_.rho, &returns_.height, &returns_.x, &returns_.y})
    values->resize(std::max(values->size(), lasers));
  for (auto* values : {&returns_.bins, &returns_.levels}) values->resize(std::max(values->size(), lasers));
  returns_.lowest.resize(std::max(returns_.lowest.size(), lasers));
}

bool ColumnLineFinder::find(const Block& block, const Columns& columns, std::size_t first, std::size_t column,
                            ColumnLine& line) {
  return HWY_DYNAMIC_DISPATCH(findLine)(block, columns, first, column, setting_, returns_, line);
}

}  // namespace lisco::ground
#endif
