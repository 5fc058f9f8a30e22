// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/endless_clusterer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "endless_streams.h"
#include "engine.h"
#include "random.h"

namespace lisco_test {
namespace {

TEST(EndlessClusterer, DeliversEachClusterOnceAndInTime) {
  lisco::EndlessClusterer clusterer;
  std::size_t cut = 0, continued = 0, outliers = 0, across_the_seam = 0;
  for (std::uint64_t seed = 1; seed <= timesEffort(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const EndlessStream stream = randomEndlessStream(random);
    const EndlessTruth truth = endlessTruth(stream);
    expectSame(stream, truth.deliveries, deliveriesOf(clusterer, stream));
    if (HasFailure()) return;
    outliers += truth.outliers;
    EXPECT_EQ(clusterer.outlierCount(), truth.outliers);
    for (const Delivery& delivery : truth.deliveries) {
      cut += delivery.cut ? 1 : 0;
      continued += delivery.continued ? 1 : 0;
      across_the_seam += std::floor(delivery.first_position) < std::floor(delivery.last_position) ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 100U);  // the streams cover these cases
  EXPECT_GT(continued, 100U);
  EXPECT_GT(outliers, 100U);
  EXPECT_GT(across_the_seam, 1000U);
}

// The definition holds after 2000 years of turns as after one.
TEST(EndlessClusterer, KeepsItsDefinitionAtAnyPosition) {
  lisco::EndlessClusterer clusterer;
  std::size_t together = 0;
  for (const double start : {0.0, 1e3, 1e9, 3.4e10, 999999990000.0, -1e3, -3.4e10, -1e12}) {
    for (std::uint64_t seed = 1; seed <= timesEffort(300); ++seed) {
      SCOPED_TRACE("from " + std::to_string(start) + ", seed " + std::to_string(seed));
      Random random(seed);
      const EndlessStream stream = random.chance(0.3) ? randomEndlessStream(random, start + random.unit())
                                                      : latestNeighbours(random, start + random.unit());
      const EndlessTruth truth = endlessTruth(stream);
      expectSame(stream, truth.deliveries, deliveriesOf(clusterer, stream));
      for (const Delivery& delivery : truth.deliveries) together += delivery.members.size() == 2 ? 1 : 0;
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(together, 1000U);
}

TEST(EndlessClusterer, DeliversAPairAtTheEndOfItsReachAfterManyTurns) {
  lisco::EndlessParameters parameters;
  parameters.tolerance = 0.01F;
  parameters.stagger = 0.02;
  parameters.block_columns = 1;
  constexpr double kFirst = 999999999999.0;
  const EndlessStream stream{parameters,
                             {{kFirst, {{29.9940014F, 0.599870026F, 0, 0}}},
                              {kFirst + 52 / 8192.0, {}},
                              {kFirst + 52 / 8192.0, {{29.9940681F, 0.59655571F, 0, 1}}}}};
  lisco::EndlessClusterer clusterer;
  const std::vector<Delivery> deliveries = deliveriesOf(clusterer, stream);
  ASSERT_EQ(deliveries.size(), 1U);
  EXPECT_EQ(deliveries.front().members, (std::vector<std::uint32_t>{0, 1}));
}

// One instance for the turns of a year at 20 Hz, most of them skipped.
TEST(EndlessClusterer, KeepsItsDefinitionForAYearOfTurns) {
  constexpr double kYear = 365.25 * 24 * 3600 * 20;
  constexpr int kBursts = 600;
  Random random(20);
  const lisco::EndlessParameters parameters = randomEndlessStream(random).parameters;
  lisco::EndlessClusterer clusterer;
  std::vector<Delivery> deliveries;
  std::size_t column = 0;
  const auto receive = [&](const lisco::EndlessCluster& cluster) { deliveries.push_back(deliveryOf(cluster, column)); };
  clusterer.begin(parameters, receive);
  std::size_t returns = 0;
  for (int burst = 0; burst < kBursts; ++burst) {
    SCOPED_TRACE("burst " + std::to_string(burst));
    EndlessStream stream = randomEndlessStream(random, kYear * burst / kBursts + random.unit(), &parameters);
    // A column two turns later delivers all open clusters.
    stream.columns.push_back({stream.columns.empty() ? 0 : stream.columns.back().position + 2, {}});
    deliveries.clear();
    for (column = 0; column < stream.columns.size(); ++column)
      clusterer.addColumn(stream.columns[column].cells.data(), stream.columns[column].cells.size(),
                          stream.columns[column].position);
    const EndlessTruth truth = endlessTruth(stream);
    std::sort(deliveries.begin(), deliveries.end());
    expectSame(stream, truth.deliveries, deliveries);
    if (HasFailure()) return;
    for (const Delivery& delivery : truth.deliveries) returns += delivery.members.size();
  }
  clusterer.finish();
  EXPECT_EQ(clusterer.returnCount(), returns);
}

TEST(EndlessClusterer, PositionsByTheNumberOfColumnsDoNotDrift) {
  lisco::EndlessParameters parameters;
  parameters.columns_per_turn = 1800;
  lisco::EndlessClusterer clusterer;
  clusterer.begin(parameters, [](const lisco::EndlessCluster&) {});
  EXPECT_EQ(clusterer.nextPosition(), 0.0);
  for (const double start : {0.0, 1e9, 3.4e10, 999999990000.0}) {
    clusterer.addColumn(nullptr, 0, start);
    constexpr int kColumns = 200000;
    for (int i = 1; i < kColumns; ++i) clusterer.addColumn(nullptr, 0);
    EXPECT_EQ(clusterer.nextPosition(), start + kColumns / 1800.0);
  }
  clusterer.finish();
  EXPECT_EQ(clusterer.nextPosition(), 0.0);
}

// The reach end is later than the exact one by what the header states, and never earlier.
TEST(EndlessClusterer, ReachEndsAreWithinTheRoundingStated) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kRounding = 0.006 / (2 * kPi);
  lisco::EndlessClusterer clusterer;
  lisco::EndlessParameters parameters;
  parameters.tolerance = 1;
  for (const double position : {0.0, 0.12, 1e9})
    for (const double stagger : {0.0, 0.01, 0.39})
      for (const double rho :
           {0.5, 1.0, 1.00000012, 1.0000018, 1.0000022, 1.00001, 1.001, 1.1, 2.0, 10.0, 1000.0, 1e19}) {
        SCOPED_TRACE("position " + std::to_string(position) + ", rho " + std::to_string(rho));
        parameters.stagger = stagger;
        parameters.start_azimuth = -2 * kPi * (position - std::floor(position));
        double reach_end = 0;
        clusterer.begin(parameters, [&](const lisco::EndlessCluster& cluster) { reach_end = cluster.reachEnd(); });
        const lisco::Return cell{static_cast<float>(rho), 0, 0, 0};
        clusterer.addColumn(&cell, 1, position);
        clusterer.finish();
        EXPECT_EQ(clusterer.outlierCount(), 0U);
        const double latest = (std::floor(8 * position) + 4) / 8;
        const bool is_near = rho <= 1 + lisco::kNearMargin;
        const double reach =
            is_near ? 0 : position + (std::asin(1 / static_cast<double>(cell.x)) + 2 * stagger) / (2 * kPi);
        const double exact = is_near ? latest : std::min(reach, latest);
        EXPECT_GE(reach_end, exact);
        EXPECT_LE(reach_end, std::min(exact + kRounding, latest));
      }
}

// Squares of horizontal distances overflow a float from 1.8e19 m on and underflow below 1e-23 m.
TEST(EndlessClusterer, KeepsItsDefinitionAtAnyDistance) {
  lisco::EndlessClusterer clusterer;
  std::size_t outliers = 0;
  for (const double factor : {1e-30, 1e-24, 1e-19, 1e17, 1e19, 1e30, 1e36})
    for (std::uint64_t seed = 1; seed <= timesEffort(200); ++seed) {
      SCOPED_TRACE("times " + std::to_string(factor) + ", seed " + std::to_string(seed));
      Random random(seed);
      EndlessStream stream = randomEndlessStream(random);
      scale(stream, factor);
      if (factor > 1) stream.parameters.tolerance *= 1e17F;
      const EndlessTruth truth = endlessTruth(stream);
      expectSame(stream, truth.deliveries, deliveriesOf(clusterer, stream));
      EXPECT_EQ(clusterer.outlierCount(), truth.outliers);
      outliers += truth.outliers;
      if (HasFailure()) return;
    }
  EXPECT_GT(outliers, 100U);
}

// begin () during a stream, and finish () during a turn.
TEST(EndlessClusterer, StartsAfreshAtAnyTime) {
  lisco::EndlessClusterer clusterer;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const EndlessStream lost = randomEndlessStream(random);
    clusterer.begin(lost.parameters, [](const lisco::EndlessCluster&) {});
    for (std::size_t i = 0; i < lost.columns.size() / 2; ++i)
      clusterer.addColumn(lost.columns[i].cells.data(), lost.columns[i].cells.size(), lost.columns[i].position);
    const EndlessStream stream = randomEndlessStream(random);
    expectSame(stream, endlessTruth(stream).deliveries, deliveriesOf(clusterer, stream));

    // Clusters after finish () are independent of those before.
    std::vector<std::size_t> sizes;
    clusterer.begin(stream.parameters, [&](const lisco::EndlessCluster& cluster) { sizes.push_back(cluster.size()); });
    const lisco::Return cell{1, 0, 0, 0};
    for (int i = 0; i < 2; ++i) {
      clusterer.addColumn(&cell, 1, 5.0);
      clusterer.finish();
    }
    EXPECT_EQ(sizes, std::vector<std::size_t>(2, 1));
    if (HasFailure()) return;
  }
}

TEST(EndlessClusterer, DeliversClustersOfTheMinimumSize) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    EndlessStream stream = randomEndlessStream(random);
    std::vector<Delivery> expected = endlessTruth(stream).deliveries;
    stream.parameters.min_size = 3;
    stream.parameters.max_size = 20;
    const auto isUnwanted = [](const Delivery& delivery) {
      return delivery.members.size() < 3 || delivery.members.size() > 20;
    };
    expected.erase(std::remove_if(expected.begin(), expected.end(), isUnwanted), expected.end());
    lisco::EndlessClusterer clusterer;
    expectSame(stream, expected, deliveriesOf(clusterer, stream));
  }
}

TEST(EndlessClusterer, AcceptsColumnsWithoutPositions) {
  lisco::EndlessClusterer clusterer;
  lisco::EndlessParameters parameters;
  parameters.tolerance = 0.5F;
  parameters.columns_per_turn = 100;
  std::vector<double> positions;
  clusterer.begin(parameters,
                  [&](const lisco::EndlessCluster& cluster) { positions.push_back(cluster.firstPosition()); });
  for (int i = 0; i < 300; ++i) {
    const lisco::Return cell{10, 0, 0, 0};
    clusterer.addColumn(&cell, i % 100 == 0 ? 1 : 0);
  }
  clusterer.finish();
  ASSERT_EQ(positions.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(positions[i], static_cast<double>(i), 1e-9);
}

TEST(EndlessClusterer, RejectsWrongArguments) {
  lisco::EndlessClusterer clusterer;
  const lisco::Return cells[2] = {{1, 0, 0, 0}, {1, 0, 1, 1}};
  const auto ignore = [](const lisco::EndlessCluster&) {};
  EXPECT_THROW(clusterer.addColumn(cells, 1, 0.0), std::logic_error);
  EXPECT_THROW(clusterer.addColumn(cells, 1), std::logic_error);
  lisco::EndlessParameters parameters;
  for (const double stagger : {-0.1, 0.4, std::numeric_limits<double>::quiet_NaN()}) {
    parameters.stagger = stagger;
    EXPECT_THROW(clusterer.begin(parameters, ignore), std::invalid_argument) << stagger;
  }
  parameters.stagger = 0.1;
  for (const float coordinate : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    lisco::EndlessParameters elsewhere = parameters;
    elsewhere.origin[1] = coordinate;
    EXPECT_THROW(clusterer.begin(elsewhere, ignore), std::invalid_argument) << coordinate;
  }
  for (const double azimuth : {std::numeric_limits<double>::quiet_NaN(), -2e6, 1e300}) {
    lisco::EndlessParameters turned = parameters;
    turned.start_azimuth = azimuth;
    EXPECT_THROW(clusterer.begin(turned, ignore), std::invalid_argument) << azimuth;
  }
  EXPECT_THROW(clusterer.begin(parameters, {}), std::invalid_argument);
  parameters.lasers = 1;
  clusterer.begin(parameters, ignore);
  EXPECT_THROW(clusterer.addColumn(cells, 1), std::logic_error);
  EXPECT_THROW(clusterer.addColumn(cells, 2, 0.0), std::invalid_argument);
  for (const double position :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e13})
    EXPECT_THROW(clusterer.addColumn(cells, 1, position), std::invalid_argument) << position;
  clusterer.addColumn(cells, 1, 2.0);
  EXPECT_THROW(clusterer.addColumn(cells, 1, 1.999), std::invalid_argument);
  clusterer.addColumn(cells, 1, 2.0);
  clusterer.update();
  EXPECT_EQ(clusterer.returnCount(), 2U);
}

}  // namespace
}  // namespace lisco_test
