// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace lisco_apps {

double median(std::vector<double> values);
/// The value below which a share of the values lies, interpolated between the two nearest ones. \param share 0 to 1
double quantile(std::vector<double> values, double share);

/// Times of one rival, milliseconds.
struct Times {
  std::vector<double> runs;
  std::vector<double> cold;  ///< the run before each, which found its memory displaced; the same run if it was long

  double mean() const;
  double least() const;
  double most() const;
  /// Half the width of the mean's confidence interval of 99% (Student's t); NaN for fewer than two runs.
  double confidence99() const;
};

/// What is to be timed: a rival's run, how long one took when it was tried, and how many are wanted.
struct Contestant {
  std::function<void()> run;
  double tried_ms = 0;
  std::size_t runs = 0;
};

/// Times contestants in turn, round by round, so that what disturbs the machine disturbs all; those with fewer runs sit
/// out some rounds, evenly spread. A short run is done twice in each round, of which the second counts: the first, the
/// cold one, brings back the memory that the others have displaced from the caches.
/// \param between called before each round with its number and that of all rounds
std::vector<Times> timeInTurn(const std::vector<Contestant>& contestants,
                              const std::function<void(std::size_t round, std::size_t rounds)>& between);

/// Milliseconds that a call takes.
double millisecondsOf(const std::function<void()>& run);

/// A mean of ratios, for which twice as fast and half as fast cancel out.
double geometricMean(const std::vector<double>& values);

}  // namespace lisco_apps
