// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The simulated scenes, solid by solid and as a whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "lisco/column_clusterer.h"
#include "simulation/random.h"
#include "simulation/scanner.h"
#include "simulation/scenes.h"
#include "simulation/sensor.h"
#include "simulation/solid.h"

namespace lisco_simulation {
namespace {

constexpr double kDegree = kPi / 180;

// Scenes are fitted by many scans: all seeds only in release builds.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr unsigned kSeeds = 2;
#else
constexpr unsigned kSeeds = 20;
#endif

Vector randomDirection(Random& random) {
  const double z = random.between(-1, 1);
  const double angle = random.between(-kPi, kPi);
  return {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
}

Vector randomPlace(Random& random, double extent) {
  return {random.between(-extent, extent), random.between(-extent, extent), random.between(-extent, extent)};
}

Solid randomSolid(Random& random) {
  const auto half = [&random] { return random.between(0.2, 2); };
  const double choice = random.unit();
  Solid solid = Solid::ellipsoid(randomPlace(random, 1), {half(), half(), half()});
  if (choice < 0.3)
    solid = Solid::cylinder(randomPlace(random, 1), randomPlace(random, 1) + Vector{0, 0, 2.5}, half());
  else if (choice < 0.4)
    solid = Solid::cylinder({0, 0, -half()}, {0, 0, half()}, half());
  else if (choice < 0.7)
    solid = Solid::block({-half(), half(), -half(), half(), -half()}, {-half(), half(), -half(), half(), half()});
  return solid.rotated(random.between(-kPi, kPi)).moved(randomPlace(random, 5));
}

/// A scene of a single solid, object 1, with a distant floor.
Scene sceneOf(const Solid& solid) {
  Scene scene;
  scene.floor_z = -1000;
  scene.ground_z = -999;
  scene.objects.push_back({"solid", {solid}});
  return scene;
}

// --- Solids --------------------------------------------------------------------------------------------------------

TEST(Solid, HasTheIntervalsOfGeometry) {
  const auto enters = [](const Solid& solid, const Vector& direction) { return solid.along(direction).enter; };
  EXPECT_NEAR(enters(Solid::ellipsoid({5, 0, 0}, {1, 2, 3}), {1, 0, 0}), 4, 1e-12);
  EXPECT_NEAR(enters(Solid::box({3, -1, -1}, {4, 1, 3}), {0.8, 0.0, 0.6}), 3 / 0.8, 1e-12);
  EXPECT_NEAR(enters(Solid::box({3, -1, -1}, {4, 1, 1}), {1, 0, 0}), 3, 1e-12);
  EXPECT_NEAR(enters(Solid::cylinder({5, 0, -1}, {5, 0, 1}, 0.5), {1, 0, 0}), 4.5, 1e-12);
  EXPECT_NEAR(enters(Solid::cylinder({5, 0, 0}, {7, 0, 0}, 0.5), {1, 0, 0}), 5, 1e-12) << "onto its end";
  // A windscreen that leans from x = 2 at z = -1 to x = 4 at z = 1 is met at x = 3 by a level ray.
  EXPECT_NEAR(enters(Solid::block({2, 9, -1, 1, -1}, {4, 8, -1, 1, 1}), {1, 0, 0}), 3, 1e-12);
  EXPECT_NEAR(enters(Solid::box({3, -1, -1}, {4, 1, 1}).rotated(kPi / 2), {0, 1, 0}), 3, 1e-12);
  EXPECT_NEAR(enters(Solid::box({3, -1, -1}, {4, 1, 1}).moved({0, 0.5, 0}).rotated(kPi), {-1, 0, 0}), 3, 1e-12);

  const Interval missed = Solid::ellipsoid({5, 0, 0}, {1, 1, 1}).along({0, 1, 0});
  EXPECT_GT(missed.enter, missed.leave);
  const Interval beside = Solid::cylinder({5, 2, 0}, {7, 2, 0}, 0.5).along({1, 0, 0});
  EXPECT_GT(beside.enter, beside.leave) << "along its axis";
}

TEST(Solid, AgreesWithRayMarching) {
  Random random(1);
  int met = 0;
  for (int round = 0; round < 20000; ++round) {
    const Solid solid = randomSolid(random);
    // Half of the rays go towards it.
    Vector direction = randomDirection(random);
    if (random.chance(0.5)) {
      direction = solid.bounds().centre + randomPlace(random, 0.5);
      direction = (1 / length(direction)) * direction;
    }
    const Interval inside = solid.along(direction);
    if (inside.enter > inside.leave) {
      for (double range = 0; range < 15; range += 0.05)
        ASSERT_FALSE(solid.contains(range * direction, -1e-6)) << "round " << round << ", at " << range;
      continue;
    }
    ++met;
    const double middle = (inside.enter + inside.leave) / 2;
    ASSERT_TRUE(solid.contains(middle * direction, 1e-9)) << "round " << round;
    for (const double end : {inside.enter, inside.leave}) {
      const double outwards = end < middle ? -1e-3 : 1e-3;
      ASSERT_TRUE(solid.contains(end * direction, 1e-9)) << "round " << round;
      ASSERT_FALSE(solid.contains((end + outwards) * direction, -1e-9)) << "round " << round;
      ASSERT_LE(length(end * direction - solid.bounds().centre), solid.bounds().radius + 1e-9) << "round " << round;
    }
  }
  EXPECT_GT(met, 5000);
}

TEST(Solid, OfLeavesStopsRaysExponentially) {
  // A wall of leaves 1 m thick with a mean depth of 0.5 m stops all but exp (-2) of the rays that go straight in.
  const Scene scene = sceneOf(Solid::box({4, -50, -50}, {5, 50, 50}).ofLeaves(0.5));
  Sensor sensor = makeSensor("hdl64e", 1, 100000);
  sensor.elevation = {0};
  const SimulatedScan rotation = scan(scene, sensor, {1, 0, 0});
  int rays = 0;
  int stopped = 0;
  double depth = 0;
  for (std::size_t step = 0; step < sensor.steps; ++step) {
    if (std::fabs(sensor.azimuth(0, step)) > 5 * kDegree) continue;
    ++rays;
    if (std::isnan(rotation.at(0, step).x)) continue;
    ++stopped;
    const auto x = static_cast<double>(rotation.at(0, step).x);
    ASSERT_GE(x, 4 - 1e-5);
    ASSERT_LE(x, 5 + 1e-5);
    depth += x - 4;
  }
  EXPECT_NEAR(static_cast<double>(stopped) / rays, 1 - std::exp(-2.0), 0.03);
  // The mean of an exponential distribution that is cut off at twice its mean.
  EXPECT_NEAR(depth / stopped, 0.5 - std::exp(-2.0) / (1 - std::exp(-2.0)), 0.02);
}

// --- Sensors -------------------------------------------------------------------------------------------------------

TEST(Sensor, HasTheLasersAndStepsOfItsModel) {
  struct Expected {
    const char* name;
    std::size_t lasers, steps;
    double top, bottom;
  };
  std::vector<std::string> names;
  for (const Expected& expected : {Expected{"hdl64e", 64, 1125, 2, -24.0 - 1.0 / 3},
                                   {"hdl32e", 32, 2170, 10.67, -30.67},
                                   {"vlp16", 16, 1808, 15, -15},
                                   {"vls128", 128, 1808, 15, -25},
                                   {"os1-128", 128, 1024, 22.5, -22.5}}) {
    SCOPED_TRACE(expected.name);
    names.emplace_back(expected.name);
    const Sensor sensor = makeSensor(expected.name);
    EXPECT_EQ(sensor.lasers(), expected.lasers);
    EXPECT_EQ(sensor.stagger.size(), expected.lasers);
    EXPECT_EQ(sensor.steps, expected.steps);
    EXPECT_NEAR(sensor.elevation.front(), expected.top * kDegree, 0.005 * kDegree);
    EXPECT_NEAR(sensor.elevation.back(), expected.bottom * kDegree, 0.005 * kDegree);
    for (std::size_t laser = 1; laser < sensor.lasers(); ++laser)
      EXPECT_LT(sensor.elevation[laser], sensor.elevation[laser - 1]) << "laser " << laser;
  }
  EXPECT_EQ(simulatedSensors(), names);
  EXPECT_THROW(makeSensor("hdl65"), std::invalid_argument);
}

TEST(Sensor, StartsBehindAndTurnsClockwise) {
  const Sensor sensor = makeSensor("hdl64e", 3, 8);
  const auto expectHeading = [&sensor](std::size_t step, double x, double y) {
    const Vector direction = sensor.direction(1, step);
    const double horizontal = std::hypot(direction.x, direction.y);
    EXPECT_NEAR(direction.x / horizontal, x, 1e-12) << "step " << step;
    EXPECT_NEAR(direction.y / horizontal, y, 1e-12) << "step " << step;
    EXPECT_NEAR(length(direction), 1, 1e-12);
  };
  expectHeading(0, -1, 0);
  expectHeading(2, 0, 1);  // to the left
  expectHeading(4, 1, 0);
  expectHeading(6, 0, -1);
}

TEST(Sensor, HasTheStaggerOfItsModel) {
  for (const double stagger : makeSensor("hdl64e").stagger) EXPECT_EQ(stagger, 0);

  // 16 firings in 2/3 of a step: the lowest laser first, then the lowest of the upper half.
  const Sensor vlp16 = makeSensor("vlp16");
  const double firing = 2 * kPi / 1808 / 24;
  EXPECT_NEAR(vlp16.stagger[15], 0, 1e-12);           // -15 degrees
  EXPECT_NEAR(vlp16.stagger[7], 1 * firing, 1e-12);   // +1
  EXPECT_NEAR(vlp16.stagger[14], 2 * firing, 1e-12);  // -13
  EXPECT_NEAR(vlp16.stagger[0], 15 * firing, 1e-12);  // +15
  const Sensor hdl32e = makeSensor("hdl32e");
  EXPECT_NEAR(hdl32e.elevation[15] / kDegree, -9.33, 0.01);
  EXPECT_NEAR(hdl32e.stagger[15], 2 * kPi / 2170 / 40, 1e-12);  // fires second

  const Sensor vls128 = makeSensor("vls128");
  std::set<double> offsets;
  for (std::size_t laser = 0; laser < 128; ++laser) {
    offsets.insert(std::round(vls128.stagger[laser] / kDegree * 1000));
    EXPECT_EQ(vls128.stagger[laser], vls128.stagger[laser % 8]);
  }
  EXPECT_EQ(offsets, (std::set<double>{-6354, -4548, -2732, -911, 911, 2732, 4548, 6354}));
  // Dense around the horizon, ever wider towards both ends.
  const auto gap = [&vls128](std::size_t laser) {
    return (vls128.elevation[laser] - vls128.elevation[laser + 1]) / kDegree;
  };
  for (std::size_t laser = 0; laser < 127; ++laser) {
    const bool dense = vls128.elevation[laser] < 4.81 * kDegree && vls128.elevation[laser + 1] > -6.43 * kDegree;
    if (dense) {
      EXPECT_NEAR(gap(laser), 0.11, 1e-9) << "laser " << laser;
    } else {
      EXPECT_GT(gap(laser), gap(vls128.elevation[laser] > 0 ? laser + 1 : laser - 1)) << "laser " << laser;
    }
  }

  const Sensor os1 = makeSensor("os1-128");
  offsets.clear();
  for (const double stagger : os1.stagger) offsets.insert(std::round(stagger / kDegree * 100));
  EXPECT_EQ(offsets, (std::set<double>{-423, -141, 141, 423}));
}

TEST(Sensor, HasAnyNumberOfLasersAndSteps) {
  for (const std::string& name : simulatedSensors())
    for (const std::size_t lasers : {1, 2, 3, 7, 16, 100, 300}) {
      SCOPED_TRACE(name + " with " + std::to_string(lasers) + " lasers");
      const Sensor model = makeSensor(name);
      const Sensor sensor = makeSensor(name, lasers, 17);
      ASSERT_EQ(sensor.lasers(), lasers);
      ASSERT_EQ(sensor.stagger.size(), lasers);
      EXPECT_EQ(sensor.steps, 17U);
      EXPECT_TRUE(std::is_sorted(sensor.elevation.rbegin(), sensor.elevation.rend()));
      if (lasers > 1) {
        EXPECT_NEAR(sensor.elevation.front(), model.elevation.front(), 1e-12);
        EXPECT_NEAR(sensor.elevation.back(), model.elevation.back(), 1e-12);
      }
      const SimulatedScan rotation = scan(sceneOf(Solid::box({3, -1, -1}, {4, 1, 1})), sensor, {});
      EXPECT_EQ(rotation.cells.size(), lasers * 17);
    }
}

// --- Scanning ------------------------------------------------------------------------------------------------------

TEST(Scan, AgreesWithBruteForce) {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    Scene scene;
    for (int object = 0; object < 60; ++object) scene.objects.push_back({"solid", {randomSolid(random)}});
    const Sensor sensor = makeSensor("os1-128", 40, 90);
    const SimulatedScan rotation = scan(scene, sensor, {1, 0, 0});
    for (std::size_t laser = 0; laser < sensor.lasers(); ++laser)
      for (std::size_t step = 0; step < sensor.steps; ++step) {
        const Vector direction = sensor.direction(laser, step);
        double nearest = direction.z < 0 ? scene.floor_z / direction.z : 1e9;
        std::uint32_t object = 0;
        for (std::size_t i = 0; i < scene.objects.size(); ++i) {
          const Interval inside = scene.objects[i].solids[0].along(direction);
          if (inside.enter > inside.leave || inside.enter <= 0 || inside.enter >= nearest) continue;
          nearest = inside.enter;
          object = static_cast<std::uint32_t>(i + 1);
        }
        const SimulatedCell& cell = rotation.at(laser, step);
        if (nearest > sensor.max_range) {
          ASSERT_TRUE(std::isnan(cell.x) && std::isnan(cell.y) && std::isnan(cell.z));
          ASSERT_EQ(cell.object, 0U);
          continue;
        }
        ASSERT_EQ(cell.object, object) << "round " << round << ", laser " << laser << ", step " << step;
        ASSERT_NEAR(static_cast<double>(cell.x), nearest * direction.x, 1e-4);
        ASSERT_NEAR(static_cast<double>(cell.y), nearest * direction.y, 1e-4);
        ASSERT_NEAR(static_cast<double>(cell.z), nearest * direction.z, 1e-4);
      }
  }
}

TEST(Scan, HasTheGivenNoiseAndDropOuts) {
  const Scene scene = layOutScene(5, 1, 2);
  const Sensor sensor = makeSensor("hdl64e");
  const SimulatedScan perfect = scan(scene, sensor, {1, 0, 0});
  const SimulatedScan disturbed = scan(scene, sensor, {1, 0.05, 0.1});
  double sum = 0;
  double squares = 0;
  for (std::size_t cell = 0; cell < perfect.cells.size(); ++cell) {
    const SimulatedCell& is = disturbed.cells[cell];
    if (std::isnan(is.x)) {
      EXPECT_EQ(is.object, 0U);
      continue;
    }
    const SimulatedCell& was = perfect.cells[cell];
    ASSERT_EQ(is.object, was.object);
    const auto range = [](const SimulatedCell& at) { return std::hypot(std::hypot(at.x, at.y), at.z); };
    const double error = static_cast<double>(range(is)) - static_cast<double>(range(was));
    sum += error;
    squares += error * error;
    ASSERT_NEAR(is.x * range(was), was.x * range(is), 1e-4F) << "along the ray";
  }
  const auto returns = static_cast<double>(disturbed.returns());
  EXPECT_EQ(perfect.returns(), perfect.cells.size());
  EXPECT_NEAR(returns / 72000, 0.9, 0.005);
  EXPECT_NEAR(sum / returns, 0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / returns), 0.05, 0.001);
}

TEST(Scan, IsEqualForEqualSeedsOnly) {
  const Scene scene = layOutScene(1, 1, 3);
  const Sensor sensor = makeSensor("vlp16");
  const auto bytes = [](const SimulatedScan& rotation) {
    return std::string(reinterpret_cast<const char*>(rotation.cells.data()),
                       rotation.cells.size() * sizeof(SimulatedCell));
  };
  EXPECT_EQ(bytes(scan(scene, sensor, {1})), bytes(scan(layOutScene(1, 1, 3), sensor, {1})));
  EXPECT_NE(bytes(scan(scene, sensor, {1})), bytes(scan(scene, sensor, {2})));
  EXPECT_NE(bytes(scan(scene, sensor, {1})), bytes(scan(layOutScene(1, 2, 3), sensor, {1})));
}

// --- Scenes --------------------------------------------------------------------------------------------------------

class EachScene : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Number, EachScene, testing::Range(1, kScenes + 1));

TEST_P(EachScene, HasThePapersNumberOfReturns) {
  const Sensor sensor = makeSensor("hdl64e");
  const auto paper = static_cast<double>(kReturnsInPaper[GetParam() - 1]);
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Scene scene = makeScene(GetParam(), seed);
    Disturbance disturbance;
    disturbance.seed = seed;
    const SimulatedScan rotation = scan(scene, sensor, disturbance);
    EXPECT_EQ(rotation.cells.size(), 72000U);
    EXPECT_NEAR(static_cast<double>(rotation.returnsAbove(scene.ground_z)), paper, 0.002 * paper) << "seed " << seed;
  }
}

TEST_P(EachScene, LabelsReturnsWithTheObjectTheyLieOn) {
  const Scene scene = makeScene(GetParam(), 1);
  for (const std::string& name : simulatedSensors()) {
    SCOPED_TRACE(name);
    const SimulatedScan rotation = scan(scene, makeSensor(name), {1, 0, 0});
    std::set<std::uint32_t> seen;
    for (const SimulatedCell& cell : rotation.cells) {
      if (std::isnan(cell.x)) {
        ASSERT_EQ(cell.object, 0U);
        continue;
      }
      const Vector place{static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)};
      if (cell.object == 0) {
        ASSERT_NEAR(place.z, scene.floor_z, 1e-4);
        continue;
      }
      seen.insert(cell.object);
      ASSERT_LE(cell.object, scene.objects.size());
      const Object& object = scene.objects[cell.object - 1];
      ASSERT_TRUE(std::any_of(object.solids.begin(), object.solids.end(), [&place](const Solid& solid) {
        return solid.contains(place, 1e-4);
      })) << object.kind;
    }
    EXPECT_GE(seen.size(), scene.objects.size() * 3 / 5) << "most objects are seen";
  }
}

TEST_P(EachScene, HidesTheMountOfThePapersSensor) {
  const Scene scene = makeScene(GetParam(), 1);
  ASSERT_EQ(scene.objects[0].kind.substr(0, 6), "sensor");
  for (const SimulatedCell& cell : scan(scene, makeSensor("hdl64e"), {}).cells) ASSERT_NE(cell.object, 1U);
}

TEST(Scenes, AreNearAndFarWithTheSameObjects) {
  for (const int near_number : {1, 3})
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE("scene " + std::to_string(near_number) + ", seed " + std::to_string(seed));
      const Scene near_scene = makeScene(near_number, seed);
      const Scene far_scene = makeScene(near_number + 1, seed);
      ASSERT_EQ(near_scene.objects.size(), far_scene.objects.size());
      double common = 0;  // distance by which all have moved away
      for (std::size_t object = 1; object < near_scene.objects.size(); ++object) {
        const auto& near_solids = near_scene.objects[object].solids;
        const auto& far_solids = far_scene.objects[object].solids;
        EXPECT_EQ(near_scene.objects[object].kind, far_scene.objects[object].kind);
        ASSERT_EQ(near_solids.size(), far_solids.size());
        const Vector moved = far_solids[0].bounds().centre - near_solids[0].bounds().centre;
        for (std::size_t solid = 0; solid < near_solids.size(); ++solid) {
          const Vector also = far_solids[solid].bounds().centre - near_solids[solid].bounds().centre;
          EXPECT_NEAR(length(also - moved), 0, 1e-9) << "as a whole";
          EXPECT_EQ(near_solids[solid].bounds().radius, far_solids[solid].bounds().radius);
        }
        if (object == 1) common = length(moved);
        EXPECT_NEAR(length(moved), common, 1e-9);
        EXPECT_NEAR(moved.z, 0, 1e-9);
        EXPECT_GT(dot(moved, near_solids[0].bounds().centre), 0) << "away from the sensor";
      }
      EXPECT_GT(common, 3);
    }
  EXPECT_GT(layOutScene(3, 1, 2).objects.size(), 2 * layOutScene(1, 1, 2).objects.size());
  EXPECT_THROW(makeScene(0, 1), std::invalid_argument);
  EXPECT_THROW(makeScene(6, 1), std::invalid_argument);
}

TEST(Scenes, DifferFromSeedToSeed) {
  for (const int number : {1, 3, 5}) {
    SCOPED_TRACE(number);
    const auto one = layOutScene(number, 1, 2).objects;
    const auto two = layOutScene(number, 2, 2).objects;
    std::size_t alike = 0;
    for (std::size_t object = 0; object < std::min(one.size(), two.size()); ++object)
      if (length(one[object].solids[0].bounds().centre - two[object].solids[0].bounds().centre) < 1e-3) ++alike;
    EXPECT_LE(alike, one.size() / 4);
  }
}

TEST(Scenes, RoomIsClosed) {
  const Scene scene = makeScene(5, 1);
  for (const std::string& name : simulatedSensors()) {
    const SimulatedScan rotation = scan(scene, makeSensor(name, 0, 500), {1, 0.02, 0});
    EXPECT_EQ(rotation.returns(), rotation.cells.size()) << name;
  }
}

class EachStreet : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Number, EachStreet, testing::Range(1, 5));

TEST_P(EachStreet, HasAQuarterOfItsReturnsOnItsOwnVehicle) {
  for (unsigned seed = 1; seed <= std::min(kSeeds, 5U); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene bare = makeScene(GetParam(), seed);
    Scene scene = bare;
    addVehicle(scene, seed);
    ASSERT_EQ(scene.objects.size(), bare.objects.size() + 1);
    EXPECT_EQ(scene.objects.back().kind, "vehicle");
    const auto vehicle = static_cast<std::uint32_t>(scene.objects.size());
    Disturbance disturbance;
    disturbance.seed = seed;
    const SimulatedScan rotation = scan(scene, makeSensor("hdl64e"), disturbance);
    const auto returns = static_cast<double>(rotation.returns());
    EXPECT_NEAR(static_cast<double>(rotation.returnsWithin(1.5)) / returns, 0.25, 0.01);
    // Nearer than the usual tolerances, by themselves and by the rest of the vehicle.
    std::size_t before = 0;
    for (const double range : {0.3, 0.7, 1.0, 1.5}) {
      const std::size_t within = rotation.returnsWithin(range);
      EXPECT_GT(static_cast<double>(within - before), 0.01 * returns) << range << " m";
      before = within;
    }
    EXPECT_EQ(scan(bare, makeSensor("hdl64e"), disturbance).returnsWithin(1.5), 0U);
    for (const SimulatedCell& cell : rotation.cells) {
      const float range = std::hypot(std::hypot(cell.x, cell.y), cell.z);
      ASSERT_EQ(cell.object == vehicle, range < 1.6F) << range;
    }
  }
}

TEST_P(EachStreet, HasEqualVehiclesForEqualSeeds) {
  const auto bytes = [] {
    Scene scene = makeScene(GetParam(), 2);
    addVehicle(scene, 2);
    const SimulatedScan rotation = scan(scene, makeSensor("vlp16"), {2});
    return std::string(reinterpret_cast<const char*>(rotation.cells.data()),
                       rotation.cells.size() * sizeof(SimulatedCell));
  };
  EXPECT_TRUE(bytes() == bytes());
}

/// The clusters of a scan without ground: of each return the root of its cluster, and the object it lies on.
struct Clustered {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> root_and_object;

  /// The cluster that holds most of an object.
  std::uint32_t clusterOf(std::uint32_t object) const {
    std::map<std::uint32_t, int> counts;
    for (const auto& [root, of] : root_and_object)
      if (of == object) ++counts[root];
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == counts.end() ? ~std::uint32_t{0} : most->first;
  }
};

Clustered clustered(const SimulatedScan& rotation, float ground_z, float tolerance) {
  lisco::Parameters parameters;
  parameters.tolerance = tolerance;
  lisco::ColumnClusterer clusterer;
  clusterer.begin(parameters);
  clusterer.addColumns(rotation.steps, rotation.lasers, [&](std::size_t laser, std::size_t step) {
    const SimulatedCell& cell = rotation.at(laser, step);
    if (!(cell.z >= ground_z)) return lisco::kNoReturn;
    return lisco::Return{cell.x, cell.y, cell.z, static_cast<std::uint32_t>(laser * rotation.steps + step)};
  });
  clusterer.update();
  Clustered result;
  clusterer.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t root) {
    for (std::size_t i = 0; i < count; ++i) result.root_and_object.emplace_back(root, rotation.cells[cells[i]].object);
  });
  return result;
}

// Scene 3 in the paper: at 0.4 m every object is apart, at 1 m all cars of a side are one cluster.
TEST(Scenes, ParkedCarsOfASideAreOneClusterAtOneMetreOnly) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = makeScene(3, seed);
    Disturbance disturbance;
    disturbance.seed = seed;
    const SimulatedScan rotation = scan(scene, makeSensor("hdl64e"), disturbance);
    const Clustered fine = clustered(rotation, scene.ground_z, 0.4F);
    const Clustered coarse = clustered(rotation, scene.ground_z, 1.0F);
    for (const double side : {-1.0, 1.0}) {
      std::set<std::uint32_t> fine_clusters;
      std::set<std::uint32_t> coarse_clusters;
      std::size_t cars = 0;
      for (std::uint32_t object = 1; object <= scene.objects.size(); ++object) {
        if (scene.objects[object - 1].kind != "car") continue;
        if (side * scene.objects[object - 1].solids[0].bounds().centre.y < 3) continue;  // in the lane
        ++cars;
        fine_clusters.insert(fine.clusterOf(object));
        coarse_clusters.insert(coarse.clusterOf(object));
      }
      EXPECT_GE(cars, 4U);
      EXPECT_EQ(fine_clusters.size(), cars);
      EXPECT_EQ(coarse_clusters.size(), 1U);
    }
  }
}

TEST_P(EachScene, HasNoTwoObjectsInOneClusterAt40Centimetres) {
  for (unsigned seed = 1; seed <= std::min(kSeeds, 5U); ++seed) {
    const Scene scene = makeScene(GetParam(), seed);
    Disturbance disturbance;
    disturbance.seed = seed;
    const SimulatedScan rotation = scan(scene, makeSensor("hdl64e"), disturbance);
    std::map<std::uint32_t, std::set<std::uint32_t>> objects;
    for (const auto& [root, object] : clustered(rotation, scene.ground_z, 0.4F).root_and_object) {
      const std::string& kind = object == 0 ? "" : scene.objects[object - 1].kind;
      // Shelves stand against the walls.
      if (kind != "shelf" && kind != "walls and ceiling") objects[root].insert(object);
    }
    for (const auto& [root, of] : objects) EXPECT_EQ(of.size(), 1U) << "seed " << seed << ", cluster " << root;
  }
}

}  // namespace
}  // namespace lisco_simulation
