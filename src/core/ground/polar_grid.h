// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lisco::ground {

inline constexpr std::size_t kSectors = 256;  ///< of azimuth
/// Of distance, eight for each octave of the squared distance: each is 4 % wider than the one before.
inline constexpr std::size_t kBins = 192;

/// What the returns in a cell of the polar grid show. Heights are metres above the sensor's horizon.
struct Cell {
  float low;             ///< lowest height
  float low_rho;         ///< its horizontal distance from the sensor, metres
  std::uint64_t levels;  ///< occupied heights: bit i for level i modulo 64
  float ground;          ///< height of the ground at low_rho
  float slope;           ///< of the ground there, metres per metre outwards
  bool observed;         ///< whether the lowest return is on the ground
};

/// The cells of one azimuth, from the sensor outwards.
struct Sector {
  std::array<Cell, kBins> cells;
  std::array<std::uint64_t, kBins / 64> occupied{};  ///< the cells with returns; the others are not initialized
  std::uint64_t block = 0;                           ///< the last one that added returns, from 1 on; 0: none

  bool has(std::size_t bin) const { return (occupied[bin / 64] >> (bin % 64) & 1) != 0; }
};

}  // namespace lisco::ground
