// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/bits.h"

namespace lisco::ground {

inline constexpr std::size_t kBins = 192;  ///< of distance, see distance_bins.h

/// What the returns in a bin of a column show. Heights are metres above the sensor's horizon.
struct Cell {
  /// Of the lowest return, so that a return below it has a lower number: its height (see orderedBits) in the upper
  /// half, its horizontal distance from the sensor in the lower half.
  std::uint64_t lowest;
  std::uint64_t levels;  ///< occupied heights: bit i for level i modulo 64

  float low() const;  ///< lowest height
  float lowRho() const {
    const auto bits = static_cast<std::uint32_t>(lowest);
    float rho;
    std::memcpy(&rho, &bits, sizeof rho);
    return rho;
  }
};

/// The bits of a number as an integer of the same order; -0 is below 0.
inline std::uint32_t orderedBits(float number) {
  std::uint32_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  return bits ^ ((bits >> 31) * 0x7FFFFFFFU | 0x80000000U);
}

inline float Cell::low() const {
  const auto ordered = static_cast<std::uint32_t>(lowest >> 32);
  const std::uint32_t bits = ordered ^ ((~ordered >> 31) * 0x7FFFFFFFU | 0x80000000U);
  float height;
  std::memcpy(&height, &bits, sizeof height);
  return height;
}

/// Cell::lowest
inline std::uint64_t lowestOf(float rho, float height) {
  std::uint32_t bits;
  std::memcpy(&bits, &rho, sizeof bits);
  return std::uint64_t{orderedBits(height)} << 32 | bits;
}

inline constexpr float kLevelsPerMetre = 4.0F;  ///< of height

/// Number of the level of a height, modulo 64.
inline unsigned levelOf(float height) {
  const float levels = height * kLevelsPerMetre;
  const auto towards_zero = static_cast<std::int32_t>(levels);
  return static_cast<unsigned>((towards_zero - (static_cast<float>(towards_zero) > levels ? 1 : 0)) & 63);
}

/// The returns of a column by distance, from the sensor outwards.
struct ColumnProfile {
  std::array<Cell, kBins> cells;
  std::array<std::uint64_t, kBins / 64> occupied{};  ///< bit i: cell i has returns; only then it has a value

  bool has(std::size_t bin) const { return (occupied[bin / 64] >> (bin % 64) & 1) != 0; }

  /// \param bin distanceBin of the return
  /// \param lowest of the cell, if it holds this return only
  /// \param level of the return's height, see levelOf
  void add(std::size_t bin, std::uint64_t lowest, unsigned level) {
    Cell& cell = cells[bin];
    const std::uint64_t levels = std::uint64_t{1} << level, bit = std::uint64_t{1} << (bin % 64);
    std::uint64_t& word = occupied[bin / 64];
    const bool is_new = (word & bit) == 0;
    cell.lowest = is_new || lowest < cell.lowest ? lowest : cell.lowest;
    cell.levels = is_new ? levels : cell.levels | levels;
    word |= bit;
  }
};

/// Calls visit(bin) for each bin with returns, from the sensor outwards.
template <typename Visit>
void forEachBin(const ColumnProfile& profile, Visit&& visit) {
  for (std::size_t word = 0; word < profile.occupied.size(); ++word)
    forEachBit(profile.occupied[word], [&](std::size_t bit) { visit(word * 64 + bit); });
}

/// Whether no level from the second to the eighth above a height, about 0.4 to 2.1 m, is occupied. Levels repeat every
/// 16 m.
inline bool isBare(float low, std::uint64_t levels) {
  constexpr std::uint64_t kAbove = 0x7F;  // levels
  const unsigned level = levelOf(low);
  const std::uint64_t turned = levels >> level | levels << (-level & 63);
  return (turned >> 2 & kAbove) == 0;
}

}  // namespace lisco::ground
