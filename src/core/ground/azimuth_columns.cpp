// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/azimuth_columns.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"
#include "core/radix_sort.h"

namespace lisco::ground {
namespace {

constexpr unsigned kBinBits = 11, kSlopeBits = 21, kPointBits = 32;  // of an item, from the highest one on
constexpr std::size_t kAzimuthBins = std::size_t{1} << kBinBits;     // of a turn, before they are widened
constexpr std::size_t kWidestBins = 64;                              // of a turn
constexpr std::size_t kMinRows = 16, kMaxRows = 1024;
constexpr float kMinLength = 1e-30F;  // metres; in place of 0

std::uint32_t slopeOf(std::uint64_t item) {
  return static_cast<std::uint32_t>(item >> kPointBits & ((std::uint64_t{1} << kSlopeBits) - 1));
}

/// atan2 within 1e-5 radians (Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.47), without branches.
float azimuthOf(float east, float north) {
  constexpr auto kHalfTurn = static_cast<float>(kPi);
  const float x = std::fabs(east), y = std::fabs(north);
  const float ratio = std::min(x, y) / std::max(std::max(x, y), kMinLength), squared = ratio * ratio;
  float angle = 0.0208351F;
  for (const float term : {-0.0851330F, 0.1801410F, -0.3302995F, 0.9998660F}) angle = angle * squared + term;
  angle *= ratio;
  angle = y > x ? 0.5F * kHalfTurn - angle : angle;
  angle = east < 0.0F ? kHalfTurn - angle : angle;
  return north < 0.0F ? -angle : angle;
}

}  // namespace

void AzimuthColumns::sort(const StridedPoints& points, std::size_t count, const std::array<float, 3>& origin) {
  measure(points, count, origin);
  const unsigned widened = widen();
  std::size_t taken = 0;  // bins
  for (const std::uint32_t size : sizes_) taken += size > 0 ? 1 : 0;
  // Columns are about as long as bins are on average, so that few cells stay empty. If all returns are in a few bins,
  // as those of a map far from the origin, a bin has many columns.
  rows_ = std::clamp(5 * items_.size() / (4 * std::max<std::size_t>(taken, 1)) + 1, kMinRows, kMaxRows);
  scratch_.resize(std::max(scratch_.size(), items_.size()));
  radixSort(items_.data(), scratch_.data(), items_.size(), kPointBits, kSlopeBits);
  lowest_.resize(rows_);
  for (std::size_t row = 0; row < rows_ && !items_.empty(); ++row)
    lowest_[row] = slopeOf(items_[row * items_.size() / rows_]);
  radixSort(items_.data(), scratch_.data(), items_.size(), kPointBits + kSlopeBits + widened, kBinBits - widened);
  fill();
}

/// Measures the returns, in their order, and counts those of each bin.
void AzimuthColumns::measure(const StridedPoints& points, std::size_t count, const std::array<float, 3>& origin) {
  constexpr std::size_t kTogether = 256;  // points, so that compilers make vectors of them
  constexpr auto kSlopes = static_cast<float>(std::size_t{1} << (kSlopeBits - 1));  // of rays upwards
  constexpr auto kBinsPerRadian = static_cast<float>(static_cast<double>(kAzimuthBins) / (2.0 * kPi));
  constexpr auto kLastBin = static_cast<float>(kAzimuthBins - 1);
  std::array<float, kTogether> east{}, north{}, up{}, slopes, bins;
  std::array<std::uint8_t, kTogether> is_return;
  sizes_.assign(kAzimuthBins, 0);
  items_.resize(count);
  std::size_t returns = 0;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t size = std::min(kTogether, count - first);
    for (std::size_t i = 0; i < size; ++i) {
      const Return point = points.at(first + i);
      is_return[i] = isReturn(point.x, point.y, point.z) ? 1 : 0;
      east[i] = point.x - origin[0];
      north[i] = point.y - origin[1];
      up[i] = point.z - origin[2];
    }
    for (std::size_t i = 0; i < kTogether; ++i) {
      const float rho = std::sqrt(east[i] * east[i] + north[i] * north[i]);
      const float slope = kSlopes * (1.0F + up[i] / (rho + std::fabs(up[i]) + kMinLength));
      slopes[i] = slope > 0.0F ? std::min(slope, 2.0F * kSlopes - 1.0F) : 0.0F;
      const float bin = (azimuthOf(east[i], north[i]) + static_cast<float>(kPi)) * kBinsPerRadian;
      bins[i] = bin > 0.0F ? std::min(bin, kLastBin) : 0.0F;
    }
    for (std::size_t i = 0; i < size; ++i) {
      const auto bin = static_cast<std::uint32_t>(bins[i]);
      const auto slope = static_cast<std::uint64_t>(slopes[i]);
      items_[returns] = (bin << kSlopeBits | slope) << kPointBits | (first + i);
      returns += is_return[i];
      sizes_[bin] += is_return[i];
    }
  }
  items_.resize(returns);
}

/// Joins pairs of bins until most of those with returns are followed by one: a bin narrower than the sensor's step
/// would be empty beside a bin of a whole column. \return how often
unsigned AzimuthColumns::widen() {
  unsigned widened = 0;
  for (; sizes_.size() > kWidestBins; ++widened) {
    std::size_t taken = 0, followed = 0;
    for (std::size_t bin = 0; bin < sizes_.size(); ++bin) {
      if (sizes_[bin] == 0) continue;
      ++taken;
      followed += sizes_[(bin + 1) % sizes_.size()] > 0 ? 1 : 0;
    }
    if (4 * followed >= 3 * taken) break;
    for (std::size_t bin = 0; bin < sizes_.size() / 2; ++bin) sizes_[bin] = sizes_[2 * bin] + sizes_[2 * bin + 1];
    sizes_.resize(sizes_.size() / 2);
  }
  return widened;
}

/// Puts the returns, sorted by bin and slope, into cells.
void AzimuthColumns::fill() {
  cells_.clear();
  const std::uint64_t* bin = items_.data();
  for (const std::size_t size : sizes_) {
    // A bin of many returns makes several columns, each of them with rays of all elevations.
    const std::size_t columns = (size + rows_ - 1) / rows_;
    for (std::size_t column = 0; column < columns; ++column) {
      cells_.resize(cells_.size() + rows_, kNone);
      std::uint32_t* const cells = &cells_[cells_.size() - rows_];
      std::size_t row = 0, free = 0;
      std::size_t left = (size - column + columns - 1) / columns;
      for (std::size_t i = column; i < size; i += columns) {
        while (row + 1 < rows_ && lowest_[row + 1] <= slopeOf(bin[i]) && lowest_[row] != slopeOf(bin[i])) ++row;
        free = std::min(std::max(free, row), rows_ - left--);
        cells[free++] = static_cast<std::uint32_t>(bin[i]);
      }
    }
    bin += size;
  }
}

}  // namespace lisco::ground
