// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/scanner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/caster.h"
#include "simulation/terrain.h"

namespace lisco_simulation {

std::size_t SimulatedScan::returns() const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [](const SimulatedCell& cell) { return !std::isnan(cell.x); }));
}

std::size_t SimulatedScan::returnsAbove(float ground_z) const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [ground_z](const SimulatedCell& cell) { return cell.z >= ground_z; }));
}

std::size_t SimulatedScan::returnsWithin(double range) const {
  return static_cast<std::size_t>(std::count_if(
      cells.begin(), cells.end(), [range](const SimulatedCell& cell) { return length(placeOf(cell)) < range; }));
}

SimulatedScan emptyScan(std::size_t lasers, std::size_t steps) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  SimulatedScan scan{lasers, steps, {}};
  scan.cells.assign(scan.lasers * scan.steps, {kNan, kNan, kNan, 0});
  return scan;
}

SimulatedCell cellAt(const Vector& place, std::uint32_t object) {
  return {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z), object};
}

SimulatedScan scan(const Scene& scene, const Sensor& sensor, const Disturbance& disturbance) {
  Caster caster;
  std::uint32_t number = 0;
  for (const Object& object : scene.objects) {
    ++number;
    for (const Solid& solid : object.solids) caster.add(solid, number);
  }
  caster.sort();
  const Terrain floor(scene.floor_z);
  SimulatedScan scan = emptyScan(sensor.lasers(), sensor.steps);
  for (std::size_t index = 0; index < scan.cells.size(); ++index) {
    const std::size_t laser = index / scan.steps;
    const std::size_t step = index % scan.steps;
    const Vector direction = sensor.direction(laser, step);
    const Hit ground{floor.rangeAlong({}, direction, sensor.max_range), 0};
    const Hit hit = caster.first(ground, {}, direction, sensor.azimuth(laser, step), disturbance.seed, index);
    if (const auto range = reportedRange(hit, sensor, disturbance, index))
      scan.cells[index] = cellAt(*range * direction, hit.object);
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

}  // namespace lisco_simulation
