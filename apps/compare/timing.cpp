// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/timing.h"

#include <time.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include <boost/math/distributions/students_t.hpp>

namespace lisco_apps {

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), values.size() - 1);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

double Times::confidence99() const {
  if (runs.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const auto n = static_cast<double>(runs.size());
  const double center = mean();
  double squares = 0;
  for (const double run : runs) squares += (run - center) * (run - center);
  constexpr double kBothTails = 0.01;
  const double t = boost::math::quantile(boost::math::students_t(n - 1), 1 - kBothTails / 2);
  return t * std::sqrt(squares / (n - 1) / n);
}

double runMs(const std::function<void()>& run, TimeKind kind) {
  const auto now = [kind] {
    timespec time{};
    clock_gettime(kind == TimeKind::kThread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  run();
  return now() - start;
}

std::vector<Times> timeInTurn(const std::vector<Contestant>& contestants, TimeKind kind,
                              const std::function<void(std::size_t, std::size_t)>& between) {
  std::size_t rounds = 0;
  for (const Contestant& contestant : contestants) rounds = std::max(rounds, contestant.runs);
  std::vector<Times> times(contestants.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    between(round, rounds);
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const Contestant& contestant = contestants[i];
      if (round * contestant.runs / rounds == (round + 1) * contestant.runs / rounds) continue;
      times[i].cold.push_back(runMs(contestant.run, kind));
      times[i].runs.push_back(contestant.tried_ms < kMaxShort ? runMs(contestant.run, kind) : times[i].cold.back());
    }
  }
  return times;
}

std::vector<Times> timeInSpells(const std::vector<std::function<void()>>& contestants, std::size_t spells) {
  constexpr std::chrono::milliseconds kPause{20};  // OpenMP's threads spin for some milliseconds before they sleep
  constexpr double kBusyMs = 250;
  constexpr std::size_t kTimed = 5;  // runs
  std::vector<Times> times(contestants.size());
  for (std::size_t spell = 0; spell < spells; ++spell)
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      std::this_thread::sleep_for(kPause);
      times[i].cold.push_back(runMs(contestants[i]));
      for (double ms = 0; ms < kBusyMs;) ms += runMs(contestants[i]);
      std::vector<double> runs;
      for (std::size_t run = 0; run < kTimed; ++run) runs.push_back(runMs(contestants[i]));
      if (spell == 0 || median(runs) < median(times[i].runs)) times[i].runs = std::move(runs);
    }
  return times;
}

double geometricMean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

}  // namespace lisco_apps
