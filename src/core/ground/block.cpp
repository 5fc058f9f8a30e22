// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/block.h"

#include <array>
#include <cmath>
#include <cstring>

#include "core/ground/polar_grid.h"
#include "core/pi.h"

namespace lisco::ground {
namespace {

/// Beyond, coordinates are no measurements.
constexpr float kMaxCoordinate = 1e6F;

/// Of an azimuth, 0 to 8 for a turn, within 0.005 of proportional to the angle.
inline float octants(float x, float y) {
  const float ax = std::fabs(x);
  const float ay = std::fabs(y);
  const float most = ax > ay ? ax : ay;
  const float least = ax > ay ? ay : ax;
  const float ratio = least / (most + 1e-30F);
  float angle = ratio * (1.2732F - 0.2732F * ratio);
  angle = ay > ax ? 2.0F - angle : angle;
  angle = x < 0.0F ? 4.0F - angle : angle;
  return y < 0.0F ? 8.0F - angle : angle;
}

/// Octaves of the squared distance, divided into eight: the exponent and three bits of the mantissa.
inline std::int32_t logBinOf(float squared) {
  constexpr std::int32_t kFirst = (127 - 2) << 3;  // 0.25 m2
  std::int32_t bits;
  std::memcpy(&bits, &squared, sizeof bits);
  const std::int32_t bin = (bits >> 20) - kFirst;
  const std::int32_t most = static_cast<std::int32_t>(kBins) - 1;
  return bin < 0 ? 0 : bin > most ? most : bin;
}

}  // namespace

Direction directionOf(std::size_t sector) {
  static const auto directions = [] {
    std::array<Direction, kSectors> all;
    for (std::size_t i = 0; i < kSectors; ++i) {
      const double azimuth = 2.0 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(kSectors);
      all[i] = {static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth))};
    }
    return all;
  }();
  return directions[sector];
}

void Block::resize(std::size_t lasers) {
  size = lasers * kColumns;
  if (x.size() >= size) return;
  for (auto* values : {&x, &y, &z, &rho, &height}) values->resize(size);
  cell.resize(size);
  ground.resize(size);
}

void Block::measure(const SensorHints& sensor) {
  const float ox = sensor.origin[0], oy = sensor.origin[1], oz = sensor.origin[2];
  const float tilt_x = sensor.tilt[0], tilt_y = sensor.tilt[1];
  constexpr float kScale = static_cast<float>(kSectors) / 8.0F;
  constexpr std::int32_t kMask = static_cast<std::int32_t>(kSectors) - 1;
  const float* const px = x.data();
  const float* const py = y.data();
  const float* const pz = z.data();
  float* const to_rho = rho.data();
  float* const to_height = height.data();
  std::int32_t* const to_cell = cell.data();
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = px[i] - ox;
    const float dy = py[i] - oy;
    const float dz = pz[i] - oz;
    // NaN fails all comparisons; (0, 0, 0) is no return.
    const bool zero = (px[i] == 0.0F) & (py[i] == 0.0F) & (pz[i] == 0.0F);
    const bool valid =
        (std::fabs(dx) < kMaxCoordinate) & (std::fabs(dy) < kMaxCoordinate) & (std::fabs(dz) < kMaxCoordinate) & !zero;
    const float x_valid = valid ? dx : 0.0F;
    const float y_valid = valid ? dy : 0.0F;
    const float squared = x_valid * x_valid + y_valid * y_valid;
    const std::int32_t sector = static_cast<std::int32_t>(octants(x_valid, y_valid) * kScale) & kMask;
    to_rho[i] = std::sqrt(squared);
    to_height[i] = dz - tilt_x * x_valid - tilt_y * y_valid;
    to_cell[i] = valid ? sector << 8 | logBinOf(squared) : kNoCell;
  }
}

}  // namespace lisco::ground
