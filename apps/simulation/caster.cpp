// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/caster.h"

#include <algorithm>
#include <cmath>

#include "simulation/random.h"

namespace lisco_simulation {
namespace {

/// Purposes of a cell's random numbers; those from kForLeaves on are for one solid each.
enum Purpose : std::uint64_t { kForNoise, kForDropOut, kForLeaves };

}  // namespace

double Caster::sectorPosition(double azimuth) {
  const double turns = azimuth / (2 * kPi);
  return (turns - std::floor(turns)) * static_cast<double>(kSectors);
}

void Caster::add(const Solid& solid, std::uint32_t object) {
  constexpr double kMargin = 1e-6;  // metres, above any rounding error
  const auto index = static_cast<std::uint32_t>(solids_.size());
  solids_.push_back({&solid, object});
  const Vector& centre = solid.bounds().centre;
  const double radius = solid.bounds().radius + slack_ + kMargin;
  const double distance = length(centre);
  const double rho = std::hypot(centre.x, centre.y);
  Candidate candidate{std::max(0.0, distance - radius), -1, 1, index};
  if (radius < distance) {
    const double elevation = std::asin(centre.z / distance);
    const double reach = std::asin(radius / distance);
    if (elevation - reach > -kPi / 2) candidate.lowest = std::sin(elevation - reach) - kMargin;
    if (elevation + reach < kPi / 2) candidate.highest = std::sin(elevation + reach) + kMargin;
  }
  if (radius >= rho) {
    for (auto& sector : sectors_) sector.push_back(candidate);
    return;
  }
  const double reach = std::asin(radius / rho) + kMargin;
  const std::size_t first = sectorOf(std::atan2(centre.y, centre.x) - reach);
  const std::size_t last = sectorOf(std::atan2(centre.y, centre.x) + reach);
  for (std::size_t sector = first;; sector = (sector + 1) % kSectors) {
    sectors_[sector].push_back(candidate);
    if (sector == last) break;
  }
}

void Caster::sort() {
  for (auto& sector : sectors_)
    std::sort(sector.begin(), sector.end(), [](const Candidate& a, const Candidate& b) {
      return a.nearest != b.nearest ? a.nearest < b.nearest : a.solid < b.solid;
    });
}

Hit Caster::first(Hit hit, const Vector& from, const Vector& direction, double azimuth, std::uint64_t seed,
                  std::uint64_t cell, const Shifts* shifts) const {
  for (const Candidate& candidate : sectors_[sectorOf(azimuth)]) {
    if (candidate.nearest >= hit.range) break;
    if (direction.z < candidate.lowest || direction.z > candidate.highest) continue;
    const Entry& entry = solids_[candidate.solid];
    const Solid& solid = *entry.solid;
    const Interval inside = solid.along(direction, shifts != nullptr ? from - (*shifts)[entry.object - 1] : from);
    if (inside.enter > inside.leave || inside.enter <= 0) continue;
    double range = inside.enter;
    if (solid.meanDepth() > 0) {
      // The depth of the first leaf is distributed exponentially.
      range -= solid.meanDepth() * std::log1p(-CellRandom(seed, cell, kForLeaves + candidate.solid).unit());
      if (range > inside.leave) continue;
    }
    if (range < hit.range) hit = {range, entry.object};
  }
  return hit;
}

std::optional<double> reportedRange(const Hit& hit, const Sensor& sensor, const Disturbance& disturbance,
                                    std::uint64_t cell) {
  if (hit.range > sensor.max_range) return std::nullopt;
  if (CellRandom(disturbance.seed, cell, kForDropOut).unit() < disturbance.drop_outs) return std::nullopt;
  const double noise = disturbance.range_noise * CellRandom(disturbance.seed, cell, kForNoise).gaussian();
  const double range = std::max(hit.range + noise, kMinRange);
  return sensor.range_unit > 0 ? sensor.range_unit * std::round(range / sensor.range_unit) : range;
}

}  // namespace lisco_simulation
