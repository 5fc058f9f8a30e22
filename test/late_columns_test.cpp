// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Columns in another order than their azimuths, as by late and swapped packets. The order decides the speed, never the
// clusters.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "engine.h"
#include "lisco/simd.h"
#include "oracle.h"
#include "pair_scans.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

using Order = std::vector<std::size_t>;  ///< the columns in the order in which they come

/// Faults of a rotation's packets.
enum class Disorder { kSwappedPackets, kLatePacket, kRepeatedColumns, kReversedPart, kShuffled, kRestart };
constexpr std::array<Disorder, 6> kDisorders{Disorder::kSwappedPackets,  Disorder::kLatePacket,
                                             Disorder::kRepeatedColumns, Disorder::kReversedPart,
                                             Disorder::kShuffled,        Disorder::kRestart};

Order::iterator placeIn(Order& order, std::size_t place) {
  return order.begin() + static_cast<std::ptrdiff_t>(std::min(place, order.size()));
}

void disturb(Random& random, Order& order, Disorder disorder, std::size_t columns_per_turn) {
  const std::size_t packet = random.oneOf(std::array<std::size_t, 4>{1, 6, 24, 64});
  const std::size_t at = random.below(order.size());
  switch (disorder) {
    case Disorder::kSwappedPackets:
      for (std::size_t first = 0; first + 2 * packet <= order.size(); first += packet)
        if (random.chance(0.1))
          std::rotate(placeIn(order, first), placeIn(order, first + packet), placeIn(order, first + 2 * packet));
      break;
    case Disorder::kLatePacket: {  // by an eighth to three quarters of a turn
      const std::size_t by = columns_per_turn * (1 + random.below(6)) / 8;
      std::rotate(placeIn(order, at), placeIn(order, at + packet), placeIn(order, at + packet + by));
      break;
    }
    case Disorder::kRepeatedColumns: {
      const Order repeated(placeIn(order, at), placeIn(order, at + packet));
      order.insert(placeIn(order, at + random.below(columns_per_turn)), repeated.begin(), repeated.end());
      break;
    }
    case Disorder::kReversedPart:
      std::reverse(placeIn(order, at), random.chance(0.5) ? order.end() : placeIn(order, at + random.below(600)));
      break;
    case Disorder::kShuffled: {
      const std::size_t count = std::min(order.size() - at, random.chance(0.5) ? order.size() : 4 * packet);
      Order part(placeIn(order, at), placeIn(order, at + count));
      random.shuffle(part);
      std::copy(part.begin(), part.end(), placeIn(order, at));
      break;
    }
    case Disorder::kRestart:  // restarts at another azimuth
      std::rotate(order.begin(), placeIn(order, at), order.end());
      break;
  }
}

Scan inOrder(const Scan& scan, const Order& order) {
  Scan arranged(order.size(), scan.lasers);
  for (std::size_t laser = 0; laser < scan.lasers; ++laser)
    for (std::size_t column = 0; column < order.size(); ++column) {
      const lisco::Return& cell = scan.at(laser, order[column]);
      arranged.set(laser, column, {cell.x, cell.y, cell.z});
    }
  return arranged;
}

/// A scan of up to three turns, with hints that fit all but the order of its columns.
PairScan disordered(Random& random, PairScan pairs, Disorder disorder) {
  Order order(pairs.scan.columns);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto steps = static_cast<std::size_t>(pairs.hints.steps_per_turn);
  disturb(random, order, disorder, steps);
  while (random.chance(0.4)) disturb(random, order, random.oneOf(kDisorders), steps);
  order.resize(std::min(order.size(), 3 * steps));
  pairs.scan = inOrder(pairs.scan, order);
  return pairs;
}

/// In parts that run side by side.
class LateColumns : public testing::TestWithParam<Disorder> {};
INSTANTIATE_TEST_SUITE_P(Disorders, LateColumns, testing::ValuesIn(kDisorders));

TEST_P(LateColumns, EqualTheOracle) {
  lisco::ColumnClusterer clusterer;
  std::size_t joined = 0;
  const std::uint64_t count = timesEffort(60);
  const std::uint64_t seeds = 10'000'000 * (1 + static_cast<std::uint64_t>(GetParam()));
  for (std::uint64_t seed = seeds; seed < seeds + count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const PairScan pairs = disordered(random, randomPairs(random), GetParam());
    const SimdLevel level(levels()[seed % levels().size()]);
    const Clustering right = trueClusters(pairs.scan.points(), pairs.tolerance);
    Setting hinted{"hints of the scan", {}};
    hinted.parameters.sensor = pairs.hints;
    hinted.parameters.block_columns = random.oneOf(std::array<std::size_t, 5>{64, 64, 1, 16, 1 + random.below(64)});
    hinted.parameters.threads = random.chance(0.5) ? random.below(5) : 1;
    // The scan's hints, and wrong ones.
    for (const Setting& setting : {hinted, allSettings()[seed % allSettings().size()]}) {
      lisco::Parameters parameters = setting.parameters;
      parameters.tolerance = pairs.tolerance;
      clusterer.begin(parameters);
      feed(clusterer, random, pairs.scan);
      ASSERT_EQ(difference(right, clustersOf(clusterer)), "") << setting.name << ", " << lisco::simdLevel();
    }
    for (const Cluster& cluster : right) joined += cluster.members.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(joined, count * 10) << "too few pairs are neighbours";
}

}  // namespace
}  // namespace lisco_test
