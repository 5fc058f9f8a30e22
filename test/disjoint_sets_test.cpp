// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "random.h"

namespace lisco_test {
namespace {

TEST(DisjointSets, ANewSetIsItsOwnHead) {
  lisco::DisjointSets sets;
  sets.reset(2);
  EXPECT_GE(sets.room(), 2U);
  sets.create(0);
  sets.create(1);
  EXPECT_EQ(sets.head(0), 0U);
  EXPECT_EQ(sets.head(1), 1U);
}

TEST(DisjointSets, TheSmallestElementIsTheHead) {
  lisco::DisjointSets sets;
  sets.reset(5);
  for (std::uint32_t element = 0; element < 5; ++element) sets.create(element);
  EXPECT_EQ(sets.merge(4, 2), 2U);
  EXPECT_EQ(sets.merge(3, 4), 2U);
  EXPECT_EQ(sets.merge(3, 3), 2U);
  EXPECT_EQ(sets.merge(1, 3), 1U);
  EXPECT_EQ(sets.merge(4, 2), 1U);
  EXPECT_EQ(sets.head(0), 0U);
  for (std::uint32_t element = 1; element < 5; ++element) EXPECT_EQ(sets.head(element), 1U);
}

// Elements need not be created in the order of their numbers, nor all of them.
TEST(DisjointSets, ElementsInAnyOrder) {
  lisco::DisjointSets sets;
  sets.reset(1000);
  sets.create(999);
  sets.create(500);
  sets.merge(999, 500);
  sets.create(7);
  EXPECT_EQ(sets.head(999), 500U);
  EXPECT_EQ(sets.merge(7, 999), 7U);
}

TEST(DisjointSets, GrowKeepsTheSets) {
  lisco::DisjointSets sets;
  sets.reset(2);
  sets.create(0);
  sets.create(1);
  sets.merge(0, 1);
  for (std::uint32_t element = 2; element < 5000; ++element) {
    sets.grow(element + 1);
    ASSERT_GE(sets.room(), element + 1U);
    sets.create(element);
    ASSERT_EQ(sets.head(element), element);
    if (element % 3 == 0) sets.merge(element, element - 1);
  }
  EXPECT_EQ(sets.head(1), 0U);
  EXPECT_EQ(sets.head(300), 299U);
}

TEST(DisjointSets, ResetForgetsEverything) {
  lisco::DisjointSets sets;
  sets.reset(2);
  sets.create(0);
  sets.create(1);
  sets.merge(0, 1);
  sets.share(true);
  sets.reset(2);
  sets.create(0);
  sets.create(1);
  EXPECT_EQ(sets.head(1), 1U);
}

// Against a table of every element's set.
TEST(DisjointSets, AsATableSaysAfterManyMerges) {
  for (const bool shared : {false, true}) {
    Random random(1);
    lisco::DisjointSets sets;
    std::vector<std::uint32_t> head_of(400);
    std::iota(head_of.begin(), head_of.end(), 0U);
    sets.reset(head_of.size());
    for (const std::uint32_t element : head_of) sets.create(element);
    sets.share(shared);
    for (int step = 0; step < 1000; ++step) {
      const auto a = static_cast<std::uint32_t>(random.below(head_of.size()));
      const auto b = static_cast<std::uint32_t>(random.below(head_of.size()));
      ASSERT_EQ(sets.head(a), head_of[a]);
      ASSERT_EQ(sets.head(b), head_of[b]);
      if (random.chance(0.6)) continue;
      const std::uint32_t head = std::min(head_of[a], head_of[b]);
      const std::uint32_t other = std::max(head_of[a], head_of[b]);
      ASSERT_EQ(sets.merge(a, b), head);
      std::replace(head_of.begin(), head_of.end(), other, head);
    }
  }
}

// Whatever the order in which threads come to merge, the sets and their heads are the same.
TEST(DisjointSets, SharedByThreads) {
  constexpr std::uint32_t kElements = 3000;
  constexpr std::size_t kThreads = 4;
  lisco::DisjointSets alone;
  lisco::DisjointSets shared;
  for (std::uint64_t seed = 1; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> merges(kElements);
    const bool long_chains = random.chance(0.5);
    for (std::uint32_t i = 0; i < merges.size(); ++i) {
      const auto a = static_cast<std::uint32_t>(random.below(kElements));
      merges[i] = long_chains ? std::pair{std::max(i, 1U) - 1, i}
                              : std::pair{a, static_cast<std::uint32_t>(random.below(kElements))};
    }
    random.shuffle(merges);
    if (random.chance(0.5)) merges.resize(merges.size() / 2);
    for (lisco::DisjointSets* sets : {&alone, &shared}) {
      sets->reset(kElements);
      for (std::uint32_t element = 0; element < kElements; ++element) sets->create(element);
    }
    for (const auto& [a, b] : merges) alone.merge(a, b);
    shared.share(true);
    std::vector<std::string> wrong(kThreads);
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < kThreads; ++thread)
      threads.emplace_back([&, thread] {
        // Each merges all, from another beginning.
        for (std::size_t i = 0; i < merges.size(); ++i) {
          const auto& [a, b] = merges[(i + thread * merges.size() / kThreads) % merges.size()];
          if (shared.merge(a, b) > std::min(a, b)) wrong[thread] = "a head is no smallest element";
          if (shared.head(a) > a) wrong[thread] = "a head is above its element";
        }
      });
    for (std::thread& thread : threads) thread.join();
    shared.share(false);
    for (const std::string& message : wrong) ASSERT_EQ(message, "");
    for (std::uint32_t element = 0; element < kElements; ++element)
      ASSERT_EQ(shared.head(element), alone.head(element)) << element;
  }
}

}  // namespace
}  // namespace lisco_test
