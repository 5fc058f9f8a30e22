// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine.h"
#include "far_hints.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMinColumns = 256;

enum class Layout { kOrganized, kFirings, kRings, kShuffled };

struct Firing {
  std::size_t laser, column;
  Point point;
};

/// What a sensor sees of walls that are visible from some directions only.
class Simulation {
 public:
  explicit Simulation(Random& random) : random_(random) {
    constexpr std::array<int, 3> kSteps{512, 600, 1024};
    constexpr std::array<double, 6> kTurns{1.0, 1.0, 1.05, 2.0, 3.0, 0.55};
    constexpr std::array<double, 5> kJitters{0.0, 0.0, 0.05, 0.4, 1.5};
    steps_ = random.oneOf(kSteps);
    firings_ = static_cast<std::size_t>(steps_ * random.oneOf(kTurns));
    lasers_ = 1 + random.below(12);
    is_dual_ = random.chance(0.3);
    is_dual_by_lasers_ = random.chance(0.5);
    clockwise_ = random.chance(0.5);
    start_ = random.between(0, 2 * kPi);
    jitter_ = random.oneOf(kJitters);
    range_ = random.magnitude(0.5, 30);
    waviness_ = random.chance(0.5) ? 0.3 : 0.0;
    noise_ = random.chance(0.5) ? random.magnitude(1e-4, 0.3) : 0.0;
    ring_ = random.magnitude(0.003, 0.1);
    if (random.chance(0.3)) speed_ = {random.between(-3, 3), random.between(-3, 3), 0};
    is_on_map_ = random.chance(0.2);
    // Returns of all turns lie in the same directions.
    const double turns = std::ceil(static_cast<double>(firings_) / steps_) * (is_dual_ ? 2 : 1);
    const double returns = random.between(40, 400);
    arc_ = std::max<std::size_t>(1, static_cast<std::size_t>(returns / (turns * static_cast<double>(lasers_))));
    arcs_ = 1 + random.below(3);
  }

  std::size_t columns() const { return firings_ * (is_dual_ && !is_dual_by_lasers_ ? 2 : 1); }
  std::size_t lasers() const { return lasers_ * (is_dual_ && is_dual_by_lasers_ ? 2 : 1); }

  std::vector<Firing> fire() {
    std::vector<Firing> all;
    for (std::size_t i = 0; i < firings_; ++i) {
      const std::size_t direction = i % static_cast<std::size_t>(steps_);
      const std::size_t spacing = static_cast<std::size_t>(steps_) / arcs_;
      if (direction % spacing >= arc_ / arcs_ + 1) continue;
      for (std::size_t laser = 0; laser < lasers_; ++laser) {
        if (random_.chance(0.05)) continue;
        const Position sensor = sensorAt(i);
        const double turned = 2 * kPi / steps_ * (static_cast<double>(i) + jitter_ * random_.between(-1, 1));
        const double azimuth = start_ + (clockwise_ ? -turned : turned);
        const double rho = range_ * (1 + waviness_ * std::sin(5 * azimuth)) + noise_ * random_.between(-1, 1);
        all.push_back(returned(laser, i, false, sensor, azimuth, rho));
        if (is_dual_ && random_.chance(0.8))
          all.push_back(
              returned(laser, i, true, sensor, azimuth, random_.chance(0.3) ? rho : rho + random_.magnitude(0.05, 5)));
      }
    }
    return all;
  }

  lisco::SensorHints hints() const {
    lisco::SensorHints hints = hintsFor(steps_, 0.1F, clockwise_);
    hints.elevation_step = elevationStepFor(hints, random_.magnitude(1, 60));
    if (is_on_map_ && random_.chance(0.7)) hints.origin = {static_cast<float>(kMap[0]), static_cast<float>(kMap[1]), 0};
    if (random_.chance(0.3)) hints.roughness = static_cast<float>(random_.magnitude(0.01, 10));
    hints.jitter = static_cast<float>(jitter_);
    if (random_.chance(0.2)) hints.drift = static_cast<float>(random_.between(0, 5));
    return hints;
  }

 private:
  using Position = std::array<double, 3>;
  static constexpr Position kMap{5e5, 5.4e6, 0};

  Position sensorAt(std::size_t firing) const {
    Position at = is_on_map_ ? kMap : Position{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] += speed_[axis] * static_cast<double>(firing) / static_cast<double>(firings_);
    return at;
  }

  Firing returned(std::size_t laser, std::size_t firing, bool is_second, const Position& sensor, double azimuth,
                  double rho) const {
    const double slope = 0.1 - ring_ * static_cast<double>(laser);
    const bool as_laser = is_second && is_dual_by_lasers_;
    const bool as_column = is_second && !is_dual_by_lasers_;
    return {laser + (as_laser ? lasers_ : 0),
            (is_dual_ && !is_dual_by_lasers_ ? 2 * firing : firing) + (as_column ? 1 : 0),
            {static_cast<float>(sensor[0] + rho * std::cos(azimuth)),
             static_cast<float>(sensor[1] + rho * std::sin(azimuth)), static_cast<float>(sensor[2] + rho * slope)}};
  }

  Random& random_;
  int steps_ = 512;
  std::size_t firings_ = 512, lasers_ = 1;
  bool is_dual_ = false, is_dual_by_lasers_ = false, clockwise_ = false, is_on_map_ = false;
  double start_ = 0, jitter_ = 0, range_ = 1, waviness_ = 0, noise_ = 0, ring_ = 0.01;
  Position speed_{};
  std::size_t arc_ = 1, arcs_ = 1;
};

Scan arranged(Random& random, const Simulation& simulation, std::vector<Firing> firings, Layout layout) {
  if (layout == Layout::kOrganized) {
    Scan scan(simulation.columns(), simulation.lasers());
    for (const Firing& firing : firings) scan.set(firing.laser, firing.column, firing.point);
    return scan;
  }
  if (layout == Layout::kRings)
    std::stable_sort(firings.begin(), firings.end(),
                     [](const Firing& a, const Firing& b) { return a.laser < b.laser; });
  if (layout == Layout::kShuffled) random.shuffle(firings);
  Scan scan(firings.size(), 1);
  for (std::size_t i = 0; i < firings.size(); ++i) scan.set(0, i, firings[i].point);
  return scan;
}

}  // namespace

Recording randomRecording(Random& random) {
  constexpr std::array<Layout, 5> kLayouts{Layout::kOrganized, Layout::kOrganized, Layout::kFirings, Layout::kRings,
                                           Layout::kShuffled};
  Recording recording;
  Simulation simulation(random);
  recording.scan = arranged(random, simulation, simulation.fire(), random.oneOf(kLayouts));
  if (recording.scan.columns < kMinColumns) recording.scan = widened(random, recording.scan, kMinColumns);
  recording.tolerance =
      random.chance(0.3) ? criticalTolerance(random, recording.scan) : static_cast<float>(random.magnitude(0.03, 2));
  recording.hints = simulation.hints();
  if (random.chance(0.1)) recording.hints.clockwise = !recording.hints.clockwise;
  return recording;
}

}  // namespace lisco_test
