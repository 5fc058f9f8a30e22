// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// How work is spread over threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "core/load_balancer.h"
#include "core/work_shares.h"
#include "lisco/return.h"
#include "random.h"

namespace lisco_test {
namespace {

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
