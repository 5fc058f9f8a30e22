// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The engine's threads: rotations large enough for them, whose subclusters are those of one thread.
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>  // alarm

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/processors.h"
#include "engine.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

lisco::Parameters parametersFor(Random& random, const Scan& scan, std::size_t threads) {
  lisco::Parameters parameters;
  parameters.tolerance = static_cast<float>(random.magnitude(0.05, 0.7));
  parameters.threads = threads;
  if (random.chance(0.7)) {
    parameters.sensor.steps_per_turn = static_cast<int>(std::clamp<std::size_t>(scan.columns, 512, 16384));
    parameters.sensor.elevation_step = static_cast<float>(random.magnitude(0.005, 0.3));
    parameters.sensor.clockwise = random.chance(0.5);
  }
  return parameters;
}

constexpr std::array<std::size_t, 7> kThreads{2, 3, 8, 0, 5, 100, 2};

Clustering clustered(lisco::ColumnClusterer& clusterer, const lisco::Parameters& parameters, const Scan& scan) {
  clusterer.begin(parameters);
  clusterer.addColumns(scan.columns, scan.lasers,
                       [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); });
  return clustersOf(clusterer);
}

/// The runs, in the order of their visits.
std::vector<std::uint32_t> visited(lisco::ColumnClusterer& clusterer) {
  std::vector<std::uint32_t> all;
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t) {
    all.insert(all.end(), source_indices, source_indices + count);
  });
  return all;
}

/// The same from both ends, put together.
std::vector<std::uint32_t> visitedFromBothEnds(lisco::ColumnClusterer& clusterer) {
  std::vector<std::uint32_t> from_first;
  std::vector<std::uint32_t> from_last;
  clusterer.forEachRunFromBothEnds(
      [&](lisco::RunVisitor::From from, const std::uint32_t* source_indices, std::size_t count, std::uint32_t) {
        if (from == lisco::RunVisitor::From::kFirst)
          from_first.insert(from_first.end(), source_indices, source_indices + count);
        else
          for (std::size_t i = count; i-- > 0;) from_last.push_back(source_indices[i]);
      });
  from_first.insert(from_first.end(), from_last.rbegin(), from_last.rend());
  return from_first;
}

/// Takes single returns several at once.
struct ReturnVisit {
  std::vector<std::array<std::uint32_t, 2>> returns;  ///< source indices and subclusters
  std::size_t taken_at_once = 0;

  void operator()(const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
    for (std::size_t i = 0; i < count; ++i) returns.push_back({source_indices[i], subcluster});
  }
  void operator()(const std::uint32_t* source_indices, std::size_t count, const std::uint32_t* subclusters) {
    for (std::size_t i = 0; i < count; ++i) returns.push_back({source_indices[i], subclusters[i]});
    taken_at_once += count;
  }
};

/// The same by place, of a cloud of one laser.
struct PlaceVisit {
  ReturnVisit& visit;

  void operator()(std::uint32_t laser, std::uint32_t column, std::size_t count, std::uint32_t subcluster) const {
    EXPECT_EQ(laser, 0U);
    for (std::uint32_t i = 0; i < count; ++i) visit.returns.push_back({column + i, subcluster});
  }
  void operator()(std::uint32_t laser, const std::uint32_t* columns, std::size_t count,
                  const std::uint32_t* subclusters) const {
    EXPECT_EQ(laser, 0U);
    visit(columns, count, subclusters);
  }
};

TEST(Visits, HandOnSingleReturnsTogether) {
  constexpr std::size_t kReturns = 5001;
  Random random(1);
  std::vector<lisco::Return> cells(kReturns);
  for (std::size_t i = 0; i < kReturns; ++i) {
    for (float* coordinate : {&cells[i].x, &cells[i].y, &cells[i].z})
      *coordinate = static_cast<float>(random.between(1.0, 12.0));
    cells[i].source_index = static_cast<std::uint32_t>(i);
  }
  lisco::Parameters parameters;
  parameters.tolerance = 0.4F;
  lisco::ColumnClusterer clusterer;
  clusterer.begin(parameters);
  clusterer.addColumns(kReturns, 1, [&](std::size_t, std::size_t column) { return cells[column]; });
  clusterer.update();
  ReturnVisit one_by_one;
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
    one_by_one(source_indices, count, subcluster);
  });
  ReturnVisit at_once;
  clusterer.forEachRun(at_once);
  EXPECT_EQ(one_by_one.returns.size(), kReturns);
  EXPECT_EQ(at_once.returns, one_by_one.returns);
  EXPECT_EQ(at_once.taken_at_once, kReturns);
  ReturnVisit by_place;
  clusterer.forEachRun(PlaceVisit{by_place});
  EXPECT_EQ(by_place.returns, one_by_one.returns);
  EXPECT_EQ(by_place.taken_at_once, kReturns);
}

// One object with changing numbers of threads, some of them more than the lasers.
TEST(Threads, GiveTheSubclustersOfOneThread) {
  lisco::ColumnClusterer alone;
  lisco::ColumnClusterer together;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(60); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan scan = largeScan(random);
    lisco::Parameters parameters = parametersFor(random, scan, 1);
    const Clustering right = clustered(alone, parameters, scan);
    parameters.threads = random.oneOf(kThreads);
    ASSERT_EQ(difference(right, clustered(together, parameters, scan)), "") << parameters.threads << " threads";
    ASSERT_EQ(together.returnCount(), alone.returnCount());
    const std::vector<std::uint32_t> order = visited(together);
    ASSERT_EQ(order, visited(alone));
    ASSERT_TRUE(std::is_sorted(order.begin(), order.end())) << "not laser by laser";
    ASSERT_EQ(order, visitedFromBothEnds(together));
    ASSERT_EQ(order, visitedFromBothEnds(alone));
    together.update();
    ASSERT_EQ(difference(right, clustersOf(together)), "") << "updated once more";
  }
}

TEST(Threads, EqualTheOracle) {
  lisco::ColumnClusterer clusterer;
  for (std::uint64_t seed = 1000; seed < 1000 + timesEffort(40); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Scan scan = largeScan(random);
    for (lisco::Return& cell : scan.cells)
      if (random.chance(0.6)) cell = {0, 0, 0, cell.source_index};
    const lisco::Parameters parameters = parametersFor(random, scan, random.oneOf(kThreads));
    ASSERT_EQ(difference(trueClusters(scan.points(), parameters.tolerance), clustered(clusterer, parameters, scan)),
              "");
  }
}

// Columns that follow those read by threads, also with more lasers, and queries in between.
TEST(Threads, AcceptMoreColumnsAfterwards) {
  lisco::ColumnClusterer alone;
  lisco::ColumnClusterer together;
  for (std::uint64_t seed = 2000; seed < 2000 + timesEffort(60); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scan first = largeScan(random);
    const Scan second = largeScan(random);
    lisco::Parameters parameters = parametersFor(random, first, random.oneOf(kThreads));
    parameters.block_columns = random.chance(0.5) ? 64 : 1 + random.below(64);
    const bool look_between = random.chance(0.5);
    const bool whole = random.chance(0.4);
    const double queries = random.chance(0.5) ? 0.02 : 0.0;
    std::vector<Clustering> clusterings;
    for (lisco::ColumnClusterer* clusterer : {&alone, &together}) {
      Random own(seed);
      if (clusterer == &alone)
        parameters.threads = 1;
      else
        parameters.threads = own.oneOf(kThreads);
      clusterer->begin(parameters);
      clusterer->addColumns(first.columns, first.lasers,
                            [&](std::size_t laser, std::size_t column) { return first.at(laser, column); });
      if (look_between && clusterer == &together) clusterer->update();
      for (std::size_t column = 0; column < second.columns;) {
        const std::size_t count = whole ? second.columns : std::min(second.columns - column, 1 + own.below(100));
        clusterer->addColumns(count, second.lasers, [&](std::size_t laser, std::size_t c) {
          lisco::Return cell = second.at(laser, column + c);
          cell.source_index += static_cast<std::uint32_t>(first.cells.size());
          return cell;
        });
        column += count;
        if (own.chance(queries) && clusterer == &together) clusterer->update();
      }
      clusterings.push_back(clustersOf(*clusterer));
    }
    ASSERT_EQ(difference(clusterings[0], clusterings[1]), "");
    ASSERT_EQ(visited(together), visited(alone));
  }
}

// So many returns with taken bins that no more are placed, by one thread or by all.
TEST(Threads, LinkManyUnplacedReturns) {
  lisco::ColumnClusterer alone;
  lisco::ColumnClusterer together;
  for (std::uint64_t seed = 3000; seed < 3000 + timesEffort(12); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    constexpr std::size_t kLasers = 4;
    Scan scan(6000, kLasers);
    Scan later(1000, kLasers);
    const std::size_t standing = random.below(kLasers);
    for (Scan* one : {&scan, &later})
      for (std::size_t laser = 0; laser < kLasers; ++laser)
        for (std::size_t column = 0; column < one->columns; ++column) {
          // One laser sees the same directions repeatedly.
          const bool stands = laser == standing && one == &scan;
          if (!stands && random.chance(one == &scan ? 0.95 : 0.5)) continue;
          const double turn = static_cast<double>(stands ? column % 300 : column % 1000) / 1000.0;
          const double azimuth = 6.283185307179586 * turn;
          const double rho = random.between(9.0, 11.0);
          one->set(laser, column,
                   {static_cast<float>(rho * std::cos(azimuth)), static_cast<float>(rho * std::sin(azimuth)),
                    static_cast<float>(0.1 * static_cast<double>(laser))});
        }
    lisco::Parameters parameters;
    parameters.tolerance = 0.1F;
    parameters.sensor.steps_per_turn = 1000;
    parameters.sensor.elevation_step = 0.1F;
    const bool look_between = random.chance(0.7);
    std::vector<Clustering> clusterings;
    for (lisco::ColumnClusterer* clusterer : {&alone, &together}) {
      parameters.threads = clusterer == &alone ? 1 : random.oneOf(kThreads);
      if (clusterer == &alone)
        parameters.sensor.steps_per_turn = 0;
      else
        parameters.sensor.steps_per_turn = 1000;
      clusterer->begin(parameters);
      clusterer->addColumns(scan.columns, kLasers,
                            [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); });
      if (look_between) clusterer->update();
      clusterer->addColumns(later.columns, kLasers, [&](std::size_t laser, std::size_t column) {
        lisco::Return cell = later.at(laser, column);
        cell.source_index += static_cast<std::uint32_t>(scan.cells.size());
        return cell;
      });
      clusterings.push_back(clustersOf(*clusterer));
    }
    ASSERT_EQ(difference(clusterings[0], clusterings[1]), "");
  }
}

// The other threads wait while the first one tries what its far returns cost: columns 5 and 100 are read before it
// decides. The program ends by a signal if they wait forever.
TEST(Threads, EndWithAnExceptionOfTheFirst) {
  struct Thrown {};
  constexpr unsigned kMaxSeconds = 120;
  Scan scan(1024, 8);
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const double azimuth = 6.283185307179586 * static_cast<double>(column) / static_cast<double>(scan.columns);
      scan.set(laser, column,
               {static_cast<float>(20 * std::cos(azimuth)), static_cast<float>(20 * std::sin(azimuth)),
                static_cast<float>(0.1 * static_cast<double>(laser))});
    }
  lisco::Parameters parameters;
  parameters.tolerance = 0.11F;  // the returns of one column
  parameters.sensor.steps_per_turn = 1024;
  parameters.sensor.elevation_step = 0.005F;
  lisco::ColumnClusterer alone;
  lisco::ColumnClusterer together;
  const Clustering right = clustered(alone, parameters, scan);
  ASSERT_EQ(right.size(), scan.columns);
  for (const std::size_t threads : {2, 4, 16})
    for (const std::size_t faulty : {5, 100, 300, 1000}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, column " + std::to_string(faulty));
      parameters.threads = threads;
      together.begin(parameters);
      alarm(kMaxSeconds);
      EXPECT_THROW(together.addColumns(scan.columns, scan.lasers,
                                       [&](std::size_t laser, std::size_t column) {
                                         if (column == faulty) throw Thrown();
                                         return scan.at(laser, column);
                                       }),
                   Thrown);
      alarm(0);
      EXPECT_EQ(difference(right, clustered(together, parameters, scan)), "");
    }
}

TEST(Threads, AreEachCalledOnce) {
  EXPECT_GE(lisco::allThreads(), 1U);
  for (const std::size_t threads : {0, 1, 2, 3, 17}) {
    std::vector<std::atomic<int>> calls(threads);
    lisco::inParallel(threads, [&](std::size_t thread) { ++calls.at(thread); });
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(Threads, LeaveTheProcessorOfTheirCaller) {
  if (lisco::currentProcessor() < 0 || lisco::allThreads() < 2) GTEST_SKIP() << "one processor, or an unknown one";
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  std::size_t left = 0;
  for (int attempt = 0; attempt < 20; ++attempt) {  // the system may move the thread back at any time
    const int processor = lisco::currentProcessor();
    lisco::leaveProcessor(processor);
    left += lisco::currentProcessor() != processor ? 1 : 0;
  }
  EXPECT_GE(left, 10U);
  cpu_set_t allowed_afterwards;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed_afterwards, &allowed_afterwards), 0);
  EXPECT_TRUE(CPU_EQUAL(&allowed, &allowed_afterwards));
}

TEST(Threads, StayWhereTheirCallerIsNot) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(lisco::currentProcessor(), &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const int processor = lisco::currentProcessor();
  lisco::leaveProcessor(processor);  // there is no other
  lisco::leaveProcessor(processor + 1);
  lisco::leaveProcessor(-1);
  EXPECT_EQ(lisco::currentProcessor(), processor);
  EXPECT_EQ(sched_setaffinity(0, sizeof allowed, &allowed), 0);
}

TEST(Threads, PassOnExceptions) {
  std::atomic<int> finished{0};
  EXPECT_THROW(lisco::inParallel(3,
                                 [&](std::size_t thread) {
                                   if (thread == 1) throw std::runtime_error("one");
                                   ++finished;
                                 }),
               std::runtime_error);
  EXPECT_EQ(finished, 2);
}

}  // namespace
}  // namespace lisco_test
