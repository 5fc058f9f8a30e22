// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Many pairs in one scan, each just within the tolerance or just beyond it, where masks and segments end.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "engine.h"
#include "oracle.h"
#include "pair_scans.h"
#include "random.h"

namespace lisco_test {
namespace {

/// In parts that run side by side.
class PairScans : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, PairScans, testing::Range<std::uint64_t>(1, 5));

TEST_P(PairScans, EqualTheOracle) {
  lisco::ColumnClusterer clusterer;
  std::size_t joined = 0;
  const std::uint64_t seeds = GetParam() * 10'000'000;
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(400); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const PairScan pairs = randomPairs(random);
    const SimdLevel level(random.oneOf(levels()));
    lisco::Parameters parameters;
    parameters.tolerance = pairs.tolerance;
    parameters.sensor = pairs.hints;
    const std::array<std::size_t, 6> blocks{64, 64, 1, 3, 16, 1 + random.below(64)};
    parameters.block_columns = random.oneOf(blocks);
    parameters.threads = random.chance(0.4) ? random.below(5) : 1;
    clusterer.begin(parameters);
    feed(clusterer, random, pairs.scan);
    const Clustering right = trueClusters(pairs.scan.points(), pairs.tolerance);
    ASSERT_EQ(difference(right, clustersOf(clusterer)), "");
    for (const Cluster& cluster : right) joined += cluster.members.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(joined, timesEffort(400 * 10)) << "too few pairs are neighbours";
  RecordProperty("joined", std::to_string(joined));
}

}  // namespace
}  // namespace lisco_test
