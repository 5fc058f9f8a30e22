// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/view_mask.h"

namespace lisco {
namespace {

// A tile's width in units of what the tolerance is seen under from the near end of its layer. Measured: see
// doc/algorithm.md.
constexpr double kTileWidth = 2.0;
constexpr double kFirstRange = 2.0;  // near end of layer 1 in units of the tolerance
constexpr std::uint32_t kLeastSlots = 1024;
constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kBatch = 16;

}  // namespace

void ViewMask::prepare(const Tolerance& tolerance, const ViewHints& hints, std::size_t expected_returns) {
  origin_ = hints.origin;
  reach_ = tolerance.reach();
  layers_.clear();
  rows_.clear();
  std::size_t tile_count = 0;

  const double first_range = kFirstRange * std::max(reach_, 1e-22);
  per_first_range_ = 1.0 / first_range;
  const double most_sectors = std::clamp(
      2.0 * kPi / (kColumnsPerTile * std::max(1e-6, static_cast<double>(hints.azimuth_step))), 4.0, kMostSectors);
  const double most_rows =
      std::clamp(kPi / (kLasersPerTile * std::max(1e-6, static_cast<double>(hints.elevation_step))), 2.0, kMostRows);

  float near_end = 0.0F;
  double width = kTileWidth / kFirstRange;                                       // radians
  for (bool finest = false; !finest; width *= layers_.size() > 1 ? 0.5 : 1.0) {  // layer 0 is as coarse as 1
    const double sectors = std::clamp(std::floor(2.0 * kPi / width), 4.0, most_sectors);
    const double rows = std::floor(std::clamp(kPi / width, 2.0, most_rows));
    finest = layers_.size() > 1 && 2.0 * kPi / width >= most_sectors && kPi / width >= most_rows;
    layers_.push_back({near_end, static_cast<std::uint32_t>(rows_.size()), static_cast<float>(rows)});
    near_end = near_end > 0.0F ? 2.0F * near_end : 1.0F;
    for (int r = 0; r < static_cast<int>(rows); ++r) {
      const double nearer = std::min(std::fabs(r / rows - 0.5), std::fabs((r + 1) / rows - 0.5));
      const double in_row = std::max(1.0, std::floor(sectors * std::cos(nearer * kPi)));
      rows_.push_back({static_cast<std::uint32_t>(tile_count), static_cast<float>(in_row)});
      tile_count += static_cast<std::size_t>(in_row);
    }
  }
  // Most tiles are never seen: a table with a place for every fourth return is as fast as one for every tile.
  std::uint32_t slots = kLeastSlots;
  while (slots < tile_count && slots < expected_returns / 4) slots *= 2;
  tile_mask_ = slots - 1;
  last_layer_ = static_cast<int>(layers_.size()) - 1;
}

void ViewMask::tilesOf(const float* x, const float* y, const float* z, std::size_t count, std::uint32_t* tiles) const {
  const auto per_first_range = static_cast<float>(std::min(per_first_range_, 1e38));
  float azimuth[kBatch];
  float elevation[kBatch];
  float ranges[kBatch];  // in units of the first range
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const std::size_t n = std::min(kBatch, count - begin);
    for (std::size_t i = 0; i < n; ++i) {
      const float px = x[begin + i] - origin_[0];
      const float py = y[begin + i] - origin_[1];
      const float pz = z[begin + i] - origin_[2];
      // Scaled by the largest coordinate, no square over- or underflows.
      const float largest = std::max(std::max(std::fabs(px), std::fabs(py)), std::fabs(pz));
      const float scale = 1.0F / std::min(std::max(largest, 1.2e-38F), 8e37F);
      const float u = px * scale;
      const float v = py * scale;
      const float w = pz * scale;
      const float rho = std::sqrt(u * u + v * v);
      ranges[i] = std::sqrt(rho * rho + w * w) * (per_first_range / scale);
      azimuth[i] = view_angle::azimuth(px, py);
      elevation[i] = view_angle::elevation(rho, w);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Layer& layer = layers_[static_cast<std::size_t>(layerOf(ranges[i]))];
      const float r = std::min(elevation[i] * layer.rows, layer.rows - 1.0F);
      const Row row = rows_[layer.first_row + static_cast<std::uint32_t>(r)];
      const float sector = std::min(azimuth[i] * row.sectors, row.sectors - 1.0F);
      tiles[begin + i] = slotOf(row.first_tile + static_cast<std::uint32_t>(sector), sliceOf(ranges[i]));
    }
  }
}

}  // namespace lisco
