// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Boxes of simulated cars against the cars.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "lisco/cluster_features.h"
#include "simulation/objects.h"
#include "simulation/scanner.h"

namespace lisco_simulation {
namespace {

constexpr double kFloor = -1.8;      ///< metres
constexpr double kAboveFloor = 0.2;  ///< metres; lower returns are left out, as with the ground
constexpr double kDegree = kPi / 180;

struct CarView {
  double range, bearing, yaw;  ///< of the car's centre and heading, metres and radians
  double length, width;        ///< of the car, metres
  std::vector<std::array<float, 3>> returns;
  lisco::ClusterFeatures features;
};

/// The largest coordinate of a car, facing x on a floor of height 0. \param axis 0: x, 1: y
double reachOf(const std::vector<Solid>& solids, int axis) {
  constexpr double kMaxReach = 3;
  constexpr double kStep = 0.002;
  for (double reach = kMaxReach; reach > 0; reach -= kStep)
    for (double other = -kMaxReach; other < kMaxReach; other += 0.1)
      for (const double z : {0.3, 0.5, 0.61})
        for (const Solid& solid : solids)
          if (solid.contains(axis == 0 ? Vector{reach, other, z} : Vector{other, reach, z})) return reach;
  return 0;
}

/// A car with both its sides in view, at an angle of 15 degrees or more.
CarView viewOfCar(const Sensor& sensor, unsigned seed) {
  Random random(seed);
  CarView view;
  Thing thing = car(random);
  view.length = 2 * reachOf(thing.object.solids, 0);
  view.width = 2 * reachOf(thing.object.solids, 1);
  double turned = 0;
  const auto seenAt = [&] {  // the smaller angle between a line of sight and a side
    const double ahead = view.range * std::cos(turned);
    const double aside = view.range * std::sin(turned);
    return std::min(std::atan2(aside - view.width / 2, ahead), std::atan2(ahead - view.length / 2, aside));
  };
  do {
    view.range = random.between(5, 20);
    turned = random.between(10 * kDegree, 80 * kDegree);
  } while (seenAt() < 15 * kDegree);
  view.bearing = random.between(-kPi, kPi);
  view.yaw = view.bearing + turned;
  Scene scene;
  scene.floor_z = kFloor;
  scene.objects.push_back(thing.object);
  for (Solid& solid : scene.objects[0].solids)
    solid = solid.rotated(view.yaw).moved(
        {view.range * std::cos(view.bearing), view.range * std::sin(view.bearing), kFloor});
  Disturbance disturbance;
  disturbance.seed = seed;
  for (const SimulatedCell& cell : scan(scene, sensor, disturbance).cells)
    if (cell.object == 1 && static_cast<double>(cell.z) > kFloor + kAboveFloor)
      view.returns.push_back({cell.x, cell.y, cell.z});
  view.features = lisco::clusterFeatures(view.returns.data(), view.returns.size(), sizeof view.returns[0]);
  return view;
}

double yawError(const CarView& view) {
  return std::fabs(std::remainder(view.features.box.yaw - view.yaw, kPi));
}
double lengthError(const CarView& view) {
  return std::fabs(view.features.box.length - view.length);
}
double widthError(const CarView& view) {
  return std::fabs(view.features.box.width - view.width);
}

struct SensorCase {
  const char* name;
  std::size_t steps;     ///< 0: the model's
  double largest_error;  ///< of a car's length and width, metres
  int beyond;            ///< cars of kCars whose error may be more than 10 cm: the noise of both ends adds up
};
constexpr unsigned kCars = 60;

class SimulatedCars : public testing::TestWithParam<SensorCase> {};

TEST_P(SimulatedCars, HaveTheirYawAndSizes) {
  const Sensor sensor = makeSensor(GetParam().name, 0, GetParam().steps);
  int beyond = 0;
  for (unsigned seed = 1; seed <= kCars; ++seed) {
    const CarView view = viewOfCar(sensor, seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", range " + std::to_string(view.range));
    EXPECT_LT(yawError(view), 3 * kDegree);
    const double error = std::max(lengthError(view), widthError(view));
    EXPECT_LT(error, GetParam().largest_error);
    beyond += error > 0.1 ? 1 : 0;
  }
  EXPECT_LE(beyond, GetParam().beyond);
}

// Columns 0.35 degrees apart are 12 cm apart at 20 m, and up to half a metre on a side seen at 15 degrees: up to so
// much of the car is not hit at all.
INSTANTIATE_TEST_SUITE_P(OfSensors, SimulatedCars,
                         testing::Values(SensorCase{"hdl64e", 2250, 0.1, 0}, SensorCase{"vls128", 0, 0.1, 0},
                                         SensorCase{"os1-128", 2048, 0.1, 0}, SensorCase{"hdl64e", 0, 0.36, 8},
                                         SensorCase{"os1-128", 0, 0.36, 12}),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name + "_" + std::to_string(of.param.steps);
                         });

TEST(TurnedScenes, GiveTheSameBoxes) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const CarView view = viewOfCar(makeSensor("hdl64e"), seed);
    const lisco::OrientedBox& box = view.features.box;
    for (int turn = 1; turn < 24; ++turn) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", turned by " + std::to_string(turn));
      const double angle = 0.7 * turn;
      std::vector<std::array<float, 3>> turned;
      for (const auto& point : view.returns) {
        const double x = static_cast<double>(point[0]);
        const double y = static_cast<double>(point[1]);
        turned.push_back({static_cast<float>(std::cos(angle) * x - std::sin(angle) * y),
                          static_cast<float>(std::sin(angle) * x + std::cos(angle) * y), point[2]});
      }
      const lisco::ClusterFeatures features = lisco::clusterFeatures(turned.data(), turned.size(), sizeof turned[0]);
      EXPECT_LT(std::fabs(std::remainder(features.box.yaw - box.yaw - angle, kPi)), 0.02 * kDegree);
      EXPECT_NEAR(features.box.length, box.length, 1e-3);
      EXPECT_NEAR(features.box.width, box.width, 1e-3);
      EXPECT_EQ(features.box.height, box.height);
      EXPECT_NEAR(features.box.center[0], std::cos(angle) * box.center[0] - std::sin(angle) * box.center[1], 1e-3);
      EXPECT_NEAR(features.box.center[1], std::sin(angle) * box.center[0] + std::cos(angle) * box.center[1], 1e-3);
      EXPECT_NEAR(features.density, view.features.density, 0.05);
    }
  }
}

}  // namespace
}  // namespace lisco_simulation
