// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// How work is spread over the columns of a rotation, and over threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "core/block_scheduler.h"
#include "core/disjoint_sets.h"
#include "core/load_balancer.h"
#include "core/neighbour.h"
#include "core/partition.h"
#include "core/work_shares.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"
#include "random.h"

namespace lisco_test {
namespace {

struct Spent {
  std::vector<std::size_t> per_column;
  std::size_t most_left = 0;  ///< parts
};

/// Rotations of which every block of 64 columns brings parts of work; records the work of each column of the last one.
Spent spend(const std::vector<std::size_t>& work_of_part, std::size_t parts_per_block, std::size_t rotations) {
  lisco::WorkBudget budget;
  Spent spent;
  for (std::size_t rotation = 0; rotation < rotations; ++rotation) {
    budget.begin();
    spent = Spent();
    std::size_t come = 0;
    std::size_t done = 0;
    while (come < work_of_part.size() || done < come) {
      if (spent.per_column.size() % 64 == 0) {
        come = std::min(come + parts_per_block, work_of_part.size());
        budget.plan(come - done, 192);
        spent.most_left = std::max(spent.most_left, come - done);
      }
      budget.addColumns(1);
      std::size_t work = 0;
      for (; done < come && budget.isBehind(); ++done) {
        budget.spend(work_of_part[done], 1);
        work += work_of_part[done];
      }
      spent.per_column.push_back(work);
      if (spent.per_column.size() > 100000) return spent;
    }
  }
  return spent;
}

TEST(BlockScheduler, BlocksBecomeSmallerTowardsTheEndExpected) {
  const std::vector<lisco::Return> column(2, lisco::kNoReturn);
  lisco::BlockScheduler scheduler;
  lisco::Partition partition;
  lisco::DisjointSets subclusters;
  const auto blocksOf = [&](std::size_t columns, std::size_t block_columns) {
    scheduler.begin(block_columns);
    partition.prepare(lisco::Tolerance(0.4F), lisco::SensorHints(), 0);
    std::vector<std::size_t> blocks;
    for (std::size_t i = 0; i < columns; ++i) {
      if (scheduler.isStageEmpty()) blocks.push_back(scheduler.columnsLeft());
      scheduler.add(column.data(), column.size(), partition, subclusters);
    }
    scheduler.finish(partition, subclusters);
    EXPECT_EQ(scheduler.columnsRead(), columns);
    return blocks;
  };
  using Blocks = std::vector<std::size_t>;
  EXPECT_EQ(blocksOf(300, 64), Blocks({64, 64, 64, 64, 64}));  // nothing is expected yet
  EXPECT_EQ(blocksOf(300, 64), Blocks({64, 64, 64, 54, 27, 16, 16}));
  EXPECT_EQ(blocksOf(430, 64), Blocks({64, 64, 64, 54, 27, 16, 16, 64, 64}));  // it went on
  EXPECT_EQ(blocksOf(30, 8), Blocks({8, 8, 8, 8}));
  EXPECT_EQ(blocksOf(30, 8), Blocks({8, 8, 8, 8}));
}

TEST(WorkBudget, SpreadsEvenWorkEvenly) {
  const Spent spent = spend(std::vector<std::size_t>(200 * 50, 7), 200, 3);
  for (std::size_t column = 640; column < 64 * 50; ++column)
    EXPECT_NEAR(static_cast<double>(spent.per_column[column]), 7.0 * 200 / 64, 8.0) << column;
  EXPECT_LT(spent.most_left, 800U);
}

// A tenth of the parts, all adjacent, costs ten times as much as the others.
TEST(WorkBudget, SpreadsDenseWorkEvenly) {
  std::vector<std::size_t> work(200 * 50, 10);
  std::fill(work.begin() + 4000, work.begin() + 5000, 100);
  const Spent spent = spend(work, 200, 5);
  const std::size_t all = std::accumulate(work.begin(), work.end(), std::size_t{0});
  EXPECT_EQ(std::accumulate(spent.per_column.begin(), spent.per_column.end(), std::size_t{0}), all);
  const std::size_t most = *std::max_element(spent.per_column.begin(), spent.per_column.end());
  EXPECT_LT(most, 200 * 100 / 64) << "as much as without spreading beyond the next block";
  EXPECT_LT(spent.most_left, 200U * 25);
}

TEST(WorkBudget, DoesAllWorkAfterAnyRotation) {
  for (const std::size_t work : {std::size_t{1}, std::size_t{1000}, std::size_t{1000000}}) {
    const Spent spent = spend(std::vector<std::size_t>(2000, work), 50, 1);
    EXPECT_EQ(std::accumulate(spent.per_column.begin(), spent.per_column.end(), std::size_t{0}), 2000 * work);
    EXPECT_LT(spent.per_column.size(), 10000U) << work;
  }
}

template <typename CellAt>
std::vector<lisco::LoadBalancer::Part> cut(lisco::LoadBalancer& balancer, std::size_t columns, std::size_t lasers,
                                           CellAt&& cell_at, std::size_t max_parts) {
  std::vector<lisco::LoadBalancer::Part> parts;
  balancer.divide(columns, lasers, lisco::CellSource(cell_at), max_parts, parts);
  return parts;
}

TEST(LoadBalancer, AssignsEachColumnOnce) {
  for (std::uint64_t seed = 1; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    lisco::LoadBalancer balancer;
    const std::size_t columns = 1 + random.below(3000);
    const std::size_t lasers = 1 + random.below(130);
    const double kept = random.unit();
    const auto cell_at = [&](std::size_t laser, std::size_t column) {
      EXPECT_LT(laser, lasers);
      EXPECT_LT(column, columns);
      return random.chance(kept) ? lisco::Return{1, 2, 3, 0} : lisco::Return{0, 0, 0, 0};
    };
    const std::size_t max_parts = 1 + random.below(20);
    auto all = cut(balancer, columns, lasers, cell_at, max_parts);
    if (random.chance(0.5)) {
      for (std::size_t first = 0; first < columns; first += 64)
        balancer.record(first, std::min<std::size_t>(64, columns - first), 64 + random.below(100000));
      all = cut(balancer, columns, lasers, cell_at, max_parts);
    }
    ASSERT_GE(all.size(), 1U);
    ASSERT_LE(all.size(), std::clamp<std::size_t>((columns + 63) / 64, 1, max_parts)) << "less than 64 columns each";
    EXPECT_EQ(all.front().first, 0U);
    EXPECT_EQ(all.back().end, columns);
    for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i].first, all[i - 1].end);
  }
}

TEST(LoadBalancer, FollowsTheWorkOfTheLastRotation) {
  lisco::LoadBalancer balancer;
  std::size_t queries = 0;
  const auto cell_at = [&](std::size_t, std::size_t) {
    ++queries;
    return lisco::Return{1, 2, 3, 0};
  };
  EXPECT_EQ(cut(balancer, 1024, 64, cell_at, 2)[0].end, 512U);
  EXPECT_GT(queries, 0U);
  for (std::size_t first = 0; first < 1024; first += 64) balancer.record(first, 64, first < 256 ? 3000 : 1000);
  queries = 0;
  EXPECT_EQ(cut(balancer, 1024, 64, cell_at, 2)[0].end, 256U) << "4 x 3000 and 12 x 1000";
  EXPECT_EQ(queries, 0U);
  EXPECT_EQ(cut(balancer, 1024, 32, cell_at, 2)[0].end, 512U) << "another sensor";
  EXPECT_GT(queries, 0U);
}

TEST(LoadBalancer, AssignsColumnsWithoutWork) {
  lisco::LoadBalancer balancer;
  const auto cell_at = [](std::size_t, std::size_t) { return lisco::Return{1, 2, 3, 0}; };
  EXPECT_EQ(cut(balancer, 1000, 64, cell_at, 3).size(), 3U);
  balancer.record(0, 512, 100);
  balancer.record(512, 488, 0);
  EXPECT_EQ(cut(balancer, 1000, 64, cell_at, 3).back().end, 1000U);
}

TEST(LoadBalancer, FollowsTheReturnsOfTheFirstRotation) {
  lisco::LoadBalancer balancer;
  const auto cell_at = [](std::size_t, std::size_t column) {
    return column < 400 ? lisco::Return{1, 2, 3, 0} : lisco::Return{0, 0, 0, 0};
  };
  const std::size_t border =
      cut(balancer, 1600, 64, cell_at, 2)[0].end;  // a return weighs five times as much as an empty cell
  EXPECT_GT(border, 250U);
  EXPECT_LT(border, 450U);
}

// --- WorkShares -----------------------------------------------------------------------------------------------------

/// Rotations of some threads, which take so many seconds for all of the work.
void rotate(lisco::WorkShares& shares, const std::vector<double>& seconds, int rotations) {
  for (int rotation = 0; rotation < rotations; ++rotation) {
    shares.begin(seconds.size());
    for (std::size_t i = 0; i < seconds.size(); ++i) shares.record(i, seconds[i] * shares.of(i));
  }
  shares.begin(seconds.size());
}

TEST(WorkShares, MakeAllThreadsTakeAsLong) {
  lisco::WorkShares shares;
  rotate(shares, {1, 1.5, 1.2}, 4);
  EXPECT_NEAR(shares.of(0), 0.4, 1e-9);
  EXPECT_NEAR(shares.of(1), 0.4 / 1.5, 1e-9);
  EXPECT_NEAR(shares.of(2), 0.4 / 1.2, 1e-9);
  rotate(shares, {1, 2, 1}, 100);
  EXPECT_NEAR(shares.of(0), 0.4, 0.02) << "other times";
  shares.begin(2);
  EXPECT_EQ(shares.of(0), 0.5) << "other threads";
}

TEST(WorkShares, ChangeSeldom) {
  lisco::WorkShares shares;
  int changes = 0;
  double before = 0.5;
  for (int rotation = 0; rotation < 4 + 8 + 10 * 16; ++rotation) {
    shares.begin(2);
    changes += shares.of(0) != before;
    before = shares.of(0);
    const double drift = 1 + 0.02 * rotation;
    shares.record(0, drift * shares.of(0));
    shares.record(1, shares.of(1));
  }
  EXPECT_GT(changes, 5);
  EXPECT_LE(changes, 12);
}

TEST(WorkShares, IgnoreDisturbedRotations) {
  lisco::WorkShares shares;
  Random random(1);
  for (int rotation = 0; rotation < 200; ++rotation) {
    shares.begin(2);
    EXPECT_EQ(shares.of(0), 0.5);
    // The other thread of a machine waits for its turn, in every second rotation.
    for (const std::size_t thread : {0U, 1U}) shares.record(thread, rotation % 2 == 0 ? 1 : 1 + random.between(0, 9));
  }
}

TEST(WorkShares, IgnoreRotationsWithoutWork) {
  lisco::WorkShares shares;
  for (int rotation = 0; rotation < 200; ++rotation) {
    shares.begin(2);
    EXPECT_EQ(shares.of(0), 0.5);
    if (rotation % 3 == 0) shares.record(0, 1);
  }
}

TEST(WorkShares, LeaveEachThreadSomeWork) {
  lisco::WorkShares shares;
  rotate(shares, {1000, 1, 1, 1}, 200);
  EXPECT_GE(shares.of(0), 1.0 / 16);
  EXPECT_NEAR(shares.of(0) + shares.of(1) + shares.of(2) + shares.of(3), 1, 1e-9);
}

}  // namespace
}  // namespace lisco_test
