// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "simulation/random.h"

namespace lisco_simulation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Terrain hill(double slope, unsigned seed) {
  Random random(seed);
  constexpr double kAlong = 2 * kPi / 90;
  constexpr double kAcross = 2 * kPi / 60;
  // The two slopes add up to the given one where both waves are steepest.
  const double along = random.between(-kPi, kPi);
  const double across = random.between(-kPi, kPi);
  const double rise = std::tan(slope);
  return Terrain::ofWaves({{0.8 * rise / kAlong, kAlong, 0, along}, {0.6 * rise / kAcross, 0, kAcross, across}});
}

Terrain road() {
  constexpr double kFall = 0.025 * kRoadHalfWidth;
  constexpr double kKerb = 0.12;
  constexpr double kKerbFace = 0.02;  // its width
  constexpr double kPavement = 3;
  constexpr double kPavementRise = 0.06;
  constexpr double kBank = 6;
  constexpr double kBankRise = 0.6;
  std::vector<Terrain::Knot> right;  // by the distance from the middle
  double away = 0;
  double z = kFall;
  const auto add = [&](double width, double rise) { right.push_back({away += width, z += rise}); };
  add(kRoadHalfWidth, -kFall);
  add(kKerbFace, kKerb);
  add(kPavement, kPavementRise);
  add(kBank, kBankRise);
  add(1, 0);
  std::vector<Terrain::Knot> knots = {{kRoadMiddle, kFall}};
  for (const Terrain::Knot& knot : right) {
    knots.insert(knots.begin(), {kRoadMiddle - knot.at, knot.z});
    knots.push_back({kRoadMiddle + knot.at, knot.z});
  }
  return Terrain::along({0, 1, 0}, std::move(knots));
}

Terrain ramp(double slope) {
  constexpr double kFlat = 12;
  constexpr double kUp = 3;
  constexpr double kDown = 2;
  const double rise = std::max(std::tan(slope), 1e-6);
  const double bottom = -kFlat - kDown / rise;
  const double top = kFlat + kUp / rise;
  return Terrain::along({1, 0, 0},
                        {{bottom - 1, -kDown}, {bottom, -kDown}, {-kFlat, 0}, {kFlat, 0}, {top, kUp}, {top + 1, kUp}});
}

Terrain field(unsigned seed) {
  struct Size {
    double length, amplitude;
  };
  std::vector<Terrain::Wave> waves;
  Random random(seed);
  for (const Size& size : {Size{30, 0.35}, {13, 0.14}, {6, 0.05}, {2, 0.012}})
    for (int wave = 0; wave < 2; ++wave) {
      const double direction = random.between(-kPi, kPi);
      const double phase = random.between(-kPi, kPi);
      const double k = 2 * kPi / size.length;
      waves.push_back({size.amplitude, k * std::cos(direction), k * std::sin(direction), phase});
    }
  return Terrain::ofWaves(std::move(waves));
}

struct Kind {
  const char* name;
  const char* description;
  bool has_slope;
  Terrain (*make)(double slope, unsigned seed);
};

const Kind kKinds[] = {
    {"plane", "flat ground", false, [](double, unsigned) { return Terrain(); }},
    {"slope", "ground that rises ahead by --slope everywhere", true,
     [](double slope, unsigned) {
       return Terrain::along({1, 0, 0}, {{-1, -std::tan(slope)}, {1, std::tan(slope)}});
     }},
    {"hill", "hills and valleys, nowhere steeper than --slope", true, hill},
    {"road", "a crowned road with kerbs, pavements and banks", false, [](double, unsigned) { return road(); }},
    {"ramp", "a ramp of --slope up ahead and one down behind", true,
     [](double slope, unsigned) { return ramp(slope); }},
    {"field", "an uneven field", false, [](double, unsigned seed) { return field(seed); }},
};

const Kind& kindOf(const std::string& name) {
  for (const Kind& kind : kKinds)
    if (name == kind.name) return kind;
  throw std::invalid_argument("no terrain is called '" + name + "'");
}

}  // namespace

Terrain::Terrain(double z) : axis_{1, 0, 0}, knots_{{0, z}} {}

Terrain Terrain::along(const Vector& axis, std::vector<Knot> knots) {
  Terrain terrain;
  terrain.axis_ = axis;
  terrain.knots_ = std::move(knots);
  return terrain;
}

Terrain Terrain::ofWaves(std::vector<Wave> waves) {
  Terrain terrain;
  terrain.knots_.clear();
  terrain.waves_ = std::move(waves);
  for (const Wave& wave : terrain.waves_) {
    terrain.steepest_ += std::fabs(wave.amplitude) * std::hypot(wave.kx, wave.ky);
    terrain.highest_ += std::fabs(wave.amplitude);
  }
  return terrain;
}

double Terrain::height(double x, double y) const {
  double z = 0;
  for (const Wave& wave : waves_) z += wave.amplitude * std::sin(wave.kx * x + wave.ky * y + wave.phase);
  if (knots_.empty()) return z;
  if (knots_.size() == 1) return knots_.front().z;
  const double at = axis_.x * x + axis_.y * y;
  std::size_t next = 1;
  while (next + 1 < knots_.size() && knots_[next].at < at) ++next;
  const Knot& from = knots_[next - 1];
  const Knot& to = knots_[next];
  return from.z + (to.z - from.z) * (at - from.at) / (to.at - from.at);
}

double Terrain::rangeAlong(const Vector& from, const Vector& direction, double max_range) const {
  if (!waves_.empty()) return alongWaves(from, direction, max_range);
  if (knots_.size() == 1) return direction.z < 0 ? (knots_.front().z - from.z) / direction.z : kInfinity;
  return alongKnots(from, direction);
}

double Terrain::alongKnots(const Vector& from, const Vector& direction) const {
  // The height of the ray above the ground is linear from knot to knot.
  const double start = axis_.x * from.x + axis_.y * from.y;
  const double pace = axis_.x * direction.x + axis_.y * direction.y;
  double range = 0;
  double gap = from.z - height(from.x, from.y);
  if (gap <= 0) return 0;
  const std::size_t count = knots_.size();
  for (std::size_t i = 0; pace != 0 && i < count; ++i) {
    const Knot& knot = knots_[pace > 0 ? i : count - 1 - i];
    const double at = (knot.at - start) / pace;
    if (at <= range) continue;
    const double gap_there = from.z + at * direction.z - knot.z;
    if (gap_there <= 0) return range + (at - range) * gap / (gap - gap_there);
    range = at;
    gap = gap_there;
  }
  const Knot& last = pace > 0 ? knots_[count - 1] : knots_[0];
  const Knot& before = pace > 0 ? knots_[count - 2] : knots_[1];
  const double closing = pace * (last.z - before.z) / (last.at - before.at) - direction.z;
  return closing > 0 ? range + gap / closing : kInfinity;
}

double Terrain::alongWaves(const Vector& from, const Vector& direction, double max_range) const {
  constexpr double kMinStep = 0.01;  // metres
  const double horizontal = std::hypot(direction.x, direction.y);
  const double closing = steepest_ * horizontal - direction.z;  // metres of gap per metre of range at most
  if (closing <= 0) return kInfinity;
  const auto gapAt = [&](double range) {
    const Vector place = from + range * direction;
    return place.z - height(place.x, place.y);
  };
  double above = 0;
  double range = 0;
  if (from.z > highest_) range = direction.z < 0 ? (highest_ - from.z) / direction.z : kInfinity;
  while (range <= max_range) {
    const double gap = gapAt(range);
    if (gap > 0) {
      above = range;
      range += std::max(gap / closing, kMinStep);
      if (direction.z >= 0 && from.z + range * direction.z > highest_) return kInfinity;
      continue;
    }
    double below = range;
    while (below - above > 1e-6) {
      const double middle = (above + below) / 2;
      (gapAt(middle) > 0 ? above : below) = middle;
    }
    return below;
  }
  return kInfinity;
}

std::vector<std::string> terrainNames() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

std::string describeTerrain(const std::string& name) {
  return kindOf(name).description;
}

bool terrainHasSlope(const std::string& name) {
  return kindOf(name).has_slope;
}

Terrain makeTerrain(const std::string& name, double slope, unsigned seed) {
  return kindOf(name).make(slope, seed);
}

}  // namespace lisco_simulation
