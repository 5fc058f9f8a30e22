// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "engine.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "verifier.h"

namespace lisco_test {

const std::vector<Setting>& allSettings() {
  static const std::vector<Setting> settings = [] {
    using Mask = lisco::Parameters::Mask;
    constexpr std::size_t kForever = std::numeric_limits<std::size_t>::max();
    std::vector<Setting> all;
    const auto add = [&all](const std::string& name, Mask mask, std::size_t block, std::size_t open) {
      lisco::Parameters parameters;
      parameters.mask = mask;
      parameters.block_columns = block;
      parameters.open_columns = open;
      parameters.expected_returns = 200;
      all.push_back({name + (mask == Mask::kView ? ", view" : ", grid"), parameters});
      return &all.back().parameters;
    };
    for (const Mask mask : {Mask::kView, Mask::kGrid}) {
      add("default", mask, 64, 16);
      add("blocks of 16", mask, 16, 16);
      add("each column at once", mask, 1, 1);
      add("blocks of 3", mask, 3, 16);
      add("open to the end", mask, 64, kForever);
      add("column by column, open to the end", mask, 1, kForever);
    }
    lisco::ViewHints& finest = add("finest tiles", Mask::kView, 3, 1)->view;
    finest.azimuth_step = 0.0F;
    finest.elevation_step = 0.0F;
    lisco::ViewHints& coarsest = add("coarsest tiles", Mask::kView, 16, 16)->view;
    coarsest.azimuth_step = 10.0F;
    coarsest.elevation_step = 10.0F;
    const auto strip = [&add](const std::string& name, int steps, float elevation_step, bool clockwise,
                              std::size_t block) {
      lisco::ViewHints& view = add(name, Mask::kView, block, 16)->view;
      view.steps_per_turn = steps;
      view.elevation_step = elevation_step;
      view.clockwise = clockwise;
    };
    strip("strip of few places", 512, 0.5F, false, 64);
    strip("strip of few places, clockwise", 600, 0.1F, true, 16);
    strip("strip column by column", 512, 0.3F, false, 1);
    strip("strip of many places", 2000, 0.02F, true, 64);
    strip("strip of very many places", 16384, 0.01F, false, 5);
    strip("strip, sensor elsewhere", 360, 0.05F, false, 64);
    all.back().parameters.view.origin = {-3.0F, 2.0F, -1.0F};
    add("sensor elsewhere", Mask::kView, 16, 16)->view.origin = {3.0F, -20.0F, 1.5F};
    add("few slots", Mask::kGrid, 16, 16)->expected_returns = 0;
    return all;
  }();
  return settings;
}

Clustering clustersOf(lisco::ColumnClusterer& clusterer) {
  clusterer.update();
  std::map<std::uint32_t, Cluster> by_head;
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t head) {
    EXPECT_LT(head, clusterer.headLimit());
    EXPECT_GT(count, 0U);
    Cluster& group = by_head[head];
    group.members.insert(group.members.end(), source_indices, source_indices + count);
    group.claimed_size = clusterer.weight(head);
  });
  Clustering clusters;
  for (auto& [head, group] : by_head) clusters.push_back(std::move(group));
  return inOrder(std::move(clusters));
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
  for (const Setting& setting : allSettings()) {
    const Clustering found = cluster(clusterer, scan, tolerance, setting);
    const std::string wrong = difference(right, found);
    EXPECT_EQ(wrong, "") << setting.name << ", tolerance " << std::hexfloat << tolerance << std::defaultfloat << " = "
                         << tolerance << ", " << scan.lasers << " x " << scan.columns;
    all_right = all_right && wrong.empty();
  }
  const std::vector<std::string> violated =
      violations(points, cluster(clusterer, scan, tolerance, allSettings().front()), tolerance);
  EXPECT_TRUE(violated.empty()) << violated.front();
  return all_right && violated.empty();
}

}  // namespace lisco_test
