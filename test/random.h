// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace lisco_test {

/// Reproducible random numbers: the same seed gives the same numbers on every machine, which the standard distributions
/// do not guarantee.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// 0 <= number < 1
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  /// Each order of magnitude between lo and hi is equally likely.
  double magnitude(double lo, double hi) { return std::exp(between(std::log(lo), std::log(hi))); }
  bool chance(double probability) { return unit() < probability; }
  /// 0 <= number < count
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  template <typename Container>
  const auto& oneOf(const Container& choices) {
    return choices[below(choices.size())];
  }
  template <typename Container>
  void shuffle(Container& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace lisco_test
