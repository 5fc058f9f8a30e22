// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// How work is spread over the columns of a rotation.
#include "core/block_scheduler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/column_budget.h"
#include "core/disjoint_sets.h"
#include "core/neighbour.h"
#include "core/partition.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco_test {
namespace {

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
  EXPECT_EQ(blocksOf(300, 64), Blocks({64, 64, 64, 54, 27, 24, 24}));
  EXPECT_EQ(blocksOf(430, 64), Blocks({64, 64, 64, 54, 27, 24, 24, 64, 64}));  // it went on
  EXPECT_EQ(blocksOf(30, 8), Blocks({8, 8, 8, 8}));
  EXPECT_EQ(blocksOf(30, 8), Blocks({8, 8, 8, 8}));
}

// --- ColumnBudget ---------------------------------------------------------------------------------------------------

/// A clock that tests set.
struct TestClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TestClock>;
  static constexpr bool is_steady = true;

  static time_point now() {
    ++looks;
    return time += look;
  }
  static void pass(std::size_t nanoseconds) { time += std::chrono::nanoseconds(nanoseconds); }

  static inline time_point time;
  static inline duration look{0};  ///< what a look takes
  static inline std::size_t looks = 0;
};

using Budget = lisco::ColumnBudget<TestClock>;

struct Spent {
  std::vector<std::size_t> per_column;  ///< nanoseconds
  std::size_t most_left = 0;            ///< parts

  std::size_t sum() const { return std::accumulate(per_column.begin(), per_column.end(), std::size_t{0}); }
  std::size_t mostOfColumn() const { return *std::max_element(per_column.begin(), per_column.end()); }
};

/// Rotations of which every block of 64 columns brings parts to link, whose nanoseconds are given, and takes some time
/// to be read; records what the columns of the last one took.
/// \param reading callable as std::size_t (std::size_t column): nanoseconds, of a laser
template <typename Reading>
Spent spend(const std::vector<std::size_t>& parts, std::size_t parts_per_block, std::size_t rotations,
            Reading&& reading) {
  Budget budget;
  Spent spent;
  for (std::size_t rotation = 0; rotation < rotations; ++rotation) {
    budget.begin();
    spent = Spent();
    std::size_t come = 0;
    std::size_t done = 0;
    while (come < parts.size() || done < come) {
      if (spent.per_column.size() % 64 == 0) {
        come = std::min(come + parts_per_block, parts.size());
        budget.plan(Budget::kReading, 64, 64);
        budget.plan(Budget::kFar, come - done, 192);
        spent.most_left = std::max(spent.most_left, come - done);
      }
      budget.addColumns(1);
      std::size_t nanoseconds = reading(spent.per_column.size());
      TestClock::pass(nanoseconds);
      budget.record(Budget::kReading, 1, nanoseconds);
      while (budget.isBehind()) {
        if (done == come) {
          budget.drop();
          break;
        }
        TestClock::pass(parts[done]);
        budget.record(Budget::kFar, 1, parts[done]);
        nanoseconds += parts[done++];
      }
      spent.per_column.push_back(nanoseconds);
      if (spent.per_column.size() > 100000) return spent;
    }
  }
  return spent;
}

constexpr auto kNoReading = [](std::size_t /*column*/) { return std::size_t{0}; };

TEST(ColumnBudget, SpreadsEvenWorkEvenly) {
  const Spent spent = spend(std::vector<std::size_t>(200 * 50, 700), 200, 3, kNoReading);
  for (std::size_t column = 640; column < 64 * 50; ++column)
    EXPECT_NEAR(static_cast<double>(spent.per_column[column]), 700.0 * 200 / 64, 800.0) << column;
  EXPECT_LT(spent.most_left, 800U);
}

// A tenth of the parts, all adjacent, takes ten times as long as the others.
TEST(ColumnBudget, SpreadsDenseWorkEvenly) {
  std::vector<std::size_t> parts(200 * 50, 1000);
  std::fill(parts.begin() + 4000, parts.begin() + 5000, 10000);
  const Spent spent = spend(parts, 200, 5, kNoReading);
  EXPECT_EQ(spent.sum(), std::accumulate(parts.begin(), parts.end(), std::size_t{0}));
  EXPECT_LT(spent.mostOfColumn(), 200 * 10000 / 64) << "as long as without spreading beyond the next block";
  EXPECT_LT(spent.most_left, 200U * 25);
}

TEST(ColumnBudget, LinksLessWhereReadingTakesLong) {
  const auto reading = [](std::size_t column) { return std::size_t{column % 64 < 32 ? 4000U : 200U}; };
  const Spent spent = spend(std::vector<std::size_t>(500 * 50, 500), 500, 3, reading);
  for (std::size_t column = 640; column < 64 * 50; ++column)
    EXPECT_NEAR(static_cast<double>(spent.per_column[column]), 500.0 * 500 / 64 + 2100, 600.0) << column;
}

TEST(ColumnBudget, DoesAllWorkAfterAnyRotation) {
  for (const std::size_t nanoseconds : {1U, 1000U, 1000000U}) {
    const Spent spent = spend(std::vector<std::size_t>(2000, nanoseconds), 50, 1, kNoReading);
    EXPECT_EQ(spent.sum(), 2000 * nanoseconds);
    EXPECT_LT(spent.per_column.size(), 10000U) << nanoseconds;
  }
}

TEST(ColumnBudget, LooksSeldomAtTheClockInShortColumns) {
  const auto looksPerColumn = [](std::size_t nanoseconds) {
    TestClock::looks = 0;
    const Spent spent = spend(std::vector<std::size_t>(200 * 50, nanoseconds), 200, 1, kNoReading);
    for (std::size_t column = 640; column < 64 * 50; ++column)
      EXPECT_NEAR(static_cast<double>(spent.per_column[column]), static_cast<double>(nanoseconds) * 200 / 64,
                  1.2 * static_cast<double>(nanoseconds));
    return static_cast<double>(TestClock::looks) / static_cast<double>(spent.per_column.size());
  };
  EXPECT_GT(looksPerColumn(1000), 3);
  EXPECT_GT(looksPerColumn(100), 0.1) << "times may change";
  EXPECT_LT(looksPerColumn(100), 0.5);
  TestClock::look = std::chrono::nanoseconds(200);
  EXPECT_LT(looksPerColumn(1000), 0.5) << "where the clock is slow";
  TestClock::look = std::chrono::nanoseconds(0);
}

TEST(ColumnBudget, DoesOneKindAfterTheOther) {
  Budget budget;
  budget.begin();
  budget.plan(Budget::kFar, 100, 10);
  budget.plan(Budget::kNear, 300, 10);
  for (int column = 0; column < 5; ++column) {
    budget.addColumns(1);
    std::vector<Budget::Kind> kinds;
    while (budget.isBehind()) {
      kinds.push_back(budget.isBefore(Budget::kFar, Budget::kNear) ? Budget::kFar : Budget::kNear);
      TestClock::pass(500);
      budget.record(kinds.back(), 1, 100);
    }
    EXPECT_NEAR(static_cast<double>(std::count(kinds.begin(), kinds.end(), Budget::kFar)), 10, 1);
    EXPECT_NEAR(static_cast<double>(std::count(kinds.begin(), kinds.end(), Budget::kNear)), 30, 1);
    EXPECT_TRUE(std::is_sorted(kinds.begin(), kinds.begin() + 39)) << "far ones first";
  }
}

// A kind whose parts took long is left to later columns.
TEST(ColumnBudget, LeavesAKindThatIsAhead) {
  Budget budget;
  budget.begin();
  budget.plan(Budget::kFar, 100, 10);
  budget.plan(Budget::kNear, 100, 10);
  budget.addColumns(1);
  TestClock::pass(7500);
  budget.record(Budget::kFar, 1, 100);
  EXPECT_TRUE(budget.isBehind());
  EXPECT_FALSE(budget.isBefore(Budget::kFar, Budget::kNear));
  EXPECT_TRUE(budget.isBefore(Budget::kNear, Budget::kFar));
}

// Parts may be linked before their kind is planned for the first time.
TEST(ColumnBudget, CountsPartsThatAreNotPlanned) {
  for (const std::size_t readings : {10U, 10000U}) {  // of columns that are short, and of some that are not
    Budget budget;
    budget.begin();
    budget.plan(Budget::kReading, readings, 10);
    for (std::size_t column = 0; column < 5; ++column) {
      budget.addColumns(1);
      std::size_t parts = 0;
      for (; budget.isBehind() && parts <= 2 * readings; ++parts) {
        TestClock::pass(500);
        budget.record(Budget::kNear, 1, 100);
      }
      EXPECT_NEAR(static_cast<double>(parts), static_cast<double>(readings) / 10, 1);
    }
  }
}

// The thread waits for its processor: the columns after it do not make up for a time that was not worked.
TEST(ColumnBudget, GoesOnAfterAnInterruption) {
  Budget budget;
  budget.begin();
  budget.plan(Budget::kFar, 10000, 1000);
  std::size_t idle = 0;
  for (std::size_t column = 0; column < 1000; ++column) {
    budget.addColumns(1);
    idle += budget.isBehind() ? 0 : 1;
    for (bool is_first = true; budget.isBehind(); is_first = false) {
      TestClock::pass(column == 500 && is_first ? 1000000000 : 500);
      budget.record(Budget::kFar, 1, 100);
    }
  }
  EXPECT_LE(idle, 3U);
}

// Where no part is left, its time is lost: it does not make later columns longer.
TEST(ColumnBudget, DropsWhatNoPartIsLeftFor) {
  Budget budget;
  budget.begin();
  budget.plan(Budget::kFar, 1000, 100);
  for (std::size_t column = 0; column < 50; ++column) {
    budget.addColumns(1);
    EXPECT_TRUE(budget.isBehind());
    budget.drop();
    EXPECT_FALSE(budget.isBehind());
  }
  budget.addColumns(1);
  std::size_t parts = 0;
  for (; budget.isBehind(); ++parts) {
    TestClock::pass(500);
    budget.record(Budget::kFar, 1, 100);
  }
  EXPECT_NEAR(static_cast<double>(parts), 10, 1);
}

}  // namespace
}  // namespace lisco_test
