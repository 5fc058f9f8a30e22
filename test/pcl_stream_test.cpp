// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The streaming classes: whole vectors against PCL's and against the batch, at any moment and in any mode.
#include "pcl_stream.h"

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "engine.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;
using Stream = pcl::LiscoStreamExtraction<PointXYZ>;
using Windows = pcl::LiscoWindowExtraction<PointXYZ>;
using Endless = pcl::LiscoEndlessExtraction<PointXYZ>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Columns<PointXYZ> columnsOfBoxes(std::uint64_t seed = 1, std::size_t columns = 180, std::size_t lasers = 12) {
  Random random(seed);
  return columnsOf(*cloudOf(boxesAround(random, columns, lasers)));
}

/// A scan, and a tolerance and a least size that suit it.
std::pair<Columns<PointXYZ>, Request> anyColumns(Random& random) {
  float spacing = 0;
  Scan scan = random.chance(0.1)   ? latticeScan(random, spacing)
              : random.chance(0.1) ? extremeScan(random)
                                   : randomScan(random);
  Request request;
  request.tolerance =
      spacing > 0 ? static_cast<double>(spacing) * 1.0000001 : static_cast<double>(criticalTolerance(random, scan));
  request.min_size = static_cast<pcl::uindex_t>(1 + random.below(3));
  if (random.chance(0.2)) request.max_size = static_cast<pcl::uindex_t>(random.below(20));
  return {trimmed(random, columnsOf(*cloudOf(scan))), request};
}

/// Output of PCL_ERROR on stderr.
template <typename Action>
std::string errorOf(Action&& action) {
  testing::internal::CaptureStderr();
  action();
  return testing::internal::GetCapturedStderr();
}

/// Content of the vector before a call that clears it.
Clusters anyClusters() {
  Clusters clusters(2);
  clusters[0].indices = {1, 2, 3};
  return clusters;
}

// --- Rotation by rotation -------------------------------------------------------------------------------------------

// One object for all, with rotations that are aborted, and blocks of any number of columns.
TEST(PclStream, EqualsPclOnRandomScans) {
  Stream stream;
  for (std::uint64_t seed = 1; seed <= timesEffort(1500); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    if (random.chance(0.1)) {
      stream.beginRotation();
      for (const auto& column : columnsOfBoxes(seed, 1 + random.below(50), 1 + random.below(30)))
        add(stream, random, column);
    }
    stream.setBlockColumns(random.oneOf(std::vector<std::size_t>{0, 1, 3, 16, 64, 1000}));
    const auto [columns, request] = anyColumns(random);
    expectRotationSameAsPcl(stream, random, columns, request);
    if (HasFailure()) return;
  }
}

// Large enough to estimate the sensor: later rotations use the hints of those before, right or not.
TEST(PclStream, EqualsPclWithHintsOfTheRotationBefore) {
  Stream stream;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto cloud = cloudOf(seed % 4 == 0 ? cameraView(random, 100, 60)
                                             : boxesAround(random, 300 + 100 * (seed % 3), 16 + seed % 2));
    const bool moved = seed % 3 == 0;
    stream.setSensorOrigin(moved ? Eigen::Vector4f(30, -30, 3, 0) : Eigen::Vector4f::Zero());
    auto columns = columnsOf(moved ? *displaced(*cloud, 30, -30, 3, false) : *cloud);
    if (seed % 5 == 0) std::reverse(columns.begin(), columns.end());
    for (const double tolerance : {0.1, 0.4, 1.0})
      expectRotationSameAsPcl(stream, random, trimmed(random, columns), {tolerance});
    if (HasFailure()) return;
  }
}

TEST(PclStream, SubclustersAtAnyMomentEqualTheBatchSoFar) {
  Stream stream;
  for (std::uint64_t seed = 1; seed <= timesEffort(400); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto [columns, request] = anyColumns(random);
    set(stream, request);
    stream.setHeader(anyHeader());
    stream.beginRotation();
    for (std::size_t end = 0; end <= columns.size(); ++end) {
      if (end > 0) add(stream, random, columns[end - 1]);
      if (random.chance(0.3)) continue;
      const auto cloud = organized(columns, 0, end, anyHeader());
      Clusters clusters = anyClusters();
      stream.getSubclusters(clusters);
      ASSERT_TRUE(expectSame(batchClustersOf<PointXYZ>(cloud, request), clusters)) << "column " << end;
      Cloud streamed;
      stream.getCloud(streamed);
      expectSameCloud(*cloud, streamed);

      // The same by numbers.
      const Clusters all = batchClustersOf<PointXYZ>(cloud, {request.tolerance});
      std::vector<pcl::uindex_t> sizes{1, 2, 3};
      stream.getSubclusterSizes(sizes);
      ASSERT_EQ(stream.getNumberOfSubclusters(), all.size());
      ASSERT_EQ(sizes.size(), all.size());
      std::vector<pcl::index_t> expected(cloud->size(), -1);
      for (const auto& cluster : all) {
        const auto first = static_cast<std::size_t>(cluster.indices[0]);
        const pcl::index_t number = stream.getSubcluster(first / end, first % end);
        ASSERT_GE(number, 0);
        ASSERT_LT(static_cast<std::size_t>(number), sizes.size());
        EXPECT_EQ(sizes[static_cast<std::size_t>(number)], cluster.indices.size());
        for (const pcl::index_t index : cluster.indices) expected[static_cast<std::size_t>(index)] = number;
      }
      for (std::size_t row = 0; row < cloud->height + 2; ++row)
        for (std::size_t column = 0; column < end + 70; ++column)
          ASSERT_EQ(stream.getSubcluster(row, column),
                    row < cloud->height && column < end ? expected[row * end + column] : -1)
              << "row " << row << ", column " << column;
    }
    Clusters clusters;
    ASSERT_TRUE(stream.endRotation(clusters));
    expectSame(batchClustersOf<PointXYZ>(organized(columns, 0, columns.size(), anyHeader()), request), clusters);
    if (HasFailure()) return;
  }
}

TEST(PclStream, GivesTheLastRotationUntilTheNextBegins) {
  Stream stream;
  set(stream, {0.5, 3});
  stream.beginRotation();
  for (const auto& column : columnsOfBoxes()) stream.addColumn(column);
  Clusters ended;
  stream.endRotation(ended);
  Clusters subclusters;
  stream.getSubclusters(subclusters);
  EXPECT_GT(ended.size(), 3U);
  expectSame(ended, subclusters);
  EXPECT_GE(stream.getNumberOfSubclusters(), ended.size());
  stream.beginRotation();
  EXPECT_EQ(stream.getNumberOfSubclusters(), 0U);
  EXPECT_EQ(stream.getNumberOfColumns(), 0U);
  stream.getSubclusters(subclusters);
  EXPECT_TRUE(subclusters.empty());
}

TEST(PclStream, ClustersAreAppendedAndAllSortedAgain) {
  Stream stream;
  set(stream, {0.5});
  Clusters expected;
  Clusters actual;
  PclClient<PointXYZ> reference;
  for (std::uint32_t seed = 1; seed < 5; ++seed) {
    const auto columns = columnsOfBoxes(seed);
    const auto cloud = organized(columns, 0, columns.size(), anyHeader(seed));
    reference.extract(cloud, returnsOf(*cloud), {0.5}, expected);
    stream.setHeader(anyHeader(seed));
    stream.beginRotation();
    for (const auto& column : columns) stream.addColumn(column);
    ASSERT_TRUE(stream.endRotation(actual));
    ASSERT_TRUE(expectSame(expected, actual));
  }
}

// As the batch: no cell at all is an empty cloud, which clears the vector; cells without returns add nothing.
TEST(PclStream, AcceptsNoColumnsAndNoReturns) {
  Stream stream;
  for (const std::size_t columns : {0, 1, 70}) {
    Clusters clusters = anyClusters();
    stream.beginRotation();
    for (std::size_t i = 0; i < columns; ++i) EXPECT_TRUE(stream.addColumn(nullptr, 0));
    Cloud cloud;
    EXPECT_TRUE(stream.endRotation(clusters, cloud));
    EXPECT_TRUE(clusters.empty());
    EXPECT_TRUE(cloud.empty());
    EXPECT_EQ(cloud.width, columns);

    clusters = anyClusters();
    stream.beginRotation();
    const std::array<PointXYZ, 2> none{PointXYZ(0, 0, 0), PointXYZ(kNan, 1, 1)};
    for (std::size_t i = 0; i < columns; ++i) EXPECT_TRUE(stream.addColumn(none.data(), none.size()));
    EXPECT_TRUE(stream.endRotation(clusters));
    EXPECT_EQ(clusters.size(), columns == 0 ? 0U : 2U);
  }
}

TEST(PclStream, KeepsItsParameters) {
  Stream stream;
  EXPECT_EQ(stream.getClusterTolerance(), 0.0);
  EXPECT_EQ(stream.getMinClusterSize(), 1U);
  EXPECT_EQ(stream.getMaxClusterSize(), std::numeric_limits<pcl::uindex_t>::max());
  EXPECT_EQ(stream.getNumberOfLasers(), 0U);
  EXPECT_EQ(stream.getBlockColumns(), 64U);
  EXPECT_EQ(stream.getSensorOrigin(), Eigen::Vector4f::Zero());
  stream.setNumberOfLasers(64);
  stream.setBlockColumns(8);
  stream.setSensorOrigin({1, 2, 3, 0});
  stream.setHeader(anyHeader());
  EXPECT_EQ(stream.getNumberOfLasers(), 64U);
  EXPECT_EQ(stream.getBlockColumns(), 8U);
  EXPECT_EQ(stream.getSensorOrigin(), Eigen::Vector4f(1, 2, 3, 0));
  EXPECT_EQ(stream.getHeader(), anyHeader());
  Cloud cloud;
  cloud.sensor_orientation_ = Eigen::Quaternionf(0, 1, 0, 0);
  stream.getCloud(cloud);
  EXPECT_EQ(cloud.sensor_origin_, Eigen::Vector4f(1, 2, 3, 0));
  EXPECT_EQ(cloud.sensor_orientation_.coeffs(), Eigen::Quaternionf::Identity().coeffs());
}

TEST(PclStream, RejectsWrongCalls) {
  const std::vector<PointXYZ, Eigen::aligned_allocator<PointXYZ>> points(3, PointXYZ(1, 2, 3));
  const std::string method = "[pcl::LiscoStreamExtraction::addColumn]";
  Stream stream;
  stream.setClusterTolerance(0.5);
  Clusters clusters = anyClusters();
  Cloud cloud(3, 2);
  EXPECT_EQ(stream.getNumberOfSubclusters(), 0U);
  EXPECT_EQ(stream.getSubcluster(0, 0), -1);
  std::string error = errorOf([&] { EXPECT_FALSE(stream.addColumn(points.data(), 3)); });
  EXPECT_NE(error.find(method + " A column before beginRotation ()"), std::string::npos) << error;
  error = errorOf([&] { EXPECT_FALSE(stream.endRotation(clusters, cloud)); });
  EXPECT_NE(error.find("[pcl::LiscoStreamExtraction::endRotation]"), std::string::npos) << error;
  EXPECT_TRUE(clusters.empty());
  EXPECT_TRUE(cloud.empty());

  stream.setNumberOfLasers(2);
  stream.beginRotation();
  error = errorOf([&] { EXPECT_FALSE(stream.addColumn(points.data(), 3)); });
  EXPECT_NE(error.find(method), std::string::npos) << error;
  EXPECT_NE(error.find("3 rows, and only 2 lasers"), std::string::npos) << error;
  EXPECT_EQ(stream.getNumberOfColumns(), 0U);
  error = errorOf([&] { EXPECT_FALSE(stream.addColumn(nullptr, 1)); });
  EXPECT_NE(error.find(method), std::string::npos) << error;

  // The rotation that follows is clustered as usual.
  EXPECT_EQ(errorOf([&] { EXPECT_TRUE(stream.addColumn(points.data(), 2)); }), "");
  EXPECT_TRUE(stream.endRotation(clusters));
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_EQ(clusters[0].indices, (pcl::Indices{0, 1}));
  errorOf([&] { EXPECT_FALSE(stream.endRotation(clusters)); });
  errorOf([&] { EXPECT_FALSE(stream.addColumn(points.data(), 2)); });
}

// They are rejected before anything is read or kept.
TEST(PclStream, RejectsTooLargeClouds) {
  const PointXYZ point(1, 2, 3);
  Stream stream;
  stream.beginRotation();
  EXPECT_TRUE(stream.addColumn(nullptr, 0));
  for (const std::size_t rows : {std::size_t{1} << 30, std::size_t{1} << 31, std::size_t{1} << 62}) {
    const std::string error = errorOf([&] { EXPECT_FALSE(stream.addColumn(&point, rows)); });
    EXPECT_NE(error.find("index_t"), std::string::npos) << error;
  }
  EXPECT_EQ(stream.getNumberOfColumns(), 1U);
  Windows windows;
  windows.setWindowSize(std::size_t{1} << 29);
  windows.setHop(std::size_t{1} << 29);
  ASSERT_TRUE(windows.beginStream());
  EXPECT_NE(errorOf([&] { EXPECT_FALSE(windows.addColumn(&point, 4)); }), "");
}

TEST(PclStream, ObjectsWorkSideBySideInThreads) {
  std::vector<Clusters> found(2);
  const auto run = [](std::uint64_t seed, Clusters& clusters) {
    Stream stream;
    set(stream, {0.5});
    for (int i = 0; i < 5; ++i) {
      clusters.clear();
      stream.beginRotation();
      for (const auto& column : columnsOfBoxes(seed, 400, 16)) {
        stream.addColumn(column);
        if (stream.getNumberOfColumns() % 50 == 0) stream.getNumberOfSubclusters();
      }
      stream.endRotation(clusters);
    }
  };
  std::thread one(run, 1, std::ref(found[0]));
  std::thread two(run, 2, std::ref(found[1]));
  one.join();
  two.join();
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto columns = columnsOfBoxes(seed, 400, 16);
    expectSame(pclClustersOf<PointXYZ>(organized(columns, 0, columns.size(), {}), {0.5}), found[seed - 1]);
  }
}

// --- Sliding windows ------------------------------------------------------------------------------------------------

TEST(PclWindows, EqualPcl) {
  Windows windows;
  for (std::uint64_t seed = 1; seed <= timesEffort(1000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto [columns, request] = anyColumns(random);
    const std::size_t hop = 1 + random.below(8);
    expectWindowsSameAsPcl(windows, random, columns, request, hop * (1 + random.below(8)), hop);
    if (HasFailure()) return;
  }
}

TEST(PclWindows, EqualPclOverSeveralTurns) {
  Windows windows;
  Random random(1);
  Columns<PointXYZ> columns;
  for (int turn = 0; turn < 4; ++turn)
    for (const auto& column : columnsOfBoxes(3, 180, 12)) columns.push_back(column);
  expectWindowsSameAsPcl(windows, random, columns, {0.5, 2}, 180, 20);
  expectWindowsSameAsPcl(windows, random, columns, {0.5, 2}, 90, 90);
  expectWindowsSameAsPcl(windows, random, columns, {1.5, 2}, 300, 75);
}

TEST(PclWindows, RejectWrongCalls) {
  const std::vector<PointXYZ, Eigen::aligned_allocator<PointXYZ>> points(3, PointXYZ(1, 2, 3));
  Windows windows;
  EXPECT_EQ(windows.getWindowSize(), 0U);
  EXPECT_EQ(windows.getHop(), 1U);
  std::string error = errorOf([&] { EXPECT_FALSE(windows.addColumn(points.data(), 3)); });
  EXPECT_NE(error.find("[pcl::LiscoWindowExtraction::addColumn] A column before"), std::string::npos) << error;
  for (const auto& [window, hop] : {std::pair<std::size_t, std::size_t>{0, 1}, {10, 0}, {10, 3}, {2, 4}}) {
    windows.setWindowSize(window);
    windows.setHop(hop);
    error = errorOf([&] { EXPECT_FALSE(windows.beginStream()); });
    EXPECT_NE(error.find("[pcl::LiscoWindowExtraction::beginStream]"), std::string::npos) << error;
  }
  windows.setWindowSize(2);
  windows.setHop(1);
  windows.setNumberOfLasers(2);
  ASSERT_TRUE(windows.beginStream());
  Clusters clusters = anyClusters();
  Cloud cloud(3, 2);
  error = errorOf([&] { EXPECT_FALSE(windows.extract(clusters)); });
  EXPECT_NE(error.find("[pcl::LiscoWindowExtraction::extract]"), std::string::npos) << error;
  EXPECT_TRUE(clusters.empty());
  windows.getWindow(cloud);
  EXPECT_TRUE(cloud.empty());
  error = errorOf([&] { EXPECT_FALSE(windows.addColumn(points.data(), 3)); });
  EXPECT_NE(error.find("2 lasers"), std::string::npos) << error;
  EXPECT_TRUE(windows.addColumn(points.data(), 2));
  EXPECT_TRUE(windows.extract(clusters));
  EXPECT_EQ(clusters.size(), 2U);  // of tolerance 0
}

// --- Without end ----------------------------------------------------------------------------------------------------

using EndlessColumn = std::pair<double, Cloud>;  ///< with its position

/// A room with objects in it, for some turns; one laser in three sees a wall all around, if there is one.
std::vector<EndlessColumn> endlessColumns(Random& random, double turns, double room) {
  constexpr double kTwoPi = 6.283185307179586;
  const std::size_t lasers = 1 + random.below(4);
  const std::size_t steps = 20 + random.below(100);
  const double start = random.chance(0.5) ? 0.0 : random.between(-3.0, 1000.0);
  std::vector<EndlessColumn> columns;
  for (double position = start; position < start + turns;
       position += random.between(0.5, 1.5) / static_cast<double>(steps)) {
    Cloud column;
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const double azimuth = kTwoPi * position + random.between(-0.01, 0.01);
      const double range = std::sin(3 * azimuth + 0.2 * position) > 0.3 ? random.between(3.0, 3.1) : room;
      if (laser % 3 != 0 && range == room)
        column.push_back(random.chance(0.5) ? PointXYZ(0, 0, 0) : PointXYZ(kNan, kNan, kNan));
      else
        column.push_back(PointXYZ(static_cast<float>(range * std::cos(azimuth)),
                                  static_cast<float>(range * std::sin(azimuth)), 0.2F * static_cast<float>(laser)));
    }
    if (random.chance(0.1)) column.clear();
    columns.emplace_back(position, column);
    if (random.chance(0.005)) position += random.between(0.1, 3.0);
  }
  return columns;
}

/// A delivery: its cells and its properties.
struct Delivery {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> cells;  ///< column and row
  double first_position, last_position;
  bool is_cut, is_continued;

  bool operator==(const Delivery& other) const {
    return cells == other.cells && first_position == other.first_position && last_position == other.last_position &&
           is_cut == other.is_cut && is_continued == other.is_continued;
  }
};

/// The engine's deliveries, whose cells are named here by column and row, independent of the ring.
std::vector<Delivery> engineDeliveries(const std::vector<EndlessColumn>& columns, lisco::EndlessParameters parameters) {
  std::vector<Delivery> deliveries;
  lisco::EndlessClusterer clusterer;
  clusterer.begin(parameters, [&](const lisco::EndlessCluster& cluster) {
    deliveries.push_back({{}, cluster.firstPosition(), cluster.lastPosition(), cluster.isCut(), cluster.isContinued()});
    cluster.forEachRun([&](const std::uint32_t* names, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) deliveries.back().cells.emplace_back(names[i] >> 8, names[i] & 255U);
    });
  });
  for (std::uint32_t number = 0; number < columns.size(); ++number) {
    std::vector<lisco::Return> cells;
    for (const PointXYZ& p : columns[number].second)
      cells.push_back({p.x, p.y, p.z, number << 8 | static_cast<std::uint32_t>(cells.size())});
    clusterer.addColumn(cells.data(), cells.size(), columns[number].first);
  }
  clusterer.finish();
  return deliveries;
}

TEST(PclEndless, DeliversTheEnginesClustersWithTheirPoints) {
  Endless endless;
  std::size_t cut = 0, across_the_seam = 0;
  for (std::uint64_t seed = 1; seed <= timesEffort(1000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double room = random.chance(0.3) ? 3.3 : 20.0;
    const auto columns = endlessColumns(random, random.between(0.2, 6.0), room);
    lisco::EndlessParameters parameters;
    parameters.tolerance = static_cast<float>(random.magnitude(0.05, 1.0));
    parameters.min_size = 1 + random.below(3);
    parameters.stagger = random.between(0.02, 0.3);
    parameters.block_columns = random.oneOf(std::vector<std::size_t>{1, 16, 64});
    const std::vector<Delivery> expected = engineDeliveries(columns, parameters);

    set(endless, {static_cast<double>(parameters.tolerance), static_cast<pcl::uindex_t>(parameters.min_size)});
    endless.setStagger(parameters.stagger);
    endless.setBlockColumns(parameters.block_columns);
    endless.setHeader(anyHeader());
    std::vector<Delivery> deliveries;
    endless.setClusterCallback([&](const Endless::Cluster& cluster) {
      deliveries.push_back({{}, cluster.first_position, cluster.last_position, cluster.is_cut, cluster.is_continued});
      EXPECT_EQ(cluster.cloud.header, anyHeader());
      EXPECT_EQ(cluster.cloud.width, cluster.cloud.size());
      EXPECT_EQ(cluster.cloud.height, 1U);
      ASSERT_EQ(cluster.cells.size(), cluster.cloud.size());
      for (std::size_t i = 0; i < cluster.cells.size(); ++i) {
        const auto& cell = cluster.cells[i];
        ASSERT_LT(cell.column, columns.size());
        ASSERT_LT(cell.row, columns[cell.column].second.size());
        ASSERT_TRUE(areSamePoint(columns[cell.column].second[cell.row], cluster.cloud[i]));
        deliveries.back().cells.emplace_back(cell.column, cell.row);
      }
    });
    ASSERT_TRUE(endless.beginStream());
    for (const auto& [position, column] : columns) {
      ASSERT_TRUE(random.chance(0.5) ? endless.addColumn(column, position)
                                     : endless.addColumn(column.points.data(), column.size(), position));
      ASSERT_LE(endless.getNumberOfColumnsHeld(), 120U * 4U) << "of a turn and a half";
      if (HasFatalFailure()) return;
    }
    if (random.chance(0.8))
      endless.finish();
    else
      deliveries.insert(deliveries.end(), expected.begin() + static_cast<std::ptrdiff_t>(deliveries.size()),
                        expected.end());  // the next stream begins without finish ()
    ASSERT_TRUE(expected == deliveries);
    for (const Delivery& delivery : deliveries) {
      cut += delivery.is_cut ? 1 : 0;
      across_the_seam += std::floor(delivery.first_position) < std::floor(delivery.last_position) ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 20U);
  EXPECT_GT(across_the_seam, 200U);
}

TEST(PclEndless, CountsPositionsByTheColumnsOfATurn) {
  Endless endless;
  set(endless, {0.5, 3});
  endless.setClockwise(true);
  endless.setColumnsPerTurn(180);
  std::vector<std::pair<std::size_t, double>> deliveries;
  endless.setClusterCallback(
      [&](const Endless::Cluster& cluster) { deliveries.emplace_back(cluster.cloud.size(), cluster.first_position); });
  ASSERT_TRUE(endless.beginStream());
  const auto columns = columnsOfBoxes(1, 180, 12);
  for (int stream = 0; stream < 2; ++stream) {  // after finish (), positions begin at 0 again
    for (int turn = 0; turn < 2; ++turn)
      for (const auto& column : columns) ASSERT_TRUE(endless.addColumn(column));
    endless.update();
    endless.finish();
  }
  EXPECT_EQ(endless.getNumberOfOutliers(), 0U);
  EXPECT_GT(endless.getNumberOfReturns(), 4000U);
  ASSERT_EQ(deliveries.size() % 2, 0U);
  ASSERT_GT(deliveries.size(), 8U);
  for (std::size_t i = 0; i < deliveries.size() / 2; ++i)
    EXPECT_EQ(deliveries[i], deliveries[i + deliveries.size() / 2]);
  EXPECT_EQ(endless.getNumberOfColumnsHeld(), 0U);
}

TEST(PclEndless, KeepsItsParameters) {
  Endless endless;
  EXPECT_FALSE(endless.getClockwise());
  EXPECT_EQ(endless.getStartAzimuth(), 0.0);
  EXPECT_EQ(endless.getStagger(), lisco::EndlessParameters::kMaxStagger);
  EXPECT_EQ(endless.getColumnsPerTurn(), 0.0);
  EXPECT_EQ(endless.getBlockColumns(), 16U);
  EXPECT_EQ(endless.getSensorOrigin(), Eigen::Vector4f::Zero());
  endless.setClockwise(true);
  endless.setStartAzimuth(1);
  endless.setStagger(0.1);
  endless.setColumnsPerTurn(1800);
  endless.setBlockColumns(1);
  endless.setSensorOrigin({1, 2, 3, 0});
  EXPECT_TRUE(endless.getClockwise());
  EXPECT_EQ(endless.getStartAzimuth(), 1.0);
  EXPECT_EQ(endless.getStagger(), 0.1);
  EXPECT_EQ(endless.getColumnsPerTurn(), 1800.0);
  EXPECT_EQ(endless.getBlockColumns(), 1U);
  EXPECT_EQ(endless.getSensorOrigin(), Eigen::Vector4f(1, 2, 3, 0));
}

TEST(PclEndless, RejectsWrongCalls) {
  const std::vector<PointXYZ, Eigen::aligned_allocator<PointXYZ>> points(3, PointXYZ(1, 0, 0));
  const std::string method = "[pcl::LiscoEndlessExtraction::addColumn]";
  Endless endless;
  endless.setClusterTolerance(0.5);
  endless.update();
  endless.finish();
  std::string error = errorOf([&] { EXPECT_FALSE(endless.addColumn(points.data(), 3, 0.0)); });
  EXPECT_NE(error.find(method + " A column before"), std::string::npos) << error;
  for (const double stagger : {-0.1, 0.4, std::numeric_limits<double>::quiet_NaN()}) {
    endless.setStagger(stagger);
    error = errorOf([&] { EXPECT_FALSE(endless.beginStream()); });
    EXPECT_NE(error.find("[pcl::LiscoEndlessExtraction::beginStream]"), std::string::npos) << error;
  }
  endless.setStagger(0.1);
  endless.setNumberOfLasers(2);
  std::size_t delivered = 0;
  endless.setClusterCallback([&](const Endless::Cluster& cluster) { delivered += cluster.cloud.size(); });
  ASSERT_TRUE(endless.beginStream());
  error = errorOf([&] { EXPECT_FALSE(endless.addColumn(points.data(), 2)); });
  EXPECT_NE(error.find(method + " A column without a position"), std::string::npos) << error;
  error = errorOf([&] { EXPECT_FALSE(endless.addColumn(points.data(), 3, 0.0)); });
  EXPECT_NE(error.find("2 lasers"), std::string::npos) << error;
  for (const double position :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 2e12}) {
    error = errorOf([&] { EXPECT_FALSE(endless.addColumn(points.data(), 2, position)); });
    EXPECT_NE(error.find(method), std::string::npos) << error;
  }
  EXPECT_TRUE(endless.addColumn(points.data(), 2, 5.0));
  EXPECT_TRUE(endless.addColumn(points.data(), 1, 5.0));
  error = errorOf([&] { EXPECT_FALSE(endless.addColumn(points.data(), 2, 4.9)); });
  EXPECT_NE(error.find("4.9"), std::string::npos) << error;
  endless.finish();
  EXPECT_EQ(delivered, 3U);
  EXPECT_TRUE(endless.addColumn(points.data(), 2, 0.0)) << "a new stream";
}

// --- Point types ----------------------------------------------------------------------------------------------------

template <typename PointT>
class PclStreamPointTypes : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointNormal>;
TYPED_TEST_SUITE(PclStreamPointTypes, PointTypes);

TYPED_TEST(PclStreamPointTypes, EqualPcl) {
  Random random(1);
  const auto columns = columnsOf(*cloudOf<TypeParam>(boxesAround(random, 120, 8)));
  pcl::LiscoStreamExtraction<TypeParam> stream;
  expectRotationSameAsPcl(stream, random, columns, {0.5, 3});
  expectRotationSameAsPcl(stream, random, trimmed(random, columns), {0.5, 3});
  pcl::LiscoWindowExtraction<TypeParam> windows;
  expectWindowsSameAsPcl(windows, random, columns, {0.5, 3}, 60, 20);
}

// Delivered points are whole, not only their coordinates.
TEST(PclStream, PointsKeepTheirFields) {
  pcl::PointCloud<pcl::PointXYZI> column(2, 1);
  for (std::size_t i = 0; i < 2; ++i) {
    column[i].x = 5;
    column[i].y = 0;
    column[i].z = 0.1F * static_cast<float>(i);
    column[i].intensity = 40 + static_cast<float>(i);
  }
  pcl::LiscoEndlessExtraction<pcl::PointXYZI> endless;
  endless.setClusterTolerance(0.5);
  std::vector<float> intensities;
  endless.setClusterCallback([&](const pcl::LiscoEndlessCluster<pcl::PointXYZI>& cluster) {
    for (const auto& point : cluster.cloud) intensities.push_back(point.intensity);
  });
  endless.beginStream();
  endless.addColumn(column, 0.0);
  endless.finish();
  EXPECT_EQ(intensities, (std::vector<float>{40, 41}));

  pcl::LiscoStreamExtraction<pcl::PointXYZI> stream;
  stream.beginRotation();
  stream.addColumn(column);
  pcl::PointCloud<pcl::PointXYZI> cloud;
  Clusters clusters;
  stream.endRotation(clusters, cloud);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud[1].intensity, 41.0F);
}

}  // namespace
}  // namespace lisco_test
