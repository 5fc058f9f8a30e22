// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace lisco_apps {

/// The value below which a share (0 to 1) of the values lies, linearly interpolated.
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

/// Run times of one baseline, milliseconds.
struct Times {
  std::vector<double> runs;
  std::vector<double> cold;  ///< the run before each, with displaced caches; the same run if long

  double mean() const { return std::accumulate(runs.begin(), runs.end(), 0.0) / static_cast<double>(runs.size()); }
  double min() const { return *std::min_element(runs.begin(), runs.end()); }
  double max() const { return *std::max_element(runs.begin(), runs.end()); }
  /// Half the width of the mean's 99% confidence interval (Student's t); NaN for fewer than two runs.
  double confidence99() const;
};

/// Time that passes, or that this thread computes.
enum class TimeKind { kWall, kThread };

/// A run that takes less is repeated at once when it is timed, milliseconds.
inline constexpr double kMaxShort = 50;

/// Something to be timed.
struct Contestant {
  std::function<void()> run;
  double tried_ms = 0;   ///< duration of a trial run
  std::size_t runs = 0;  ///< to be timed
};

/// Times contestants in turn, round by round, so that disturbances of the machine are shared. Contestants with fewer
/// runs skip rounds, evenly spread. A short run is repeated at once, and the repetition counts: the first, cold run
/// refills the caches that the others have displaced.
/// \param kind what is timed; kThread leaves out what other programs take from a busy machine, and other threads
/// \param between called before each round with its number and the number of rounds
std::vector<Times> timeInTurn(const std::vector<Contestant>& contestants, TimeKind kind,
                              const std::function<void(std::size_t round, std::size_t rounds)>& between);

/// Times contestants of different numbers of threads in turn. Each has a spell at a time: a pause in which its threads
/// fall asleep, a run (Times::cold), then runs for a quarter of a second, of which the last ones are timed. Those of
/// the fastest spell are returned: virtual machines may run two processors on one core, for tenths of a second at
/// least.
std::vector<Times> timeInSpells(const std::vector<std::function<void()>>& contestants, std::size_t spells);

/// Duration of one run, milliseconds.
double runMs(const std::function<void()>& run, TimeKind kind = TimeKind::kWall);

/// The mean of ratios: twice as fast and half as fast cancel out.
double geometricMean(const std::vector<double>& values);

}  // namespace lisco_apps
