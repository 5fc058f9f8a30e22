// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <utility>

#include "lisco/simd.h"
#include "verifier.h"

namespace lisco_test {

const std::vector<Setting>& allSettings() {
  static const std::vector<Setting> settings = [] {
    std::vector<Setting> all;
    const auto add = [&all](const std::string& name, std::size_t block, std::size_t threads = 1) {
      lisco::Parameters parameters;
      parameters.block_columns = block;
      parameters.threads = threads;
      parameters.expected_returns = 200;
      all.push_back({name, parameters});
      return &all.back().parameters;
    };
    add("no hints", 64);
    add("no hints, blocks of 16", 16);
    add("no hints, blocks of 3", 3);
    add("no hints, each column at once", 1);
    add("no hints, no memory reserved", 64)->expected_returns = 0;
    add("no hints, displaced sensor", 16)->sensor.origin = {3.0F, -20.0F, 1.5F};
    add("no hints, two threads", 64, 2);
    const auto image = [&add](const std::string& name, int steps, float elevation_step, bool clockwise,
                              std::size_t block, std::size_t threads = 1) {
      lisco::Parameters* const parameters = add(name, block, threads);
      parameters->sensor.steps_per_turn = steps;
      parameters->sensor.elevation_step = elevation_step;
      parameters->sensor.clockwise = clockwise;
      return parameters;
    };
    image("few bins", 512, 0.5F, false, 64);
    image("few bins, clockwise", 600, 0.1F, true, 16);
    image("few bins, column by column", 512, 0.3F, false, 1);
    image("few bins, blocks of 3", 512, 0.3F, true, 3);
    image("many bins", 2000, 0.02F, true, 64);
    image("very many bins", 16384, 0.01F, false, 5);
    image("few bins, displaced sensor", 720, 0.1F, false, 64)->sensor.origin = {-3.0F, 2.0F, -1.0F};
    image("few bins, three threads", 512, 0.3F, false, 64, 3);
    image("few bins, all threads", 512, 0.3F, false, 16, 0);
    return all;
  }();
  return settings;
}

const std::vector<Setting>& settingsForEachLevel() {
  static const std::vector<Setting> settings = [] {
    std::vector<Setting> some;
    for (const Setting& setting : allSettings())
      if (setting.name == "no hints" || setting.name == "few bins" || setting.name == "few bins, blocks of 3")
        some.push_back(setting);
    return some;
  }();
  return settings;
}

std::uint64_t timesEffort(std::uint64_t count) {
  const char* const effort = std::getenv("LISCO_TEST_EFFORT");
  return effort != nullptr ? count * std::strtoull(effort, nullptr, 10) : count;
}

const std::vector<std::string>& levels() {
  static const std::vector<std::string> all = lisco::simdLevels();
  return all;
}

lisco::SensorHints hintsFor(int steps, float elevation_step, bool clockwise) {
  lisco::SensorHints hints;
  hints.steps_per_turn = steps;
  hints.elevation_step = elevation_step;
  hints.clockwise = clockwise;
  return hints;
}

void feed(lisco::ColumnClusterer& clusterer, Random& random, const Scan& scan) {
  const double queries = random.chance(0.5) ? 0.1 : 0.0;
  const std::array<std::size_t, 4> portions{1, 1 + random.below(200), 1 + random.below(200), scan.columns};
  const std::size_t portion = random.oneOf(portions);
  for (std::size_t first = 0; first < scan.columns; first += portion) {
    clusterer.addColumns(std::min(portion, scan.columns - first), scan.lasers,
                         [&](std::size_t laser, std::size_t column) { return scan.at(laser, first + column); });
    if (portion > 10 && random.chance(queries)) clusterer.update();
  }
}

SimdLevel::SimdLevel(const std::string& name) {
  EXPECT_TRUE(lisco::useSimdLevel(name)) << name;
  EXPECT_EQ(lisco::simdLevel(), name);
}

SimdLevel::~SimdLevel() {
  EXPECT_TRUE(lisco::useSimdLevel({}));
}

namespace {

/// Where a return was measured, and its subcluster.
struct Place {
  std::uint32_t laser, column, subcluster;
  bool operator==(const Place& other) const {
    return laser == other.laser && column == other.column && subcluster == other.subcluster;
  }
};

template <typename Clusterer>
std::vector<Place> placesOf(Clusterer& clusterer, const lisco::SizeRange& sizes = {}) {
  std::vector<Place> places;
  clusterer.forEachRun(
      [&](std::uint32_t laser, std::uint32_t column, std::size_t count, std::uint32_t subcluster) {
        for (std::uint32_t i = 0; i < count; ++i) places.push_back({laser, column + i, subcluster});
      },
      sizes);
  return places;
}

/// Visits by place are those by source index, in the order of lasers and columns; those of some sizes leave out none
/// of these.
template <typename Clusterer>
void expectSamePlaces(Clusterer& clusterer, const std::vector<std::uint32_t>& subclusters) {
  std::vector<Place> places = placesOf(clusterer);
  ASSERT_EQ(places.size(), subclusters.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    ASSERT_EQ(places[i].subcluster, subclusters[i]) << i;
    if (i == 0) continue;
    const Place& before = places[i - 1];
    ASSERT_TRUE(before.laser < places[i].laser || (before.laser == places[i].laser && before.column < places[i].column))
        << i;
  }
  const lisco::SizeRange sizes{2, static_cast<std::uint32_t>(places.size() / 2)};
  const auto isOther = [&](const Place& place) {
    const std::uint32_t size = clusterer.sizeOf(place.subcluster);
    return size < sizes.min || size > sizes.max;
  };
  std::vector<Place> some = placesOf(clusterer, sizes);
  for (auto* list : {&some, &places}) list->erase(std::remove_if(list->begin(), list->end(), isOther), list->end());
  EXPECT_TRUE(some == places);
}

template <typename Clusterer>
Clustering visitedBy(Clusterer& clusterer) {
  Clustering clusters(clusterer.subclusterCount());
  std::size_t returns = 0;
  std::vector<std::uint32_t> subclusters;  // in the order of the visits
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
    ASSERT_LT(subcluster, clusters.size());
    subclusters.insert(subclusters.end(), count, subcluster);
    EXPECT_GT(count, 0U);
    std::vector<std::uint32_t>& members = clusters[subcluster].members;
    members.insert(members.end(), source_indices, source_indices + count);
    returns += count;
  });
  EXPECT_EQ(returns, clusterer.returnCount());
  expectSamePlaces(clusterer, subclusters);
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    EXPECT_FALSE(clusters[i].members.empty()) << "subcluster " << i << " holds no return";
    clusters[i].reported_size = clusterer.sizeOf(i);
  }
  return inOrder(std::move(clusters));
}

}  // namespace

Clustering clustersOf(lisco::ColumnClusterer& clusterer) {
  clusterer.update();
  return visitedBy(clusterer);
}

Clustering clustersOf(lisco::WindowClusterer& clusterer) {
  return visitedBy(clusterer);
}

Clustering cluster(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance, const Setting& setting) {
  lisco::Parameters parameters = setting.parameters;
  parameters.tolerance = tolerance;
  clusterer.begin(parameters);
  clusterer.addColumns(scan.columns, scan.lasers,
                       [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); });
  return clustersOf(clusterer);
}

bool expectExact(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance) {
  const std::vector<Point> points = scan.points();
  const Clustering right = trueClusters(points, tolerance);
  bool all_right = true;
  const auto expectRight = [&](const Setting& setting) {
    const std::string wrong = difference(right, cluster(clusterer, scan, tolerance, setting));
    EXPECT_EQ(wrong, "") << setting.name << ", " << lisco::simdLevel() << ", tolerance " << std::hexfloat << tolerance
                         << std::defaultfloat << " = " << tolerance << ", " << scan.lasers << " x " << scan.columns;
    all_right = all_right && wrong.empty();
  };
  for (const Setting& setting : allSettings()) expectRight(setting);
  for (const std::string& name : levels()) {
    const SimdLevel level(name);
    for (const Setting& setting : settingsForEachLevel()) expectRight(setting);
  }
  const std::vector<std::string> violated =
      violations(points, cluster(clusterer, scan, tolerance, allSettings().front()), tolerance);
  EXPECT_TRUE(violated.empty()) << violated.front();
  return all_right && violated.empty();
}

}  // namespace lisco_test
