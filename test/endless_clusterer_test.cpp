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
  std::size_t cut = 0, continued = 0, strays = 0, across_the_seam = 0;
  for (std::uint64_t seed = 1; seed <= timesEffort(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const EndlessStream stream = randomEndlessStream(random);
    const EndlessTruth truth = endlessTruth(stream);
    expectSame(stream, truth.deliveries, deliveriesOf(clusterer, stream));
    if (HasFailure()) return;
    strays += truth.strays;
    EXPECT_EQ(clusterer.strayCount(), truth.strays);
    for (const Delivery& delivery : truth.deliveries) {
      cut += delivery.cut ? 1 : 0;
      continued += delivery.continued ? 1 : 0;
      across_the_seam += std::floor(delivery.first_position) < std::floor(delivery.last_position) ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 100U);  // the streams try what they are to try
  EXPECT_GT(continued, 100U);
  EXPECT_GT(strays, 100U);
  EXPECT_GT(across_the_seam, 1000U);
}

// begin () in the midst of a stream, and finish () in the midst of a turn.
TEST(EndlessClusterer, MayBeUsedAgain) {
  lisco::EndlessClusterer clusterer;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const EndlessStream lost = randomEndlessStream(random);
    clusterer.begin(lost.parameters, [](const lisco::EndlessCluster&) {});
    for (std::size_t i = 0; i < lost.columns.size() / 2; ++i)
      clusterer.addColumn(lost.columns[i].cells.data(), lost.columns[i].cells.size(), lost.columns[i].position);
    const EndlessStream stream = randomEndlessStream(random);
    expectSame(stream, endlessTruth(stream).deliveries, deliveriesOf(clusterer, stream));

    // What follows finish () has nothing to do with what was before.
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

TEST(EndlessClusterer, DeliversWhatIsLargeEnough) {
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

TEST(EndlessClusterer, ColumnsWithoutPositions) {
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

TEST(EndlessClusterer, SaysWhatIsWrong) {
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
