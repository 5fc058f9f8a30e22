// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <unordered_map>

#include <boost/functional/hash.hpp>

#include "simulation/random.h"
#include "simulation/solid.h"

namespace lisco_simulation {
namespace {

/// Purposes of a cell's random numbers, distinct from the scanner's.
enum Purpose : std::uint64_t { kForRange = 1000, kForNoise, kForDropOut };

constexpr double kNoFloor = -1e6;  // metres: beyond the range of any sensor

struct Target {
  double range = 0;  ///< metres, <= 0: none
  std::uint32_t object = 0;
};

/// A cell's ray, from which a case gives the target.
struct Ray {
  std::size_t laser, step, cell;
  Vector direction;
  double noise;  ///< metres
};

SimulatedCell cellAt(const Ray& ray, const Target& target) {
  return cellAt(target.range * ray.direction, target.object);
}

/// \param target_of gives the target of a ray as the sensor measures it, noise included
template <typename TargetOf>
SimulatedScan scanEachCell(const Sensor& sensor, const Disturbance& disturbance, TargetOf&& target_of) {
  SimulatedScan scan = emptyScan(sensor.lasers(), sensor.steps);
  for (std::size_t cell = 0; cell < scan.cells.size(); ++cell) {
    if (CellRandom(disturbance.seed, cell, kForDropOut).unit() < disturbance.drop_outs) continue;
    Ray ray{cell / scan.steps, cell % scan.steps, cell, {}, 0};
    ray.direction = sensor.direction(ray.laser, ray.step);
    ray.noise = disturbance.range_noise * CellRandom(disturbance.seed, cell, kForNoise).gaussian();
    const Target target = target_of(ray);
    if (target.range > 0) scan.cells[cell] = cellAt(ray, target);
  }
  return scan;
}

/// The range of a ray at a round wall around the sensor.
double rangeOfRoundWall(const Vector& direction, double radius) {
  return radius / std::hypot(direction.x, direction.y);
}

std::uint32_t numberOf(std::size_t cell) {
  return static_cast<std::uint32_t>(cell + 1);
}

SimulatedScan scanRoom(const Sensor& sensor, const Disturbance& disturbance, double /*gap*/) {
  constexpr double kLength = 4;  // half of it, metres
  constexpr double kWidth = 3;   // half of it
  constexpr double kFloor = -1.8;
  constexpr double kCeiling = 1.2;
  constexpr double kThick = 0.3;
  const double length = kLength + kThick;
  const double width = kWidth + kThick;
  Scene scene;
  scene.floor_z = kNoFloor;
  scene.objects.push_back({"room",
                           {Solid::box({kLength, -width, kFloor}, {length, width, kCeiling}),
                            Solid::box({-length, -width, kFloor}, {-kLength, width, kCeiling}),
                            Solid::box({-length, kWidth, kFloor}, {length, width, kCeiling}),
                            Solid::box({-length, -width, kFloor}, {length, -kWidth, kCeiling}),
                            Solid::box({-length, -width, kFloor - kThick}, {length, width, kFloor}),
                            Solid::box({-length, -width, kCeiling}, {length, width, kCeiling + kThick})}});
  return scan(scene, sensor, disturbance);
}

SimulatedScan scanWall(const Sensor& sensor, const Disturbance& disturbance, double /*gap*/) {
  return scanEachCell(sensor, disturbance, [](const Ray& ray) {
    return Target{std::max(rangeOfRoundWall(ray.direction, 1) + ray.noise, kMinRange), 1};
  });
}

SimulatedScan scanRandom(const Sensor& sensor, const Disturbance& disturbance, double /*gap*/) {
  return scanEachCell(sensor, disturbance, [&](const Ray& ray) {
    return Target{1 + 59 * CellRandom(disturbance.seed, ray.cell, kForRange).unit(), numberOf(ray.cell)};
  });
}

SimulatedScan scanSheets(const Sensor& sensor, const Disturbance& disturbance, double gap) {
  constexpr double kRange = 5;
  return scanEachCell(sensor, disturbance, [&](const Ray& ray) {
    // Spheres: returns whose ranges differ by the gap are at least the gap apart in any direction.
    const bool farther = (ray.laser + ray.step) % 2 != 0;
    const double noise = std::fabs(ray.noise);
    return farther ? Target{kRange + gap + noise, 2} : Target{std::max(kRange - noise, kMinRange), 1};
  });
}

SimulatedScan scanBlocked(const Sensor& sensor, const Disturbance& disturbance, double /*gap*/) {
  constexpr double kRange = 0.15;
  constexpr double kMaxRange = 0.29;
  return scanEachCell(sensor, disturbance, [&](const Ray& ray) {
    return Target{std::min(std::max(kRange + ray.noise, kMinRange), kMaxRange), 1};
  });
}

/// A set of positions that are farther than a gap from each other.
class Apart {
 public:
  explicit Apart(double gap) : gap_(gap) {}

  /// \return false, without adding it, if the position is too near to another one
  bool add(const SimulatedCell& cell) {
    const Cube cube{along(cell.x), along(cell.y), along(cell.z)};
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto [first, last] = positions_.equal_range({cube[0] + x, cube[1] + y, cube[2] + z});
          for (auto other = first; other != last; ++other)
            if (length(placeOf(other->second) - placeOf(cell)) <= gap_) return false;
        }
    positions_.emplace(cube, cell);
    return true;
  }

 private:
  using Cube = std::array<std::int64_t, 3>;  ///< numbers along the axes; the side is the gap

  std::int64_t along(float value) const {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(value) / gap_));
  }

  double gap_;
  std::unordered_multimap<Cube, SimulatedCell, boost::hash<Cube>> positions_;
};

SimulatedScan scanSingletons(const Sensor& sensor, const Disturbance& disturbance, double gap) {
  constexpr int kTrials = 8;
  constexpr double kNearest = 2;  // metres
  Apart apart(gap);
  return scanEachCell(sensor, disturbance, [&](const Ray& ray) {
    CellRandom random(disturbance.seed, ray.cell, kForRange);
    for (int trial = 0; trial < kTrials; ++trial) {
      const Target target{kNearest + (sensor.max_range - kNearest) * random.unit(), numberOf(ray.cell)};
      if (apart.add(cellAt(ray, target))) return target;
    }
    return Target{};
  });
}

SimulatedScan scanPoles(const Sensor& sensor, const Disturbance& disturbance, double /*gap*/) {
  constexpr double kPitch = 0.65;   // from pole to pole of a ring, metres
  constexpr double kSlender = 250;  // range by radius: a width of one or two steps
  constexpr double kRings[] = {3, 4.5, 6.75, 10, 15};
  constexpr double kSteepest = 0.6;  // tangent of an elevation beyond those of all sensors
  Scene scene;
  scene.floor_z = kNoFloor;
  for (const double range : kRings) {
    const int poles = static_cast<int>(2 * kPi * range / kPitch);
    for (int pole = 0; pole < poles; ++pole) {
      const double angle = 2 * kPi * pole / poles;
      const Vector foot{range * std::cos(angle), range * std::sin(angle), -kSteepest * range};
      const Vector top{foot.x, foot.y, kSteepest * range};
      scene.objects.push_back({"pole", {Solid::cylinder(foot, top, range / kSlender)}});
    }
  }
  return scan(scene, sensor, disturbance);
}

struct Case {
  const char* name;
  const char* description;
  SimulatedScan (*scan)(const Sensor& sensor, const Disturbance& disturbance, double gap);
  bool has_gap = false;
};

constexpr Case kCases[] = {
    {"room", "a closed, empty room: one cluster", scanRoom},
    {"wall", "a round wall 1 m away on all sides", scanWall},
    {"random", "each return at a random range between 1 and 60 m", scanRandom},
    {"sheets", "two sheets a gap apart, hit alternately by neighbouring cells", scanSheets, true},
    {"singletons", "as many returns as possible that are farther than a gap from each other", scanSingletons, true},
    {"blocked", "an obstacle on the sensor's cover: all returns within 0.3 m", scanBlocked},
    {"poles", "a comb of thin vertical poles", scanPoles}};

const Case& caseOf(const std::string& name) {
  const auto* const found =
      std::find_if(std::begin(kCases), std::end(kCases), [&](const Case& c) { return c.name == name; });
  if (found == std::end(kCases)) throw std::invalid_argument("no case is called '" + name + "'");
  return *found;
}

}  // namespace

std::vector<std::string> caseNames() {
  std::vector<std::string> names;
  for (const Case& each : kCases) names.emplace_back(each.name);
  return names;
}

std::string describeCase(const std::string& name) {
  return caseOf(name).description;
}

bool caseHasGap(const std::string& name) {
  return caseOf(name).has_gap;
}

SimulatedScan scanCase(const std::string& name, const Sensor& sensor, const Disturbance& disturbance, double gap) {
  return caseOf(name).scan(sensor, disturbance, gap);
}

}  // namespace lisco_simulation
