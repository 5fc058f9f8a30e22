// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "scanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "random.h"

namespace lisco_simulation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Purposes of a cell's random numbers; those from kForLeaves on are for one solid each.
enum Purpose : std::uint64_t { kForNoise, kForDropOut, kForLeaves };

struct Hit {
  double range = kInfinity;
  std::uint32_t object = 0;
};

/// Finds the first hit of a ray. Solids are sorted into sectors of azimuth and in each by nearest range, so that few
/// are tested per ray.
class Caster {
 public:
  explicit Caster(const Scene& scene) : floor_z_(scene.floor_z), sectors_(kSectors) {
    std::uint32_t number = 0;
    for (const Object& object : scene.objects) {
      ++number;
      for (const Solid& solid : object.solids) add(solid, number);
    }
    for (auto& sector : sectors_)
      std::sort(sector.begin(), sector.end(), [](const Candidate& a, const Candidate& b) {
        return a.nearest != b.nearest ? a.nearest < b.nearest : a.solid < b.solid;
      });
  }

  /// \param seed, cell determine the depth of the ray into leaves
  Hit first(const Vector& direction, double azimuth, std::uint64_t seed, std::uint64_t cell) const {
    Hit hit;
    if (direction.z < 0) hit.range = floor_z_ / direction.z;
    for (const Candidate& candidate : sectors_[sectorOf(azimuth)]) {
      if (candidate.nearest >= hit.range) break;
      if (direction.z < candidate.lowest || direction.z > candidate.highest) continue;
      const Solid& solid = *solids_[candidate.solid].solid;
      const Interval inside = solid.along(direction);
      if (inside.enter > inside.leave || inside.enter <= 0) continue;
      double range = inside.enter;
      if (solid.meanDepth() > 0) {
        // The depth of the first leaf is distributed exponentially.
        range -= solid.meanDepth() * std::log1p(-CellRandom(seed, cell, kForLeaves + candidate.solid).unit());
        if (range > inside.leave) continue;
      }
      if (range < hit.range) hit = {range, solids_[candidate.solid].object};
    }
    return hit;
  }

 private:
  static constexpr std::size_t kSectors = 2048;

  struct Entry {
    const Solid* solid;
    std::uint32_t object;
  };
  /// The bounds of a solid as seen from the sensor.
  struct Candidate {
    double nearest;          ///< range, metres
    double lowest, highest;  ///< sine of the elevation
    std::uint32_t solid;
  };

  static double sectorPosition(double azimuth) {
    const double turns = azimuth / (2 * kPi);
    return (turns - std::floor(turns)) * static_cast<double>(kSectors);
  }
  static std::size_t sectorOf(double azimuth) { return static_cast<std::size_t>(sectorPosition(azimuth)) % kSectors; }

  void add(const Solid& solid, std::uint32_t object) {
    constexpr double kMargin = 1e-6;  // metres, above any rounding error
    const auto index = static_cast<std::uint32_t>(solids_.size());
    solids_.push_back({&solid, object});
    const Vector& centre = solid.bounds().centre;
    const double radius = solid.bounds().radius + kMargin;
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

  double floor_z_;
  std::vector<Entry> solids_;
  std::vector<std::vector<Candidate>> sectors_;
};

struct Ray {
  std::size_t laser, step;
  std::uint64_t cell;  ///< determines the random numbers
};

struct Return {
  Vector place;
  std::uint32_t object;
};

/// What the sensor measures along a ray; nullopt: no return.
std::optional<Return> measure(const Caster& caster, const Sensor& sensor, const Disturbance& disturbance,
                              const Ray& ray) {
  const Vector direction = sensor.direction(ray.laser, ray.step);
  const Hit hit = caster.first(direction, sensor.azimuth(ray.laser, ray.step), disturbance.seed, ray.cell);
  if (hit.range > sensor.max_range) return std::nullopt;
  if (CellRandom(disturbance.seed, ray.cell, kForDropOut).unit() < disturbance.drop_outs) return std::nullopt;
  const double noise = disturbance.range_noise * CellRandom(disturbance.seed, ray.cell, kForNoise).gaussian();
  return Return{std::max(hit.range + noise, kMinRange) * direction, hit.object};
}

}  // namespace

std::size_t Scan::returns() const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [](const Cell& cell) { return !std::isnan(cell.x); }));
}

std::size_t Scan::returnsAbove(float ground_z) const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [ground_z](const Cell& cell) { return cell.z >= ground_z; }));
}

std::size_t Scan::returnsWithin(double range) const {
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [range](const Cell& cell) {
    return length({static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)}) < range;
  }));
}

Scan emptyScan(std::size_t lasers, std::size_t steps) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Scan scan{lasers, steps, {}};
  scan.cells.assign(scan.lasers * scan.steps, {kNan, kNan, kNan, 0});
  return scan;
}

Cell cellAt(const Vector& place, std::uint32_t object) {
  return {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z), object};
}

Scan scan(const Scene& scene, const Sensor& sensor, const Disturbance& disturbance) {
  const Caster caster(scene);
  Scan scan = emptyScan(sensor.lasers(), sensor.steps);
  for (std::size_t index = 0; index < scan.cells.size(); ++index) {
    const Ray ray{index / scan.steps, index % scan.steps, index};
    if (const auto hit = measure(caster, sensor, disturbance, ray)) scan.cells[index] = cellAt(hit->place, hit->object);
  }
  return scan;
}

Scene seenFrom(const Scene& scene, const Vector& place, double heading) {
  Scene seen = scene;
  seen.floor_z -= place.z;
  seen.ground_z -= static_cast<float>(place.z);
  for (Object& object : seen.objects)
    for (Solid& solid : object.solids) solid = solid.moved(-1 * place).rotated(-heading);
  return seen;
}

Vector Motion::placeAfter(double turns) const {
  const double way = speed * turn_seconds * turns;
  const double heading = headingAfter(turns);
  if (heading == 0) return {way, 0, 0};
  const double radius = way / heading;
  return {radius * std::sin(heading), radius * (1 - std::cos(heading)), 0};
}

Scan scanInMotion(const Scene& scene, const Sensor& sensor, const Disturbance& disturbance, const Motion& motion,
                  std::size_t columns) {
  constexpr std::size_t kAtOnce = 4;  // columns measured from one place: a Caster takes as long as some columns
  Scan scan = emptyScan(sensor.lasers(), columns);
  for (std::size_t first = 0; first < columns; first += kAtOnce) {
    const double turns = static_cast<double>(first) / static_cast<double>(sensor.steps);
    const Vector place = motion.placeAfter(turns);
    const double heading = motion.headingAfter(turns);
    const Scene seen = seenFrom(scene, place, heading);
    const Caster caster(seen);
    for (std::size_t laser = 0; laser < scan.lasers; ++laser)
      for (std::size_t step = first; step < std::min(first + kAtOnce, columns); ++step) {
        const std::size_t index = laser * columns + step;
        if (const auto hit = measure(caster, sensor, disturbance, {laser, step, index}))
          scan.cells[index] = cellAt(rotated(hit->place, heading) + place, hit->object);
      }
  }
  return scan;
}

}  // namespace lisco_simulation
