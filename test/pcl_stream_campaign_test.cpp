// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The streaming classes against brute force: random streams of columns, at any moment and in any mode.
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "column_streams.h"
#include "engine.h"
#include "pair_scans.h"
#include "pcl_oracle.h"
#include "pcl_stream.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;

/// Content of a vector before a call that appends to it.
Clusters someClusters(Random& random) {
  Clusters clusters(random.chance(0.8) ? 0 : 2);
  for (auto& cluster : clusters) cluster.indices.resize(1 + random.below(8));
  return clusters;
}

// --- Rotation by rotation -------------------------------------------------------------------------------------------

class Rotations {
 public:
  /// A rotation that may be aborted, with queries in between.
  void rotate(Random& random) {
    const ColumnStream stream = random.chance(0.9) ? randomColumnStream(random) : pairStream(random);
    columns_ = columnsOf(stream);
    request_ = requestFor(random, stream);
    header_ = anyHeader(static_cast<std::uint32_t>(random.below(1000)));
    const std::array<float, 3>& origin = stream.parameters.origin;
    origin_ = random.chance(0.8) ? Eigen::Vector4f(origin[0], origin[1], origin[2], 0) : Eigen::Vector4f(9, 9, 9, 0);
    set(stream_, request_);
    stream_.setHeader(header_);
    stream_.setSensorOrigin(origin_);
    stream_.setBlockColumns(random.oneOf(std::array<std::size_t, 6>{1, 2, 7, 16, 64, 64}));
    stream_.beginRotation();
    const double queries = random.chance(0.5) ? random.magnitude(0.5, 20) / static_cast<double>(columns_.size()) : 0.0;
    const std::size_t end = random.chance(0.1) ? random.below(columns_.size()) : columns_.size();
    for (std::size_t column = 0; column < end; ++column) {
      ASSERT_TRUE(add(stream_, random, columns_[column]));
      if (random.chance(queries)) query(random, column + 1);
      if (testing::Test::HasFatalFailure()) return;
    }
    if (end < columns_.size()) return;
    const auto cloud = cloudOfFirst(end);
    Clusters expected = someClusters(random);
    Clusters found = expected;
    appendTrueClusters(*cloud, request_, expected);
    Cloud streamed;
    ASSERT_TRUE(random.chance(0.5) ? stream_.endRotation(found, streamed) : stream_.endRotation(found));
    ASSERT_TRUE(expectSame(expected, found));
    query(random, end);
  }

 private:
  /// Of as many columns as a sensor has: the next rotation uses what it has estimated.
  static ColumnStream pairStream(Random& random) {
    const PairScan pairs = randomPairs(random);
    ColumnStream stream;
    stream.parameters.tolerance = pairs.tolerance;
    stream.parameters.origin = pairs.hints.origin;
    for (std::size_t column = 0; column < pairs.scan.columns; ++column)
      stream.columns.push_back({0.0, pairs.scan.column(column)});
    return stream;
  }

  Cloud::Ptr cloudOfFirst(std::size_t end) const { return organized(columns_, 0, end, header_); }

  /// Compares all queries about the columns so far with the oracle, once or several times.
  void query(Random& random, std::size_t end) {
    const auto cloud = cloudOfFirst(end);
    do {
      switch (random.below(3)) {
        case 0: {
          Clusters expected;
          Clusters found = someClusters(random);
          appendTrueClusters(*cloud, request_, expected);
          stream_.getSubclusters(found);
          ASSERT_TRUE(expectSame(expected, found)) << "after " << end << " columns";
          break;
        }
        case 1: {
          Cloud streamed;
          stream_.getCloud(streamed);
          expectSameCloud(*cloud, streamed);
          EXPECT_EQ(streamed.sensor_origin_, origin_);
          break;
        }
        default:
          lookAtNumbers(*cloud, end);
      }
      if (testing::Test::HasFatalFailure()) return;
    } while (random.chance(0.5));
  }

  void lookAtNumbers(const Cloud& cloud, std::size_t end) {
    const Clusters expected = trueClustersOf(cloud, {request_.tolerance});
    std::vector<pcl::uindex_t> sizes;
    stream_.getSubclusterSizes(sizes);
    ASSERT_EQ(stream_.getNumberOfSubclusters(), expected.size());
    ASSERT_EQ(sizes.size(), expected.size());
    std::vector<pcl::index_t> number_of(cloud.size(), -1);
    for (const auto& cluster : expected) {
      const auto first = static_cast<std::size_t>(cluster.indices[0]);
      const pcl::index_t number = stream_.getSubcluster(first / end, first % end);
      ASSERT_TRUE(number >= 0 && static_cast<std::size_t>(number) < sizes.size());
      ASSERT_EQ(sizes[static_cast<std::size_t>(number)], cluster.indices.size());
      for (const pcl::index_t index : cluster.indices) number_of[static_cast<std::size_t>(index)] = number;
    }
    for (std::size_t row = 0; row <= cloud.height; ++row)
      for (std::size_t column = 0; column <= end; ++column)
        ASSERT_EQ(stream_.getSubcluster(row, column),
                  row < cloud.height && column < end ? number_of[row * end + column] : -1)
            << "row " << row << ", column " << column << " of " << end;
  }

  pcl::LiscoStreamExtraction<PointXYZ> stream_;
  Columns<PointXYZ> columns_;
  Request request_;
  pcl::PCLHeader header_;
  Eigen::Vector4f origin_ = Eigen::Vector4f::Zero();
};

TEST(PclStreamCampaign, RotationsEqualTheOracle) {
  std::optional<Rotations> rotations;
  for (std::uint64_t seed = 1; seed <= timesEffort(800); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    // One object for some rotations in a row, the first of which is reproduced by its seed alone.
    if (seed % 8 == 1) rotations.emplace();
    rotations->rotate(random);
    if (HasFailure()) return;
  }
}

// --- Sliding windows ------------------------------------------------------------------------------------------------

class Windows {
 public:
  /// A stream that begins again, with a query of the last window now and then, also some columns after its end.
  void slide(Random& random) {
    const ColumnStream stream = randomColumnStream(random);
    columns_ = columnsOf(stream);
    request_ = requestFor(random, stream);
    const std::size_t hop = 1 + random.below(random.chance(0.3) ? 100 : 10);
    const std::size_t window = hop * (1 + random.below(10));
    const double queries = random.magnitude(0.02, 0.7);
    set(windows_, request_);
    windows_.setHop(hop);
    windows_.setWindowSize(window);
    ASSERT_TRUE(windows_.beginStream());
    first_ = end_ = 0;
    const std::size_t last = random.chance(0.2) ? random.below(columns_.size()) : columns_.size();
    for (std::size_t column = 1; column <= last; ++column) {
      SCOPED_TRACE("window of " + std::to_string(window) + ", hop of " + std::to_string(hop) + ", column " +
                   std::to_string(column));
      ASSERT_EQ(add(windows_, random, columns_[column - 1]), column % hop == 0);
      if (column % hop == 0) {
        end_ = column;
        first_ = column - std::min(window, column);
      }
      while (random.chance(queries)) query(random);
      if (testing::Test::HasFatalFailure()) return;
    }
  }

  std::size_t queries() const { return queries_; }  ///< so far

 private:
  void query(Random& random) {
    ASSERT_EQ(windows_.getNumberOfColumns(), end_ - first_);
    const pcl::PCLHeader header = anyHeader(static_cast<std::uint32_t>(random.below(1000)));
    windows_.setHeader(header);
    const auto cloud = organized(columns_, first_, end_, header);
    if (end_ > 0 && random.chance(0.7)) {
      Clusters expected = someClusters(random);
      Clusters found = expected;
      appendTrueClusters(*cloud, request_, expected);
      ASSERT_TRUE(windows_.extract(found));
      ASSERT_TRUE(expectSame(expected, found));
      ++queries_;
    } else {
      Cloud streamed;
      windows_.getWindow(streamed);
      expectSameCloud(*cloud, streamed);
    }
  }

  pcl::LiscoWindowExtraction<PointXYZ> windows_;
  Columns<PointXYZ> columns_;
  Request request_;
  std::size_t first_ = 0, end_ = 0;
  std::size_t queries_ = 0;
};

TEST(PclStreamCampaign, WindowsEqualTheOracle) {
  std::optional<Windows> windows;
  std::size_t queries = 0;
  for (std::uint64_t seed = 1'000'000; seed < 1'000'000 + timesEffort(1500); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    if (seed % 8 == 0) windows.emplace();
    windows->slide(random);
    if (HasFailure()) return;
    if (seed % 8 == 7) queries += windows->queries();
  }
  EXPECT_GT(queries, timesEffort(1500 * 10));
}

// --- Without end ----------------------------------------------------------------------------------------------------

/// One object for some streams: each is begun again, and may be finished and continued, or left without an end.
class Endless {
 public:
  Endless() {
    endless_.setClusterCallback(
        [this](const EndlessReceiver::Extraction::Cluster& cluster) { receiver_.receive(cluster); });
  }

  void stream(Random& random) {
    const ColumnStream stream = randomColumnStream(random);
    const lisco::EndlessParameters& parameters = stream.parameters;
    request_ = requestFor(random, stream);
    header_ = anyHeader(static_cast<std::uint32_t>(random.below(1000)));
    set(endless_, request_);
    endless_.setHeader(header_);
    endless_.setSensorOrigin({parameters.origin[0], parameters.origin[1], parameters.origin[2], 0});
    endless_.setClockwise(parameters.clockwise);
    endless_.setStartAzimuth(parameters.start_azimuth);
    endless_.setStagger(parameters.stagger);
    endless_.setColumnsPerTurn(parameters.columns_per_turn);
    endless_.setBlockColumns(parameters.block_columns);
    ASSERT_TRUE(endless_.beginStream());
    returns_ = strays_ = 0;
    bool finished = true;
    for (std::size_t first = 0; first < stream.columns.size() && finished;) {
      const std::size_t columns = stream.columns.size() - first;
      const std::size_t count = random.chance(0.7) ? columns : 1 + random.below(columns);
      const double earlier = random.chance(0.3) ? random.between(0, 5) : 0.0;
      const ColumnStream part = partOf(stream, first, first + count, std::floor(earlier));
      finished = random.chance(0.8);
      run(random, part, finished);
      if (testing::Test::HasFailure()) return;
      first += count;
    }
  }

  std::size_t cut = 0, continued = 0, unfinished = 0;  ///< so far

 private:
  void run(Random& random, const ColumnStream& part, bool finished) {
    receiver_.expect(part, header_);
    const Columns<PointXYZ> columns = columnsOf(part);
    const double update = random.chance(0.5) ? random.magnitude(0.01, 1.0) : 0.0;
    std::vector<std::size_t> updates;
    for (std::size_t& column = receiver_.column; column < columns.size(); ++column) {
      const Cloud& points = columns[column];
      const double position = part.columns[column].position;
      const bool as_cloud = random.chance(0.5);
      if (part.is_by_rate[column])
        ASSERT_TRUE(as_cloud ? endless_.addColumn(points) : endless_.addColumn(points.points.data(), points.size()));
      else
        ASSERT_TRUE(as_cloud ? endless_.addColumn(points, position)
                             : endless_.addColumn(points.points.data(), points.size(), position));
      if (testing::Test::HasFatalFailure()) return;
      if (!random.chance(update)) continue;
      endless_.update();
      updates.push_back(column);
    }
    if (finished) endless_.finish();
    const EndlessTruth truth = endlessTruth(part);
    ASSERT_EQ(wrongDeliveries(part, wanted(truth.deliveries, request_), receiver_.deliveries(), updates, finished), "");
    for (const Delivery& delivery : receiver_.deliveries()) {
      cut += delivery.cut ? 1 : 0;
      continued += delivery.continued ? 1 : 0;
    }
    unfinished += finished ? 0 : 1;
    if (!finished) return;
    for (const Delivery& delivery : truth.deliveries) returns_ += delivery.members.size();
    strays_ += truth.outliers;
    EXPECT_EQ(endless_.getNumberOfReturns(), returns_);
    EXPECT_EQ(endless_.getNumberOfOutliers(), strays_);
    EXPECT_EQ(endless_.getNumberOfColumnsHeld(), 0U);
  }

  EndlessReceiver::Extraction endless_;
  EndlessReceiver receiver_;
  Request request_;
  pcl::PCLHeader header_;
  std::uint64_t returns_ = 0, strays_ = 0;
};

TEST(PclStreamCampaign, EndlessStreamsEqualTheDefinition) {
  std::optional<Endless> endless;
  std::size_t cut = 0, continued = 0, unfinished = 0;
  for (std::uint64_t seed = 2'000'000; seed < 2'000'000 + timesEffort(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    if (seed % 8 == 0) endless.emplace();
    endless->stream(random);
    if (HasFailure()) return;
    if (seed % 8 != 7) continue;
    cut += endless->cut;
    continued += endless->continued;
    unfinished += endless->unfinished;
  }
  EXPECT_GT(cut, 10U);  // the streams cover these cases
  EXPECT_GT(continued, 10U);
  EXPECT_GT(unfinished, 10U);
}

}  // namespace
}  // namespace lisco_test
