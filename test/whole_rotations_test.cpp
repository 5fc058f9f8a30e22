// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Whole rotations that are added at once, whose near returns are sorted; and what may come before and after them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/neighbour.h"
#include "core/unordered_returns.h"
#include "engine.h"
#include "lisco/column_clusterer.h"
#include "lisco/simd.h"
#include "oracle.h"
#include "random.h"
#include "recordings.h"
#include "scans.h"

namespace lisco_test {
namespace {

constexpr std::size_t kSortedColumns = 256;
constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A clusterer and the columns that it has received so far.
class Feeder {
 public:
  Feeder(lisco::ColumnClusterer& clusterer, const Recording& recording, const lisco::Parameters& parameters)
      : clusterer_(clusterer), scan_(recording.scan), tolerance_(parameters.tolerance) {
    clusterer_.begin(parameters);
  }

  std::size_t left() const { return scan_.columns - received_; }

  void add(std::size_t count) {
    clusterer_.addColumns(count, scan_.lasers, [this](std::size_t laser, std::size_t column) {
      return scan_.at(laser, received_ + column);
    });
    received_ += count;
  }

  /// The clusters, the order of the runs, and what lies in each cell.
  void expectExact() {
    std::vector<Point> points = scan_.points();
    for (std::size_t laser = 0; laser < scan_.lasers; ++laser)
      for (std::size_t column = received_; column < scan_.columns; ++column) points[cell(laser, column)] = {0, 0, 0};
    ASSERT_EQ(difference(trueClusters(points, tolerance_), clustersOf(clusterer_)), "") << received_ << " columns";
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> subcluster_of(points.size(), kNone);
    clusterer_.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
      order.insert(order.end(), source_indices, source_indices + count);
      for (std::size_t i = 0; i < count; ++i) subcluster_of[source_indices[i]] = subcluster;
    });
    ASSERT_TRUE(std::is_sorted(order.begin(), order.end())) << "not laser by laser";
    for (std::size_t laser = 0; laser < scan_.lasers; ++laser)
      for (std::size_t column = 0; column < scan_.columns; ++column)
        ASSERT_EQ(clusterer_.subclusterAt(laser, column), subcluster_of[cell(laser, column)])
            << "laser " << laser << ", column " << column;
  }

 private:
  std::size_t cell(std::size_t laser, std::size_t column) const { return laser * scan_.columns + column; }

  lisco::ColumnClusterer& clusterer_;
  const Scan& scan_;
  float tolerance_;
  std::size_t received_ = 0;
};

lisco::Parameters parametersFor(Random& random, const Recording& recording, std::size_t threads) {
  lisco::Parameters parameters;
  parameters.tolerance = recording.tolerance;
  parameters.threads = threads;
  parameters.block_columns = random.oneOf(std::array<std::size_t, 5>{64, 64, 64, 16, 1 + random.below(64)});
  const std::size_t known = random.below(10);
  if (known < 5) parameters.sensor = recording.hints;
  if (known == 9) parameters.sensor = hintsFor(512, static_cast<float>(random.magnitude(0.002, 0.5)), true);
  return parameters;
}

/// How columns come.
struct Feeding {
  const char* name;
  void (*feed)(Random&, Feeder&);
};
void PrintTo(const Feeding& feeding, std::ostream* out) {
  *out << feeding.name;
}

void addRest(Random& random, Feeder& feeder) {
  const std::array<std::size_t, 4> portions{1, 64, 1 + random.below(300), feeder.left()};
  const std::size_t portion = random.oneOf(portions);
  const double looks = random.chance(0.3) ? 0.05 : 0;
  while (feeder.left() > 0) {
    feeder.add(std::min(portion, feeder.left()));
    if (random.chance(looks)) feeder.expectExact();
    if (testing::Test::HasFailure()) return;
  }
}

std::size_t batchOf(Random& random, const Feeder& feeder) {
  return std::min(feeder.left(), kSortedColumns + random.below(feeder.left()));
}

void atOnce(Random& random, Feeder& feeder) {
  feeder.add(feeder.left());
  if (random.chance(0.3)) feeder.expectExact();
}
void thenMore(Random& random, Feeder& feeder) {
  feeder.add(batchOf(random, feeder));
  addRest(random, feeder);
}
void updatedThenMore(Random& random, Feeder& feeder) {
  feeder.add(batchOf(random, feeder));
  feeder.expectExact();
  addRest(random, feeder);
}
void afterSomeColumns(Random& random, Feeder& feeder) {
  const std::size_t count = 1 + random.below(random.chance(0.7) ? 20 : 100);
  if (random.chance(0.5))
    feeder.add(std::min(count, feeder.left()));
  else
    for (std::size_t i = 0; i < count && feeder.left() > 0; ++i) feeder.add(1);
  if (random.chance(0.2)) feeder.expectExact();
  if (feeder.left() > 0) feeder.add(batchOf(random, feeder));
  if (random.chance(0.2)) feeder.expectExact();
  addRest(random, feeder);
}

class WholeRotations : public testing::TestWithParam<Feeding> {};
INSTANTIATE_TEST_SUITE_P(Feedings, WholeRotations,
                         testing::Values(Feeding{"at_once", atOnce}, Feeding{"then_more", thenMore},
                                         Feeding{"updated_then_more", updatedThenMore},
                                         Feeding{"after_some_columns", afterSomeColumns}),
                         [](const auto& feeding) { return std::string(feeding.param.name); });

/// Tries recordings with one clusterer: what is left in it of one does not matter for the next.
void tryRecordings(std::uint64_t first, std::uint64_t count, const Feeding& feeding, bool in_threads) {
  lisco::ColumnClusterer clusterer;
  for (std::uint64_t seed = first; seed < first + timesEffort(count); ++seed) {
    Random random(seed);
    Recording recording = randomRecording(random);
    if (in_threads) {  // enough cells for them
      constexpr std::size_t kCells = 8192;
      recording.scan = widened(random, recording.scan, kCells / recording.scan.lasers + 1);
    }
    const lisco::Parameters parameters = parametersFor(random, recording, in_threads ? 1 + random.below(8) : 1);
    const SimdLevel level(levels()[seed % levels().size()]);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + lisco::simdLevel() + ", " +
                 std::to_string(recording.scan.lasers) + " x " + std::to_string(recording.scan.columns) + ", " +
                 std::to_string(parameters.threads) + " threads");
    Feeder feeder(clusterer, recording, parameters);
    feeding.feed(random, feeder);
    feeder.expectExact();
    if (testing::Test::HasFailure()) return;
  }
}

TEST_P(WholeRotations, EqualTheOracle) {
  tryRecordings(1, 250, GetParam(), false);
}

TEST_P(WholeRotations, EqualTheOracleInThreads) {
  tryRecordings(1'000'000, 100, GetParam(), true);
}

// One rotation like the other: where their far returns are not worth range images, later ones are read without, and
// others of them with images again. Among them one column by column, and one of a copy.
TEST(WholeRotations, OneLikeTheOtherEqualTheOracle) {
  constexpr std::size_t kRotations = 24, kColumnByColumn = 7, kOfACopy = 9;
  for (std::uint64_t seed = 4'000'000; seed < 4'000'000 + timesEffort(60); ++seed) {
    Random random(seed);
    Recording recording = randomRecording(random);
    const bool in_threads = random.chance(0.3);
    if (in_threads) recording.scan = widened(random, recording.scan, 8192 / recording.scan.lasers + 1);
    lisco::Parameters parameters = parametersFor(random, recording, in_threads ? 2 + random.below(2) : 1);
    parameters.sensor = recording.hints;
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(parameters.threads) + " threads");
    lisco::ColumnClusterer clusterer;
    for (std::size_t rotation = 0; rotation < kRotations; ++rotation) {
      if (rotation == kOfACopy) clusterer = lisco::ColumnClusterer(clusterer);
      Feeder feeder(clusterer, recording, parameters);
      while (feeder.left() > 0) feeder.add(rotation == kColumnByColumn ? 1 : feeder.left());
      feeder.expectExact();
      ASSERT_FALSE(HasFailure()) << "rotation " << rotation;
    }
  }
}

// Single columns wait to be read in blocks: a whole rotation that follows does not overtake them.
TEST(WholeRotations, KeepTheirPlaceBehindSomeColumns) {
  for (const std::size_t columns_before : {1, 15, 16, 63, 64, 65, 100}) {
    Recording recording;
    recording.scan = Scan(columns_before + kSortedColumns, 1);
    for (std::size_t column = 0; column < recording.scan.columns; ++column)
      recording.scan.set(0, column, {10, 2 * static_cast<float>(column), 0});
    lisco::ColumnClusterer clusterer;
    lisco::Parameters parameters;
    parameters.tolerance = 1;
    Feeder feeder(clusterer, recording, parameters);
    for (std::size_t i = 0; i < columns_before; ++i) feeder.add(1);
    feeder.add(kSortedColumns);
    feeder.expectExact();
  }
}

// As they come from filters: no order, no sensor, and tolerances by which pairs change sides.
TEST(WholeRotations, OfAnyScanEqualTheOracle) {
  lisco::ColumnClusterer clusterer;
  for (std::uint64_t seed = 2'000'000; seed < 2'000'000 + timesEffort(400); ++seed) {
    Random random(seed);
    float spacing = 0;
    Recording recording;
    const std::size_t kind = random.below(4);
    recording.scan = kind == 0 ? latticeScan(random, spacing) : kind == 1 ? extremeScan(random) : randomScan(random);
    recording.scan = widened(random, recording.scan, kSortedColumns + random.below(100));
    recording.tolerance = criticalTolerance(random, recording.scan);
    recording.hints = hintsFor(512, static_cast<float>(random.magnitude(0.002, 0.5)), random.chance(0.5));
    const lisco::Parameters parameters = parametersFor(random, recording, 1);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Feeder feeder(clusterer, recording, parameters);
    (random.chance(0.5) ? atOnce : updatedThenMore)(random, feeder);
    feeder.expectExact();
    if (HasFailure()) return;
  }
}

// Columns of which each return is a run: some at first, then one by one.
TEST_P(WholeRotations, OfUnorderedReturnsEqualTheOracle) {
  lisco::ColumnClusterer clusterer;
  std::size_t unordered = 0;
  const std::uint64_t count = timesEffort(150);
  for (std::uint64_t seed = 3'000'000; seed < 3'000'000 + count; ++seed) {
    Random random(seed);
    Recording recording = randomRecording(random);
    recording.scan = widened(random, recording.scan, kSortedColumns + random.below(300));
    std::vector<Point> points = recording.scan.points();
    random.shuffle(points);
    const std::size_t lasers = recording.scan.lasers;
    const std::size_t columns = recording.scan.columns;
    for (std::size_t cell = 0; cell < points.size(); ++cell)
      recording.scan.set(cell / columns, cell % columns, points[cell]);
    lisco::Parameters parameters = parametersFor(random, recording, random.chance(0.3) ? 1 + random.below(8) : 1);
    parameters.sensor = lisco::SensorHints();
    const auto cells = [&](std::size_t laser, std::size_t column) { return recording.scan.at(laser, column); };
    unordered += lisco::UnorderedReturns::isUnordered(columns, lasers, lisco::CellSource(cells),
                                                      lisco::Tolerance(recording.tolerance))
                     ? 1
                     : 0;
    const SimdLevel level(levels()[seed % levels().size()]);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + lisco::simdLevel() + ", " + std::to_string(lasers) + " x " +
                 std::to_string(columns) + ", " + std::to_string(parameters.threads) + " threads");
    Feeder feeder(clusterer, recording, parameters);
    GetParam().feed(random, feeder);
    feeder.expectExact();
    if (HasFailure()) return;
  }
  EXPECT_GT(unordered, count / 3);
}

}  // namespace
}  // namespace lisco_test
