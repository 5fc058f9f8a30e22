// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/sensor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lisco_simulation {
namespace {

constexpr double kDegree = kPi / 180;

/// A sensor with its own numbers of lasers and steps.
struct Model {
  const char* name;
  std::size_t steps;
  std::vector<double> (*elevations)();        ///< degrees, from top to bottom
  std::vector<double> repeated_stagger = {};  ///< of successive lasers, degrees, repeated
  /// Part of a step in which all lasers fire one after the other; 0: all fire at once.
  double firing_share = 0;
};

std::vector<double> evenly(double top, double bottom, std::size_t lasers) {
  std::vector<double> elevations(lasers);
  for (std::size_t laser = 0; laser < lasers; ++laser)
    elevations[laser] = top + (bottom - top) * static_cast<double>(laser) / static_cast<double>(lasers - 1);
  return elevations;
}

std::vector<double> upperAndLowerBlock() {
  std::vector<double> elevations;
  for (int laser = 0; laser < 32; ++laser) elevations.push_back(2 - laser / 3.0);
  for (int laser = 0; laser < 32; ++laser) elevations.push_back(-8.0 - 5.0 / 6 - laser / 2.0);
  return elevations;
}

/// The factor by which each of `gaps` gaps must exceed the one before, the first of them `first`, to add up to `span`.
double growth(double first, int gaps, double span) {
  double lo = 1;
  double hi = 10;
  for (int halving = 0; halving < 60; ++halving) {
    const double factor = (lo + hi) / 2;
    double sum = 0;
    double gap = first;
    for (int i = 0; i < gaps; ++i) sum += gap *= factor;
    (sum < span ? lo : hi) = factor;
  }
  return lo;
}

std::vector<double> denseAroundTheHorizon() {
  constexpr double kGap = 0.11;
  constexpr int kDenseGaps = 102;
  constexpr int kUpperGaps = 12;
  constexpr int kLowerGaps = 13;
  constexpr double kDenseTop = 4.8;
  constexpr double kDenseBottom = kDenseTop - kDenseGaps * kGap;
  std::vector<double> elevations;
  for (int i = 0; i <= kDenseGaps; ++i) elevations.push_back(kDenseTop - i * kGap);
  const auto extend = [&elevations](double from, double to, int gaps) {
    const double factor = growth(kGap, gaps, std::fabs(to - from));
    double gap = to > from ? kGap : -kGap;
    for (int i = 0; i < gaps; ++i) elevations.push_back(from += gap *= factor);
    elevations.back() = to;  // but for rounding, it is
  };
  extend(kDenseTop, 15, kUpperGaps);
  extend(kDenseBottom, -25, kLowerGaps);
  std::sort(elevations.rbegin(), elevations.rend());
  return elevations;
}

const std::vector<Model>& models() {
  static const std::vector<Model> kModels = {
      {"hdl64e", 1125, upperAndLowerBlock},
      // 32 firings 1.152 us apart in a cycle of 46.08 us
      {"hdl32e", 2170, [] { return evenly(32.0 / 3, -92.0 / 3, 32); }, {}, 32 * 1.152 / 46.08},
      // 16 firings 2.304 us apart in a cycle of 55.296 us
      {"vlp16", 1808, [] { return evenly(15, -15, 16); }, {}, 16 * 2.304 / 55.296},
      {"vls128", 1808, denseAroundTheHorizon, {-6.354, -4.548, -2.732, -0.911, 0.911, 2.732, 4.548, 6.354}},
      {"os1-128", 1024, [] { return evenly(22.5, -22.5, 128); }, {4.23, 1.41, -1.41, -4.23}},
  };
  return kModels;
}

/// A profile with another number of lasers between the same ends.
std::vector<double> resampled(const std::vector<double>& profile, std::size_t lasers) {
  std::vector<double> elevations(lasers);
  const auto last = static_cast<double>(profile.size() - 1);
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    const double position = lasers > 1 ? last * static_cast<double>(laser) / static_cast<double>(lasers - 1) : last / 2;
    const auto above = std::min(static_cast<std::size_t>(position), profile.size() - 2);
    const double share = position - static_cast<double>(above);
    elevations[laser] = (1 - share) * profile[above] + share * profile[above + 1];
  }
  return elevations;
}

/// Rank of a laser in the order of firing: the lowest, the lowest of the upper half, the second lowest, and so on.
double firing(std::size_t laser, std::size_t lasers) {
  const std::size_t from_below = lasers - 1 - laser;
  const std::size_t half = (lasers + 1) / 2;
  return static_cast<double>(from_below < half ? 2 * from_below : 2 * (from_below - half) + 1);
}

}  // namespace

double Sensor::azimuth(std::size_t laser, std::size_t step) const {
  return kPi - 2 * kPi * static_cast<double>(step) / static_cast<double>(steps) - stagger[laser];
}

Vector Sensor::direction(std::size_t laser, std::size_t step) const {
  const double horizontal = std::cos(elevation[laser]);
  const double angle = azimuth(laser, step);
  return {horizontal * std::cos(angle), horizontal * std::sin(angle), std::sin(elevation[laser])};
}

std::vector<std::string> simulatedSensors() {
  std::vector<std::string> names;
  for (const Model& model : models()) names.emplace_back(model.name);
  return names;
}

Sensor makeSensor(const std::string& name, std::size_t lasers, std::size_t steps) {
  const auto model =
      std::find_if(models().begin(), models().end(), [&name](const Model& each) { return each.name == name; });
  if (model == models().end()) throw std::invalid_argument("no sensor is called '" + name + "'");
  Sensor sensor;
  sensor.name = name;
  sensor.steps = steps != 0 ? steps : model->steps;
  const std::vector<double> profile = model->elevations();
  sensor.elevation = lasers == 0 || lasers == profile.size() ? profile : resampled(profile, lasers);
  const double step = 2 * kPi / static_cast<double>(sensor.steps);
  for (std::size_t laser = 0; laser < sensor.lasers(); ++laser) {
    sensor.elevation[laser] *= kDegree;
    const auto& repeated = model->repeated_stagger;
    double stagger = repeated.empty() ? 0 : repeated[laser % repeated.size()] * kDegree;
    stagger += model->firing_share * step * firing(laser, sensor.lasers()) / static_cast<double>(sensor.lasers());
    sensor.stagger.push_back(stagger);
  }
  return sensor;
}

}  // namespace lisco_simulation
