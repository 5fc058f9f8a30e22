// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// How threads divide sorted fragments into slabs, and two share the planes of theirs: against a list of the planes.
#include "core/near/slab_division.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

/// Sorted fragments of several parts, as VoxelSorter has them before they are divided.
struct Parts {
  static constexpr unsigned kPlaneBits = 6;  ///< of the number of a plane

  lisco::NearReturns returns[5];
  lisco::FragmentList list;
  std::vector<lisco::Box> boxes;
  lisco::VoxelNumbering numbering{};
  lisco::FragmentItems items;
  std::vector<std::uint64_t> all;  ///< items of all parts, sorted

  /// \param planes number of planes with fragments
  Parts(Random& random, std::size_t parts, std::size_t planes) {
    numbering.axis[2] = 0;
    numbering.minor_bits = numbering.middle_bits = 0;
    numbering.bits = numbering.planeBits() + kPlaneBits;
    std::vector<std::uint64_t> numbers(planes);
    for (std::uint64_t& number : numbers) number = random.below(std::size_t{1} << kPlaneBits);
    list.begin(true);
    for (std::size_t part = 0; part < parts; ++part) {
      returns[part].count = 1 + random.below(random.chance(0.2) ? 5 : 3000);
      returns[part].returns.grow(returns[part].count);
      list.add(returns[part]);
      lisco::Box box{};
      box.lo[0] = box.hi[0] = static_cast<float>(random.below(100));
      boxes.push_back(box);
    }
    items.number_bits = 16;
    items.plane_shift = items.number_bits + numbering.planeBits();
    items.all.grow(list.end);
    items.scratch.grow(list.end);
    for (std::size_t part = 0; part < parts; ++part) {
      std::uint64_t* const own = &items.all[list.parts[part].first];
      for (std::size_t i = 0; i < returns[part].count; ++i) {
        const std::uint64_t key = numbers[random.below(planes)] << numbering.planeBits() | random.below(64);
        own[i] = key << items.number_bits | (list.parts[part].first + i);
      }
      std::sort(own, own + returns[part].count);
      items.part_sizes.push_back(returns[part].count);
      all.insert(all.end(), own, own + returns[part].count);
    }
    std::sort(all.begin(), all.end());
  }
};

TEST(SlabDivision, MergesThePartsIntoSlabsOfWholePlanes) {
  Random random(5);
  for (int round = 0; round < 300; ++round) {
    const std::size_t count = 2 + random.below(4);
    Parts parts(random, count, 1 + random.below(random.chance(0.5) ? 3 : 40));
    lisco::SlabDivision division;
    division.divide(parts.list, parts.boxes, parts.numbering, parts.items);
    ASSERT_EQ(std::vector<std::uint64_t>(parts.items.all.data(), parts.items.all.data() + parts.all.size()), parts.all);
    ASSERT_LE(division.slabs.size(), count);
    // Shares are equal at first. The first border is the one nearest to its share.
    const auto farFromShare = [&](std::size_t border) {
      return std::fabs(static_cast<double>(border) -
                       static_cast<double>(parts.all.size()) / static_cast<double>(count));
    };
    double nearest = farFromShare(division.slabs.front().end);
    for (std::size_t i = parts.items.endOfPlane(0, parts.all.size()); i < parts.all.size();) {
      nearest = std::min(nearest, farFromShare(i));
      i = parts.items.endOfPlane(i, parts.all.size());
    }
    if (division.slabs.size() > 1) {
      EXPECT_LE(farFromShare(division.slabs.front().end), nearest + 1);
    }
    std::size_t end = 0;
    for (const lisco::Slab& slab : division.slabs) {
      EXPECT_EQ(slab.begin, end);
      EXPECT_LT(slab.begin, slab.end);
      end = slab.end;
      if (end < parts.all.size()) {
        EXPECT_NE(parts.items.planeOf(parts.all[end - 1]), parts.items.planeOf(parts.all[end]));
      }
    }
    EXPECT_EQ(end, parts.all.size());
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
