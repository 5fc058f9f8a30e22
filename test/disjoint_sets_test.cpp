// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "random.h"

namespace lisco_test {
namespace {

TEST(DisjointSets, ANewSetIsItsOwnRoot) {
  lisco::DisjointSets sets;
  sets.reserve(2);
  sets.create(0);
  sets.create(1);
  EXPECT_EQ(sets.find(0), 0U);
  EXPECT_EQ(sets.find(1), 1U);
}

TEST(DisjointSets, TheSmallestElementIsTheRoot) {
  lisco::DisjointSets sets;
  sets.reserve(5);
  for (std::uint32_t element = 0; element < 5; ++element) sets.create(element);
  EXPECT_EQ(sets.merge(4, 2), 2U);
  EXPECT_EQ(sets.merge(3, 4), 2U);
  EXPECT_EQ(sets.merge(3, 3), 2U);
  EXPECT_EQ(sets.merge(1, 3), 1U);
  EXPECT_EQ(sets.merge(4, 2), 1U);
  EXPECT_EQ(sets.find(0), 0U);
  for (std::uint32_t element = 1; element < 5; ++element) EXPECT_EQ(sets.find(element), 1U);
}

// Elements may be created in any order, and only some of them.
TEST(DisjointSets, AcceptsElementsInAnyOrder) {
  lisco::DisjointSets sets;
  sets.reserve(1000);
  sets.create(999);
  sets.create(500);
  sets.merge(999, 500);
  sets.create(7);
  EXPECT_EQ(sets.find(999), 500U);
  EXPECT_EQ(sets.merge(7, 999), 7U);
}

TEST(DisjointSets, GrowKeepsTheSets) {
  lisco::DisjointSets sets;
  sets.reserve(2);
  sets.create(0);
  sets.create(1);
  sets.merge(0, 1);
  for (std::uint32_t element = 2; element < 5000; ++element) {
    sets.grow(element + 1);
    sets.create(element);
    ASSERT_EQ(sets.find(element), element);
    if (element % 3 == 0) sets.merge(element, element - 1);
  }
  EXPECT_EQ(sets.find(1), 0U);
  EXPECT_EQ(sets.find(300), 299U);
}

TEST(DisjointSets, CreateForgetsWhatAnElementWas) {
  lisco::DisjointSets sets;
  sets.reserve(2);
  sets.create(0);
  sets.create(1);
  sets.merge(0, 1);
  sets.reserve(2);
  sets.create(0);
  sets.create(1);
  EXPECT_EQ(sets.find(1), 1U);
}

// Against a table of every element's set.
TEST(DisjointSets, EqualATableAfterManyMerges) {
  Random random(1);
  lisco::DisjointSets sets;
  std::vector<std::uint32_t> root_of(400);
  std::iota(root_of.begin(), root_of.end(), 0U);
  sets.reserve(root_of.size());
  for (const std::uint32_t element : root_of) sets.create(element);
  for (int step = 0; step < 1000; ++step) {
    const auto a = static_cast<std::uint32_t>(random.below(root_of.size()));
    const auto b = static_cast<std::uint32_t>(random.below(root_of.size()));
    ASSERT_EQ(sets.find(a), root_of[a]);
    ASSERT_EQ(sets.find(b), root_of[b]);
    if (random.chance(0.6)) continue;
    const std::uint32_t root = std::min(root_of[a], root_of[b]);
    const std::uint32_t other = std::max(root_of[a], root_of[b]);
    ASSERT_EQ(sets.merge(a, b), root);
    std::replace(root_of.begin(), root_of.end(), other, root);
  }
}

}  // namespace
}  // namespace lisco_test
