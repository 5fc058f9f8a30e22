// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The properties of the worst cases, by all pairs of returns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "simulation/cases.h"
#include "simulation/scanner.h"
#include "simulation/sensor.h"

namespace lisco_simulation {
namespace {

constexpr double kGap = 0.41;  // metres

std::vector<SimulatedCell> returnsOf(const SimulatedScan& scan) {
  std::vector<SimulatedCell> returns;
  for (const SimulatedCell& cell : scan.cells)
    if (!std::isnan(cell.x)) returns.push_back(cell);
  return returns;
}

double rangeOf(const SimulatedCell& cell) {
  return std::hypot(std::hypot(static_cast<double>(cell.x), static_cast<double>(cell.y)), static_cast<double>(cell.z));
}

double distance(const SimulatedCell& a, const SimulatedCell& b) {
  const double x = static_cast<double>(a.x) - static_cast<double>(b.x);
  const double y = static_cast<double>(a.y) - static_cast<double>(b.y);
  const double z = static_cast<double>(a.z) - static_cast<double>(b.z);
  return std::sqrt(x * x + y * y + z * z);
}

/// The objects in each cluster, by all pairs.
std::vector<std::set<std::uint32_t>> objectsOfClusters(const std::vector<SimulatedCell>& returns, double tolerance) {
  std::vector<std::size_t> parent(returns.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < returns.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (distance(returns[i], returns[j]) < tolerance) parent[root(i)] = root(j);
  std::map<std::size_t, std::set<std::uint32_t>> objects;
  for (std::size_t i = 0; i < returns.size(); ++i) objects[root(i)].insert(returns[i].object);
  std::vector<std::set<std::uint32_t>> clusters;
  for (auto& [tree, of] : objects) clusters.push_back(std::move(of));
  return clusters;
}

double leastDistance(const std::vector<SimulatedCell>& returns, bool of_different_objects_only) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < returns.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!of_different_objects_only || returns[i].object != returns[j].object)
        least = std::min(least, distance(returns[i], returns[j]));
  return least;
}

SimulatedScan scanOf(const std::string& name, std::size_t lasers = 32, std::size_t steps = 180,
                     const std::string& sensor = "hdl64e", double gap = kGap) {
  return scanCase(name, makeSensor(sensor, lasers, steps), {}, gap);
}

TEST(Cases, RoomIsOneClusterOnAllSides) {
  for (const char* sensor : {"hdl64e", "os1-128"}) {
    SCOPED_TRACE(sensor);
    const SimulatedScan rotation = scanOf("room", 32, 180, sensor);
    const std::vector<SimulatedCell> returns = returnsOf(rotation);
    EXPECT_NEAR(static_cast<double>(returns.size()), 32 * 180, 0.02 * 32 * 180);
    EXPECT_EQ(objectsOfClusters(returns, 0.4), (std::vector<std::set<std::uint32_t>>{{1}}));
    for (const SimulatedCell& cell : returns) {
      // On one of six sides, up to the noise.
      const double inside =
          std::min({4 - std::fabs(static_cast<double>(cell.x)), 3 - std::fabs(static_cast<double>(cell.y)),
                    static_cast<double>(cell.z) + 1.8, 1.2 - static_cast<double>(cell.z)});
      ASSERT_NEAR(inside, 0, 0.13);
    }
  }
}

TEST(Cases, WallIsOneMetreAway) {
  for (const std::string& sensor : simulatedSensors()) {
    const SimulatedScan rotation = scanOf("wall", 32, 180, sensor);
    for (const SimulatedCell& cell : returnsOf(rotation)) {
      ASSERT_NEAR(std::hypot(static_cast<double>(cell.x), static_cast<double>(cell.y)), 1, 0.13) << sensor;
      ASSERT_EQ(cell.object, 1U);
    }
    EXPECT_EQ(objectsOfClusters(returnsOf(rotation), 0.4).size(), 1U) << sensor;
  }
}

TEST(Cases, RandomIsEvenlySpreadBetweenOneAnd60Metres) {
  const std::vector<SimulatedCell> returns = returnsOf(scanOf("random", 64, 1000));
  std::vector<int> counts(10);
  for (const SimulatedCell& cell : returns) {
    const double range = rangeOf(cell);
    ASSERT_GE(range, 1 - 1e-5);
    ASSERT_LE(range, 60 + 1e-5);
    ++counts[std::min<std::size_t>(9, static_cast<std::size_t>((range - 1) / 5.9))];
  }
  for (const int count : counts) EXPECT_NEAR(count, static_cast<double>(returns.size()) / 10, 300);
}

TEST(Cases, SheetsAreAGapApart) {
  for (const std::string& sensor : simulatedSensors())
    for (const double gap : {kGap, 0.11}) {
      SCOPED_TRACE(sensor + ", gap " + std::to_string(gap));
      const SimulatedScan rotation = scanOf("sheets", 48, 180, sensor, gap);
      const std::vector<SimulatedCell> returns = returnsOf(rotation);
      const double least = leastDistance(returns, true);
      EXPECT_GE(least, gap - 1e-5);
      EXPECT_LE(least, gap + 0.5) << "nearest returns lie in neighbouring boxes";
      for (std::size_t laser = 0; laser < rotation.lasers; ++laser)
        for (std::size_t step = 0; step < rotation.steps; ++step) {
          const SimulatedCell& cell = rotation.at(laser, step);
          ASSERT_EQ(cell.object, std::isnan(cell.x) ? 0 : 1 + (laser + step) % 2);
        }
    }
  // Two clusters up to the gap, one beyond it.
  const std::vector<SimulatedCell> returns = returnsOf(scanOf("sheets", 64, 160));
  EXPECT_EQ(objectsOfClusters(returns, 0.4), (std::vector<std::set<std::uint32_t>>{{1}, {2}}));
  EXPECT_EQ(objectsOfClusters(returns, 0.5).size(), 1U);
}

TEST(Cases, SingletonsAreFartherThanTheGapFromEachOther) {
  for (const std::string& sensor : simulatedSensors())
    for (const double gap : {kGap, 1.5}) {
      const SimulatedScan rotation = scanOf("singletons", 48, 150, sensor, gap);
      const std::vector<SimulatedCell> returns = returnsOf(rotation);
      EXPECT_GT(leastDistance(returns, false), gap) << sensor;
      EXPECT_GT(returns.size(), rotation.cells.size() * 19 / 20) << sensor;
    }
  // More cells than positions.
  const SimulatedScan rotation = scanOf("singletons", 32, 150, "hdl64e", 20);
  EXPECT_GT(leastDistance(returnsOf(rotation), false), 20);
  EXPECT_GT(rotation.returns(), 100U);
  EXPECT_LT(rotation.returns(), rotation.cells.size() / 2);
}

TEST(Cases, BlockedSensorHasReturnsWithin30Centimetres) {
  for (const double noise : {0.0, 0.02, 1.0}) {
    const SimulatedScan rotation = scanCase("blocked", makeSensor("hdl64e"), {1, noise, 0.005}, kGap);
    const std::vector<SimulatedCell> returns = returnsOf(rotation);
    EXPECT_GT(returns.size(), 70000U);
    for (const SimulatedCell& cell : returns) ASSERT_LT(rangeOf(cell), 0.3);
  }
}

TEST(Cases, PolesAreSeparateClusters) {
  const SimulatedScan rotation = scanOf("poles", 64, 1125);
  std::vector<SimulatedCell> returns;
  for (std::size_t laser = 8; laser < 40; laser += 2)  // two neighbours on one pole are within 0.4 m even so
    for (std::size_t step = 0; step < 560; ++step)
      if (!std::isnan(rotation.at(laser, step).x)) returns.push_back(rotation.at(laser, step));
  const auto clusters = objectsOfClusters(returns, 0.4);
  EXPECT_GT(clusters.size(), 90U);
  std::set<std::uint32_t> seen;
  for (const auto& objects : clusters) {
    EXPECT_EQ(objects.size(), 1U);
    seen.insert(objects.begin(), objects.end());
  }
  EXPECT_EQ(seen.size(), clusters.size()) << "each pole is one cluster";
  EXPECT_EQ(seen.count(0), 0U);
}

TEST(Cases, AreEqualForEqualSeedsOnly) {
  const auto bytes = [](const std::string& name, std::uint64_t seed) {
    const SimulatedScan rotation = scanCase(name, makeSensor("vlp16"), {seed}, kGap);
    return std::string(reinterpret_cast<const char*>(rotation.cells.data()),
                       rotation.cells.size() * sizeof(SimulatedCell));
  };
  for (const std::string& name : caseNames()) {
    EXPECT_TRUE(bytes(name, 1) == bytes(name, 1)) << name;
    EXPECT_FALSE(bytes(name, 1) == bytes(name, 2)) << name;
  }
}

TEST(Cases, HaveDropOutsAndTheSizeOfTheirSensor) {
  for (const std::string& name : caseNames()) {
    SCOPED_TRACE(name);
    const Sensor sensor = makeSensor("os1-128", 20, 500);
    const SimulatedScan whole = scanCase(name, sensor, {1, 0.02, 0}, kGap);
    const SimulatedScan half = scanCase(name, sensor, {1, 0.02, 0.5}, kGap);
    EXPECT_EQ(whole.lasers, 20U);
    EXPECT_EQ(whole.steps, 500U);
    ASSERT_EQ(whole.cells.size(), 10000U);
    EXPECT_NEAR(static_cast<double>(half.returns()) / static_cast<double>(whole.returns()), 0.5, 0.03);
    for (const SimulatedCell& cell : half.cells) ASSERT_EQ(std::isnan(cell.x), cell.object == 0);
  }
  EXPECT_THROW(scanOf("rooms"), std::invalid_argument);
  EXPECT_THROW(describeCase(""), std::invalid_argument);
}

}  // namespace
}  // namespace lisco_simulation
