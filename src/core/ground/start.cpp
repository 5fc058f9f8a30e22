// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/start.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ground/polar_grid.h"

namespace lisco::ground {
namespace {

constexpr float kNear = 25.0F;          // metres; beyond, the ground may be higher or lower
constexpr std::size_t kMostCells = 48;  // of a column
constexpr int kMinAgreeing = 2;         // cells
constexpr float kMinReach = 1.15F;      // of the farthest of them by the nearest
constexpr float kEnough = 0.5F;         // of the most votes

}  // namespace

void StartEstimator::add(const Block& block, std::size_t column, float max_slope) {
  struct Low {
    float rho, height;
  };
  Sector sector;  // of all azimuths: lasers of a column may be staggered
  for (std::size_t i = column; i < block.size; i += Block::kColumns)
    if (block.cell[i] != Block::kNoCell && block.rho[i] < kNear)
      sector.add(static_cast<std::size_t>(block.cell[i]) % kBins, block.rho[i], block.height[i]);
  std::array<Low, kMostCells> lows;
  std::size_t size = 0;
  forEachBin(sector, [&](std::size_t bin) {
    const Cell& cell = sector.cells[bin];
    if (size < kMostCells && cell.low < highest_ && isBare(cell)) lows[size++] = {cell.low_rho, cell.low};
  });
  std::array<int, kMostCells> agreeing{};
  int most = 0;
  for (std::size_t i = 0; i < size; ++i) {
    float farthest = 0.0F;
    for (std::size_t j = i; j < size; ++j) {
      const float distance = std::fabs(lows[j].rho - lows[i].rho);
      if (std::fabs(lows[j].height - lows[i].height) >= 0.03F + 0.2F * max_slope * distance) continue;
      ++agreeing[i];
      farthest = lows[j].rho;
    }
    if (farthest < kMinReach * lows[i].rho) agreeing[i] = 0;
    most = std::max(most, agreeing[i]);
  }
  if (most < kMinAgreeing) return;
  Vote vote{std::numeric_limits<float>::infinity(), 0.0F};
  for (std::size_t i = 0; i < size; ++i)
    if (static_cast<float>(agreeing[i]) >= kEnough * static_cast<float>(most) && agreeing[i] >= kMinAgreeing &&
        lows[i].height < vote.height)
      vote = {lows[i].height, static_cast<float>(agreeing[i] - 1)};
  votes_[count_++ % kMemory] = vote;
}

float StartEstimator::estimate() const {
  constexpr float kWindow = 0.25F;  // metres
  const std::size_t size = std::min(count_, kMemory);
  std::array<float, kMemory> support{};
  float most = 0.0F;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j)
      if (std::fabs(votes_[i].height - votes_[j].height) < kWindow) support[i] += votes_[j].weight;
    most = std::max(most, support[i]);
  }
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < size; ++i)
    if (support[i] >= kEnough * most) lowest = std::min(lowest, votes_[i].height);
  float sum = 0.0F, weight = 0.0F;
  for (std::size_t i = 0; i < size; ++i)
    if (std::fabs(votes_[i].height - (lowest + kWindow)) < 2 * kWindow) {
      sum += votes_[i].weight * votes_[i].height;
      weight += votes_[i].weight;
    }
  constexpr float kMinWeight = 8.0F;
  return most >= kMinWeight ? sum / weight : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace lisco::ground
