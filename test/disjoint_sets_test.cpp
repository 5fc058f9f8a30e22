// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "random.h"

namespace lisco_test {
namespace {

TEST(DisjointSets, ANewSetIsItsOwnHead) {
  lisco::DisjointSets sets;
  sets.create(3);
  sets.create(5);
  EXPECT_EQ(sets.size(), 2U);
  EXPECT_EQ(sets.head(0), 0U);
  EXPECT_EQ(sets.head(1), 1U);
  EXPECT_EQ(sets.weight(1), 5U);
}

TEST(DisjointSets, TheLargerSetKeepsItsHead) {
  lisco::DisjointSets sets;
  sets.create(1);
  sets.create(2);
  EXPECT_EQ(sets.merge(0, 1), 1U);
  sets.create(4);
  EXPECT_EQ(sets.merge(1, 2), 2U);
  for (std::uint32_t element = 0; element < 3; ++element) EXPECT_EQ(sets.head(element), 2U);
  EXPECT_EQ(sets.weight(2), 7U);
}

TEST(DisjointSets, ClearForgetsEverything) {
  lisco::DisjointSets sets;
  sets.create(1);
  sets.create(1);
  sets.merge(0, 1);
  sets.clear();
  EXPECT_EQ(sets.size(), 0U);
  sets.create(4);
  EXPECT_EQ(sets.head(0), 0U);
  EXPECT_EQ(sets.weight(0), 4U);
}

// Against a table of every element's set.
TEST(DisjointSets, AsATableSaysAfterManyMerges) {
  Random random(1);
  lisco::DisjointSets sets;
  std::vector<std::size_t> set_of;
  std::vector<std::uint32_t> weights;
  for (std::size_t i = 0; i < 400; ++i) {
    set_of.push_back(i);
    weights.push_back(static_cast<std::uint32_t>(1 + random.below(9)));
    sets.create(weights.back());
  }
  for (int step = 0; step < 1000; ++step) {
    const std::size_t a = random.below(set_of.size());
    const std::size_t b = random.below(set_of.size());
    const std::uint32_t head_a = sets.head(static_cast<std::uint32_t>(a));
    const std::uint32_t head_b = sets.head(static_cast<std::uint32_t>(b));
    ASSERT_EQ(head_a == head_b, set_of[a] == set_of[b]);
    if (head_a == head_b || random.chance(0.6)) continue;
    const std::uint32_t head = sets.merge(head_a, head_b);
    ASSERT_EQ(sets.head(static_cast<std::uint32_t>(b)), head);
    std::replace(set_of.begin(), set_of.end(), std::size_t{set_of[b]}, std::size_t{set_of[a]});
    std::uint32_t weight = 0;
    for (std::size_t i = 0; i < set_of.size(); ++i) weight += set_of[i] == set_of[a] ? weights[i] : 0;
    ASSERT_EQ(sets.weight(head), weight);
  }
}

}  // namespace
}  // namespace lisco_test
