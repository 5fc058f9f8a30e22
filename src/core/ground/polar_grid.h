// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/bits.h"

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
  float tolerance;       ///< returns up to this far above the ground are on it
  /// 0: the lowest return is not on the ground; otherwise how many sectors may still follow this one's example
  std::int8_t confidence;
};

inline constexpr float kLevelsPerMetre = 4.0F;  ///< of height

/// Number of the level of a height, modulo 64.
inline unsigned levelOf(float height) {
  return static_cast<unsigned>(static_cast<std::int32_t>(std::floor(height * kLevelsPerMetre)) & 63);
}

/// The cells of one azimuth, from the sensor outwards.
struct Sector {
  std::array<Cell, kBins> cells;
  std::array<std::uint64_t, kBins / 64> occupied{};  ///< the cells with returns; the others are not initialized
  std::uint64_t block = 0;                           ///< the last one that added returns, from 1 on; 0: none

  bool has(std::size_t bin) const { return (occupied[bin / 64] >> (bin % 64) & 1) != 0; }

  /// \param levels of the returns, the lowest of which has this distance and height
  void add(std::size_t bin, float rho, float height, std::uint64_t levels) {
    std::uint64_t& word = occupied[bin / 64];
    const std::uint64_t bit = std::uint64_t{1} << (bin % 64);
    Cell& cell = cells[bin];
    const bool is_new = (word & bit) == 0;
    word |= bit;
    cell.levels = is_new ? levels : cell.levels | levels;
    if (is_new) cell.confidence = 0;  // until the sector is followed
    if (is_new || height < cell.low) {
      cell.low = height;
      cell.low_rho = rho;
    }
  }
};

/// A unit vector.
struct Direction {
  float x, y;
};

/// The middle of a sector.
Direction directionOf(std::size_t sector);

/// Calls visit(bin) for each cell with returns, from the sensor outwards.
template <typename Visit>
void forEachBin(const Sector& sector, Visit&& visit) {
  for (std::size_t word = 0; word < sector.occupied.size(); ++word)
    forEachBit(sector.occupied[word], [&](std::size_t bit) { visit(word * 64 + bit); });
}

/// Whether none of the occupied levels is up to about 2 m above a height.
inline bool isBare(float low, std::uint64_t levels) {
  constexpr std::uint64_t kAbove = 0x7F;  // levels
  const unsigned level = levelOf(low);
  const std::uint64_t turned = levels >> level | levels << (-level & 63);
  return (turned >> 2 & kAbove) == 0;
}

}  // namespace lisco::ground
