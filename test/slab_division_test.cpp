// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// How two threads share the planes of their slabs: SlabPair and FragmentItems, against a list of the planes.
#include "core/near/slab_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/near/constants.h"
#include "core/near/fragments.h"
#include "random.h"

namespace lisco_test {
namespace {

constexpr unsigned kPlaneShift = 20;

/// Sorted fragments of planes whose numbers ascend, with gaps.
struct Fragments {
  lisco::FragmentItems items;
  std::vector<std::size_t> ends;  ///< of the planes

  std::size_t count() const { return ends.empty() ? 0 : ends.back(); }
  std::size_t beginOf(std::size_t plane) const { return plane == 0 ? 0 : ends[plane - 1]; }
  bool isBorder(std::size_t i) const { return i == 0 || std::binary_search(ends.begin(), ends.end(), i); }
};

Fragments randomFragments(Random& random, std::size_t planes) {
  Fragments made;
  made.items.plane_shift = kPlaneShift;
  std::uint64_t number = random.below(5);
  for (std::size_t plane = 0; plane < planes; ++plane, number += 1 + random.below(2)) {
    const std::size_t size = 1 + random.below(random.chance(0.2) ? 2000 : 40);
    const std::size_t end = made.count() + size;
    made.items.all.growInSteps(end);
    for (std::size_t i = made.count(); i < end; ++i)
      made.items.all[i] = number << kPlaneShift | random.below(std::size_t{1} << kPlaneShift);
    made.ends.push_back(end);
  }
  return made;
}

/// Puts some planes taken into a list, and checks that they are whole, and at the end of what was left.
void expectTaken(const Fragments& fragments, bool last, const lisco::Planes& left, const lisco::Planes& taken,
                 std::vector<lisco::Planes>& all) {
  ASSERT_LT(taken.begin, taken.end);
  EXPECT_TRUE(fragments.isBorder(taken.begin)) << taken.begin;
  EXPECT_TRUE(fragments.isBorder(taken.end)) << taken.end;
  EXPECT_EQ(last ? taken.end : taken.begin, last ? left.end : left.begin);
  EXPECT_GE(taken.end - taken.begin, std::min(lisco::kLeastTaken, left.end - left.begin));
  all.push_back(taken);
}

/// All planes are taken once.
void expectAll(std::vector<lisco::Planes> taken, const lisco::Planes& all) {
  std::sort(taken.begin(), taken.end(),
            [](const lisco::Planes& a, const lisco::Planes& b) { return a.begin < b.begin; });
  std::size_t end = all.begin;
  for (const lisco::Planes& planes : taken) {
    EXPECT_EQ(planes.begin, end);
    end = planes.end;
  }
  EXPECT_EQ(end, all.end);
}

TEST(FragmentItems, FindsWhereAPlaneBeginsAndEnds) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const Fragments fragments = randomFragments(random, 1 + random.below(30));
    const std::size_t first = random.below(fragments.ends.size());  // planes before are those of other slabs
    const std::size_t last = first + random.below(fragments.ends.size() - first);
    for (std::size_t plane = first; plane <= last; ++plane) {
      const std::size_t begin = fragments.beginOf(plane);
      const std::size_t end = fragments.ends[plane];
      for (const std::size_t i : {begin, begin + (end - begin) / 2, begin + random.below(end - begin), end - 1}) {
        EXPECT_EQ(fragments.items.beginOfPlane(i, fragments.beginOf(first)), begin) << i;
        EXPECT_EQ(fragments.items.endOfPlane(i, fragments.ends[last]), end) << i;
      }
    }
  }
}

TEST(SlabPair, GivesEachPlaneToOneOfTwoThreadsInTurn) {
  Random random(2);
  for (int round = 0; round < 100; ++round) {
    const Fragments fragments = randomFragments(random, random.below(60));
    const lisco::Planes all{0, fragments.count()};
    lisco::SlabPair pair;
    pair.begin(all);
    const double chance = random.unit();
    std::vector<lisco::Planes> taken;
    while (true) {
      const bool last = random.chance(chance);
      const lisco::Planes left = pair.left();
      lisco::Planes planes{};
      if (!pair.take(last, fragments.items, planes)) break;
      expectTaken(fragments, last, left, planes, taken);
    }
    expectAll(taken, all);
    EXPECT_EQ(pair.left().begin, pair.left().end);
    EXPECT_FALSE(pair.end());
    EXPECT_TRUE(pair.end());
  }
}

TEST(SlabPair, GivesEachPlaneToOneOfTwoThreadsAtOnce) {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    const Fragments fragments = randomFragments(random, 200);
    const lisco::Planes all{0, fragments.count()};
    lisco::SlabPair pair;
    pair.begin(all);
    std::array<std::vector<lisco::Planes>, 2> taken;
    std::array<bool, 2> is_later{};
    const auto take = [&](std::size_t thread) {
      lisco::Planes planes{};
      while (pair.take(thread == 1, fragments.items, planes)) taken[thread].push_back(planes);
      is_later[thread] = pair.end();
    };
    std::thread other(take, std::size_t{1});
    take(0);
    other.join();
    EXPECT_NE(is_later[0], is_later[1]);
    const std::size_t meeting = pair.left().begin;
    for (const lisco::Planes& planes : taken[0]) EXPECT_LE(planes.end, meeting);
    for (const lisco::Planes& planes : taken[1]) EXPECT_GE(planes.begin, meeting);
    taken[0].insert(taken[0].end(), taken[1].begin(), taken[1].end());
    expectAll(taken[0], all);
  }
}

TEST(SlabDivision, LeavesEachThreadItsOuterPlane) {
  Random random(4);
  for (const std::size_t slabs : {1, 2, 3, 4, 5}) {
    const Fragments fragments = randomFragments(random, 3 * slabs);
    lisco::SlabDivision division;
    for (std::size_t slab = 0; slab < slabs; ++slab)
      division.slabs.push_back({{fragments.beginOf(3 * slab), fragments.ends[3 * slab + 2]}});
    division.beginLinking(fragments.items);
    std::vector<lisco::Planes> linked;
    // The first thread of a pair takes all but what is left to the other.
    for (std::size_t slab = 0; slab < slabs; ++slab) {
      const std::size_t outer = lisco::SlabDivision::descends(slab) ? 3 * slab + 2 : 3 * slab;
      const lisco::Planes plane = division.outerPlane(slab, fragments.items);
      EXPECT_EQ(plane.begin, fragments.beginOf(outer));
      EXPECT_EQ(plane.end, fragments.ends[outer]);
      lisco::Planes taken{};
      while (division.pairOf(slab).take(lisco::SlabDivision::descends(slab), fragments.items, taken)) {
      }
    }
    for (std::size_t slab = 0; slab < slabs; ++slab) linked.push_back(division.linkedBy(slab));
    expectAll(linked, {0, fragments.count()});
    if (slabs > 1) {
      EXPECT_EQ(linked[1].begin, fragments.beginOf(5));
    }
  }
}

}  // namespace
}  // namespace lisco_test
