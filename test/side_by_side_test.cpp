// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Several instances of each clusterer run at the same time, each with its own threads. Also to be run under
// ThreadSanitizer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "column_streams.h"
#include "engine.h"
#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/window_clusterer.h"
#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

/// Clusters something repeatedly, with an instance per task. \return what was wrong; empty if nothing
using Task = std::function<std::string()>;

// Often enough for the tasks to overlap.
constexpr int kRotations = 3;
constexpr int kStreams = 40;

Task rotationTask(Random& random) {
  Scan scan = largeScan(random);
  for (lisco::Return& cell : scan.cells)
    if (random.chance(0.7)) cell = {0, 0, 0, cell.source_index};
  lisco::Parameters parameters;
  parameters.tolerance = static_cast<float>(random.magnitude(0.05, 0.7));
  parameters.threads = random.oneOf(std::array<std::size_t, 4>{2, 3, 4, 0});
  if (random.chance(0.7)) {
    parameters.sensor = hintsFor(static_cast<int>(std::clamp<std::size_t>(scan.columns, 512, 16384)),
                                 static_cast<float>(random.magnitude(0.005, 0.3)), random.chance(0.5));
  }
  const bool by_columns = random.chance(0.2);
  return [scan, parameters, by_columns, right = trueClusters(scan.points(), parameters.tolerance)] {
    lisco::ColumnClusterer clusterer;
    for (int i = 0; i < kRotations; ++i) {
      clusterer.begin(parameters);
      if (by_columns)
        for (std::size_t column = 0; column < scan.columns; ++column)
          clusterer.addColumn(scan.column(column).data(), scan.lasers);
      else
        clusterer.addColumns(scan.columns, scan.lasers,
                             [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); });
      const std::string wrong = difference(right, clustersOf(clusterer));
      if (!wrong.empty()) return wrong;
    }
    return std::string();
  };
}

Task windowTask(Random& random) {
  const ColumnStream stream = randomColumnStream(random);
  lisco::WindowParameters parameters;
  parameters.tolerance = stream.parameters.tolerance;
  parameters.hop_columns = 1 + random.below(30);
  parameters.window_columns = parameters.hop_columns * (1 + random.below(6));
  std::vector<Clustering> right;
  for (std::size_t end = parameters.hop_columns; end <= stream.columns.size(); end += parameters.hop_columns)
    right.push_back(
        trueClusters(pointsOf(stream, end - std::min(end, parameters.window_columns), end), parameters.tolerance));
  return [stream, parameters, right] {
    lisco::WindowClusterer clusterer;
    for (int i = 0; i < kStreams; ++i) {
      clusterer.begin(parameters);
      std::size_t window = 0;
      for (const StreamColumn& column : stream.columns) {
        if (!clusterer.addColumn(column.cells.data(), column.cells.size())) continue;
        const std::string wrong = difference(right[window++], clustersOf(clusterer));
        if (!wrong.empty()) return wrong;
      }
    }
    return std::string();
  };
}

Task endlessTask(Random& random) {
  const ColumnStream stream = randomColumnStream(random);
  return [stream, truth = endlessTruth(stream).deliveries] {
    lisco::EndlessClusterer clusterer;
    for (int i = 0; i < kStreams; ++i) {
      const std::string wrong = wrongDeliveries(stream, truth, deliveriesOf(clusterer, stream), {}, true);
      if (!wrong.empty()) return wrong;
    }
    return std::string();
  };
}

TEST(SideBySide, InstancesAreIndependent) {
  using MakeTask = Task (*)(Random&);
  constexpr std::array<MakeTask, 3> kKinds{rotationTask, windowTask, endlessTask};
  for (std::uint64_t seed = 1; seed <= timesEffort(25); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    std::vector<Task> tasks;
    for (const MakeTask make : kKinds) {
      if (random.chance(0.2)) continue;
      tasks.push_back(make(random));
      tasks.push_back(make(random));
    }
    std::vector<std::string> wrong(tasks.size());
    std::vector<std::thread> threads;
    std::atomic<std::size_t> waiting{tasks.size()};
    for (std::size_t i = 0; i < tasks.size(); ++i)
      threads.emplace_back([&, i] {
        --waiting;
        while (waiting > 0) std::this_thread::yield();
        wrong[i] = tasks[i]();
      });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& one : wrong) ASSERT_EQ(one, "");
  }
}

}  // namespace
}  // namespace lisco_test
