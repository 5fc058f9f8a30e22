// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/endless_sets.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/stream_position.h"
#include "random.h"

namespace lisco_test {
namespace {

using Element = lisco::EndlessSets::Element;

std::vector<Element> chainOf(lisco::EndlessSets& sets, Element root) {
  std::vector<Element> runs;
  for (Element run = root; run != lisco::EndlessSets::kNone; run = sets[run].next_run) runs.push_back(run);
  return runs;
}

Element addRun(lisco::EndlessSets& sets, std::int64_t pane) {
  const Element element = lisco::EndlessSets::elementOf(pane, sets.runCount(pane));
  sets.create(pane, 0.0).size = 1;
  return element;
}

TEST(EndlessSets, ChainOfARootHoldsAllRunsOfItsSet) {
  lisco::EndlessSets sets;
  for (std::int64_t pane = -2; pane < 2; ++pane) sets.startPane(pane);
  std::vector<Element> runs;
  for (std::int64_t pane = -2; pane < 2; ++pane)
    for (int i = 0; i < 5; ++i) runs.push_back(addRun(sets, pane));
  Random random(1);
  for (int i = 0; i < 12; ++i) {
    sets.merge(random.oneOf(runs), random.oneOf(runs));
    std::size_t in_chains = 0;
    for (const Element run : runs) {
      if (!sets.isRoot(run)) continue;
      const std::vector<Element> chain = chainOf(sets, run);
      in_chains += chain.size();
      EXPECT_EQ(chain.size(), sets[run].size);
      for (const Element member : chain) EXPECT_EQ(sets.find(member), run);
    }
    EXPECT_EQ(in_chains, runs.size());
  }
}

// In either order, whichever is larger.
TEST(EndlessSets, OpenSetContinuesADeliveredOneWithItsOwnRuns) {
  for (const bool delivered_first : {false, true})
    for (const std::uint32_t open_size : {1U, 10U}) {
      lisco::EndlessSets sets;
      sets.startPane(7);
      const Element delivered = addRun(sets, 7);
      const Element open = addRun(sets, 7);
      sets[delivered].size = 5;
      sets[delivered].delivered = true;
      sets[open].size = open_size;
      delivered_first ? sets.merge(delivered, open) : sets.merge(open, delivered);
      EXPECT_EQ(sets.find(delivered), open);
      EXPECT_EQ(sets.find(open), open);
      EXPECT_EQ(chainOf(sets, open), std::vector<Element>{open});
      EXPECT_EQ(sets[open].size, open_size);
      EXPECT_TRUE(sets[open].continued);
      EXPECT_FALSE(sets[open].delivered);
      const Element next = addRun(sets, 7);  // a neighbour of the delivered one joins the open one
      sets.merge(next, delivered);
      EXPECT_EQ(sets.find(next), sets.find(open));
      EXPECT_EQ(sets[sets.find(open)].size, open_size + 1);
      EXPECT_TRUE(sets[sets.find(open)].continued);
    }
}

TEST(StreamPosition, ColumnsAreRoundedDownAndReachEndsUp) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const double position = (random.chance(0.5) ? -1 : 1) * random.magnitude(1e-9, 1e12);
    const lisco::Ticks ticks = lisco::ticksOf(position);
    EXPECT_LE(static_cast<long double>(ticks), static_cast<long double>(position) * lisco::kTicksPerTurn);
    EXPECT_GT(static_cast<long double>(ticks) + 1, static_cast<long double>(position) * lisco::kTicksPerTurn);
    EXPECT_GE(static_cast<long double>(lisco::positionOf(ticks)) * lisco::kTicksPerTurn,
              static_cast<long double>(ticks));
    EXPECT_EQ(lisco::paneOf(ticks), static_cast<std::int64_t>(std::floor(8 * position)));
  }
  EXPECT_EQ(lisco::ticksOf(1e12), 1000000000000 * lisco::kTicksPerTurn);
  EXPECT_EQ(lisco::paneOf(-1), -1);
}

}  // namespace
}  // namespace lisco_test
