// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <random>

namespace lisco_simulation {

/// Random numbers of 53 bits, the same on every machine, unlike those of the standard distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// 0 <= number < 1
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  bool chance(double probability) { return unit() < probability; }

 private:
  std::mt19937_64 engine_;
};

/// Random numbers of one cell, determined by the seed, the cell and their purpose, in any order of cells (SplitMix64).
class CellRandom {
 public:
  CellRandom(std::uint64_t seed, std::uint64_t cell, std::uint64_t purpose)
      : state_(mixed(mixed(mixed(seed) + cell) + purpose)) {}

  std::uint64_t bits() { return mixed(state_ += 0x9E3779B97F4A7C15U); }

  /// 0 <= number < 1
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// Mean 0, standard deviation 1, within +-6, the same on every machine: the sum of twelve numbers of 16 bits.
  double gaussian() {
    std::uint64_t sum = 0;
    for (int word = 0; word < 3; ++word)
      for (std::uint64_t rest = bits(), part = 0; part < 4; ++part, rest >>= 16) sum += rest & 0xFFFFU;
    return (static_cast<double>(sum) + 6) * 0x1p-16 - 6;
  }

 private:
  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31);
  }

  std::uint64_t state_;
};

}  // namespace lisco_simulation
