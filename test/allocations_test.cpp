// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// A program for itself: refused_allocations.cpp replaces operator new.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <vector>

#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/ground_filter.h"
#include "lisco/label_clusters.h"
#include "lisco/window_clusterer.h"
#include "random.h"
#include "refused_allocations.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kSteps = 720;
constexpr std::size_t kLasers = 16;

/// A street with walls, objects and near returns: one turn, column by column.
std::vector<std::vector<lisco::Return>> oneTurn() {
  Random random(1);
  std::vector<std::vector<lisco::Return>> columns(kSteps);
  for (std::size_t step = 0; step < kSteps; ++step)
    for (std::size_t laser = 0; laser < kLasers; ++laser) {
      const double azimuth = 2 * kPi * static_cast<double>(step) / static_cast<double>(kSteps);
      double range = std::min(30.0, 8 / std::fabs(std::sin(azimuth) + 1e-9));
      if (step / 20 % 3 == 0) range = 4 + static_cast<double>(step % 7) / 100;
      if (step / 40 % 4 == 1 && laser > 12) range = 0.6;
      if (random.chance(0.1)) range = 0;
      const double elevation = 0.03 * (8 - static_cast<double>(laser));
      columns[step].push_back(
          {static_cast<float>(range * std::cos(azimuth)), static_cast<float>(range * std::sin(azimuth)),
           static_cast<float>(range * std::tan(elevation)), static_cast<std::uint32_t>(step * kLasers + laser)});
    }
  return columns;
}

/// Number of allocations in the second half of so many calls of turn ().
template <typename Turn>
std::size_t allocationsOf(int turns, Turn&& turn) {
  std::size_t before = 0;
  for (int i = 0; i < turns; ++i) {
    if (i == turns / 2) before = allocationCount();
    turn();
  }
  return allocationCount() - before;
}

TEST(Allocations, GroundFilterAllocatesNothingAfterBegin) {
  const auto columns = oneTurn();
  lisco::GroundFilter filter;
  filter.begin({}, kLasers);
  std::size_t decided = 0;
  const auto visit = [&](std::size_t, const std::uint8_t*, std::size_t) { ++decided; };
  const std::size_t before = allocationCount();
  for (int turn = 0; turn < 3; ++turn)
    for (const auto& column : columns) filter.addColumn(column.data(), column.size(), visit);
  filter.finish(visit);
  filter.begin({}, kLasers);
  EXPECT_EQ(allocationCount(), before);
  EXPECT_EQ(decided, 3 * kSteps);
}

TEST(Allocations, GroundFilterAllocatesNothingAfterItIsCopied) {
  const auto columns = oneTurn();
  const auto ignore = [](std::size_t, const std::uint8_t*, std::size_t) {};
  lisco::GroundFilter filter;
  filter.begin({}, kLasers);
  filter.begin({}, kLasers / 2);
  for (int i = 0; i < 16; ++i) filter.addColumn(columns[0].data(), 2, ignore);  // of two lasers
  lisco::GroundFilter assigned;
  assigned = filter;
  lisco::GroundFilter copy(filter);
  const std::size_t before = allocationCount();
  for (lisco::GroundFilter* const one : {&copy, &assigned}) {
    for (const auto& column : columns) one->addColumn(column.data(), kLasers / 2, ignore);
    one->begin({}, kLasers);
    for (const auto& column : columns) one->addColumn(column.data(), kLasers, ignore);
  }
  EXPECT_EQ(allocationCount(), before);
}

TEST(Allocations, AreCounted) {
  EXPECT_EQ(allocationsOf(2, [] { ::operator delete(::operator new(1)); }), 1U);
  constexpr std::align_val_t kLine{64};
  EXPECT_EQ(allocationsOf(2, [] { ::operator delete(::operator new(1, kLine), kLine); }), 1U);
}

TEST(Allocations, NoneForLabelsOfAScanLikeTheLastOne) {
  const auto columns = oneTurn();
  lisco::ClusterLabeller labeller;
  lisco::LabelParameters parameters;
  parameters.tolerance = 0.5F;
  parameters.lasers = kLasers;
  std::vector<std::int32_t> labels(kSteps * kLasers);
  std::size_t clusters = 0;
  EXPECT_EQ(allocationsOf(4,
                          [&] {
                            clusters = labeller.label(
                                labels.size(),
                                [&](std::size_t laser, std::size_t column) { return columns[column][laser]; },
                                parameters, labels.data());
                          }),
            0U);
  EXPECT_GT(clusters, 1U);
}

/// Bytes of all memory that malloc () has given, of which operator new is a part; 0 under sanitizers.
std::size_t bytesInUse() {
  const auto state = mallinfo2();
  return state.uordblks + state.hblkhd;
}

// A clusterer has two planes of bricks in memory, which take turns: an odd number of planes must change nothing.
TEST(Allocations, KeepNoMoreAfterASecondRotation) {
  constexpr std::size_t kColumns = 200;
  constexpr std::size_t kRows = 20;
  for (const std::size_t lasers : {std::size_t{1}, kRows})
    for (const double size : {5.0, 6.0, 7.0, 8.0, 9.0, 10.0}) {
      Random random(3);
      std::vector<lisco::Return> returns;
      for (std::size_t i = 0; i < kColumns * kRows; ++i) {
        const double most = random.chance(0.9) ? 0.5 : size;  // most of them in one plane
        const auto coordinate = [&] { return static_cast<float>(random.between(0.1, most)); };
        returns.push_back({coordinate(), coordinate(), coordinate(), static_cast<std::uint32_t>(i)});
      }
      lisco::ColumnClusterer clusterer;
      lisco::Parameters parameters;
      parameters.tolerance = 0.1F;
      const std::size_t columns = returns.size() / lasers;
      std::size_t after_first = 0;
      for (int rotation = 0; rotation < 2; ++rotation) {
        clusterer.begin(parameters);
        clusterer.addColumns(columns, lasers,
                             [&](std::size_t laser, std::size_t column) { return returns[laser * columns + column]; });
        clusterer.update();
        if (rotation == 0) after_first = bytesInUse();
      }
      EXPECT_EQ(bytesInUse(), after_first) << lasers << " lasers, " << size << " m";
    }
}

TEST(Allocations, NoneForARotationLikeTheLastOne) {
  const auto columns = oneTurn();
  lisco::ColumnClusterer clusterer;
  lisco::Parameters parameters;
  parameters.tolerance = 0.5F;
  for (const int steps_per_turn : {0, static_cast<int>(kSteps)}) {
    parameters.sensor.steps_per_turn = steps_per_turn;
    parameters.sensor.elevation_step = 0.03F;
    std::size_t returns = 0;
    EXPECT_EQ(allocationsOf(4,
                            [&] {
                              clusterer.begin(parameters);
                              for (const auto& column : columns) {
                                clusterer.addColumn(column.data(), column.size());
                                if (column.front().source_index % 512 == 0) clusterer.update();
                              }
                              clusterer.update();
                              clusterer.forEachRun(
                                  [&](const std::uint32_t*, std::size_t count, std::uint32_t) { returns += count; });
                            }),
              0U)
        << steps_per_turn;
    EXPECT_EQ(returns, 4 * clusterer.returnCount());
  }
}

// Shares follow the work of the last rotation, and threads' times in the 4th, 12th and 28th one, then in every 16th.
TEST(Allocations, NoneByThreadsWithSettledShares) {
  const auto columns = oneTurn();
  lisco::ColumnClusterer clusterer;
  lisco::Parameters parameters;
  parameters.tolerance = 0.5F;
  parameters.sensor.steps_per_turn = kSteps;
  parameters.sensor.elevation_step = 0.03F;
  for (const std::size_t threads : {2, 3}) {
    parameters.threads = threads;
    for (int turn = 0; turn < 30; ++turn) {
      clusterer.begin(parameters);
      clusterer.addColumns(kSteps, kLasers,
                           [&](std::size_t laser, std::size_t column) { return columns[column][laser]; });
      clusterer.update();
    }
    EXPECT_EQ(allocationsOf(8,
                            [&] {
                              clusterer.begin(parameters);
                              clusterer.addColumns(kSteps, kLasers, [&](std::size_t laser, std::size_t column) {
                                return columns[column][laser];
                              });
                              clusterer.update();
                              clusterer.forEachRun([](const std::uint32_t*, std::size_t, std::uint32_t) {});
                            }),
              0U)
        << threads;
  }
}

TEST(Allocations, NoneForAContinuingEndlessStream) {
  const auto columns = oneTurn();
  lisco::EndlessClusterer clusterer;
  lisco::EndlessParameters parameters;
  parameters.tolerance = 0.5F;
  parameters.columns_per_turn = kSteps;
  std::size_t delivered = 0;
  std::size_t most_held = 0;
  clusterer.begin(parameters, [&](const lisco::EndlessCluster& cluster) { delivered += cluster.size(); });
  EXPECT_EQ(allocationsOf(12,
                          [&] {
                            for (const auto& column : columns) clusterer.addColumn(column.data(), column.size());
                            most_held = std::max(most_held, clusterer.returnsHeld());
                          }),
            0U);
  clusterer.finish();
  EXPECT_EQ(delivered, clusterer.returnCount());
  EXPECT_LE(most_held, 2 * kSteps * kLasers + kSteps);
}

// A window of a turn has 17 panes in memory, each of which must have held all 16 parts of the turn.
TEST(Allocations, NoneForContinuingWindows) {
  const auto columns = oneTurn();
  for (const std::size_t window : {90U, 720U, 1440U}) {
    lisco::WindowClusterer clusterer;
    clusterer.begin({0.5F, window, 45, kLasers});
    std::size_t returns = 0;
    EXPECT_EQ(allocationsOf(70,
                            [&] {
                              for (const auto& column : columns) {
                                if (!clusterer.addColumn(column.data(), column.size())) continue;
                                clusterer.forEachRun(
                                    [&](const std::uint32_t*, std::size_t count, std::uint32_t) { returns += count; });
                              }
                            }),
              0U)
        << window;
    EXPECT_GT(returns, 0U);
  }
}

/// Refuses each allocation of work () in turn, each time with another worker, which must succeed afterwards.
/// \param make callable as std::function<std::size_t ()> (): a new worker
template <typename Make>
void refuseEachAllocation(Make&& make) {
  const std::size_t expected = make()();
  std::size_t refused = 0;
  for (bool done = false; !done; ++refused) {
    ASSERT_LT(refused, 10000U);
    const auto work = make();
    try {
      const RefusedAllocation refusal(refused + 1);
      EXPECT_EQ(work(), expected);
      done = true;  // all allocations were granted
    } catch (const std::bad_alloc&) {
    }
    ASSERT_EQ(work(), expected) << "after allocation " << refused << " had been refused";
  }
  EXPECT_GT(refused, 10U);
}

TEST(Allocations, ClustererStaysUsableAfterARefusal) {
  const auto columns = oneTurn();
  for (const std::size_t threads : {1U, 2U})
    for (const int steps_per_turn : {0, static_cast<int>(kSteps)})
      refuseEachAllocation([&] {
        const auto clusterer = std::make_shared<lisco::ColumnClusterer>();
        return std::function<std::size_t()>([&columns, clusterer, steps_per_turn, threads] {
          lisco::Parameters parameters;
          parameters.tolerance = 0.5F;
          parameters.expected_returns = 10;
          parameters.threads = threads;
          parameters.sensor.steps_per_turn = steps_per_turn;
          parameters.sensor.elevation_step = 0.03F;
          clusterer->begin(parameters);
          if (threads > 1)
            clusterer->addColumns(columns.size(), kLasers,
                                  [&](std::size_t laser, std::size_t column) { return columns[column][laser]; });
          else
            for (const auto& column : columns) clusterer->addColumn(column.data(), column.size());
          clusterer->update();
          std::size_t sum = clusterer->subclusterCount();
          // Numbers of subclusters depend on how the columns are divided among threads; their sizes do not.
          clusterer->forEachRun([&](const std::uint32_t*, std::size_t count, std::uint32_t subcluster) {
            sum += count * clusterer->sizeOf(subcluster);
          });
          return sum;
        });
      });
}

TEST(Allocations, StreamsStayUsableAfterARefusal) {
  const auto columns = oneTurn();
  refuseEachAllocation([&] {
    const auto clusterer = std::make_shared<lisco::EndlessClusterer>();
    return std::function<std::size_t()>([&columns, clusterer] {
      lisco::EndlessParameters parameters;
      parameters.tolerance = 0.5F;
      parameters.columns_per_turn = kSteps;
      std::size_t sum = 0;
      clusterer->begin(parameters,
                       [&sum](const lisco::EndlessCluster& cluster) { sum += cluster.size() * cluster.size(); });
      for (const auto& column : columns) clusterer->addColumn(column.data(), column.size());
      clusterer->finish();
      return sum;
    });
  });
  refuseEachAllocation([&] {
    const auto clusterer = std::make_shared<lisco::WindowClusterer>();
    return std::function<std::size_t()>([&columns, clusterer] {
      clusterer->begin({0.5F, 180, 45, kLasers});
      std::size_t sum = 0;
      for (const auto& column : columns)
        if (clusterer->addColumn(column.data(), column.size())) sum += clusterer->subclusterCount();
      return sum;
    });
  });
}

}  // namespace
}  // namespace lisco_test
