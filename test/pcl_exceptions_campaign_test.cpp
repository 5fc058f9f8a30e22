// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Exceptions during the PCL face's calls: memory is refused, callbacks throw. Nothing leaks, later results are right,
// and a new rotation or stream is the oracle's. A program for itself: refused_allocations.cpp replaces operator new.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <pcl/console/print.h>
#include <pcl/filters/lisco_ground_filter.h>

#include "column_streams.h"
#include "engine.h"
#include "interruptions.h"
#include "pair_scans.h"
#include "pcl_oracle.h"
#include "pcl_stream.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Cloud = pcl::PointCloud<PointXYZ>;

class PclExceptionsCampaign : public testing::Test {
 protected:
  // PCL reports each refused allocation.
  void SetUp() override { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  void TearDown() override { pcl::console::setVerbosityLevel(pcl::console::L_INFO); }
};

std::string differenceOf(const Clusters& expected, const Clusters& found) {
  if (expected.size() != found.size())
    return std::to_string(expected.size()) + " clusters expected, " + std::to_string(found.size()) + " found";
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (expected[i].indices != found[i].indices || !(expected[i].header == found[i].header))
      return "cluster " + std::to_string(i) + " is another one";
  return {};
}

// --- A whole cloud --------------------------------------------------------------------------------------------------

struct Extracted {
  explicit Extracted(Random& random) {
    const bool by_threads = random.chance(0.4);
    PairScan pairs = randomPairs(random);
    constexpr std::size_t kMinCellsForThreads = 8192;  // cells
    while (by_threads == (pairs.scan.columns * pairs.scan.lasers < kMinCellsForThreads)) pairs = randomPairs(random);
    request.tolerance = static_cast<double>(pairs.tolerance);
    request.min_size = static_cast<pcl::uindex_t>(1 + random.below(2));
    threads = by_threads ? 3 : 1;
    cloud = cloudOf(pairs.scan);
    with_labels = random.chance(0.5);
    if (random.chance(0.5)) {
      indices = shuffledIndices(random, cloud->size());
      const std::array<std::size_t, 3> shares{1, 3, 20};
      indices->resize(cloud->size() / random.oneOf(shares));
      if (random.chance(0.5)) std::sort(indices->begin(), indices->end());
    }
    // The clusters come in the order in which their first points appear in the indices.
    Cloud selected = *cloud;
    std::vector<std::size_t> place(cloud->size(), indices ? indices->size() : 0);
    if (indices) {
      for (std::size_t i = indices->size(); i-- > 0;) place[static_cast<std::size_t>((*indices)[i])] = i;
      for (std::size_t point = 0; point < selected.size(); ++point)
        if (place[point] == indices->size()) selected[point].x = selected[point].y = selected[point].z = 0;
    } else {
      for (std::size_t point = 0; point < place.size(); ++point) place[point] = point;
    }
    right = trueClustersOf(selected, request);
    const auto firstPlace = [&place](const pcl::PointIndices& cluster) {
      std::size_t first = place.size();
      for (const pcl::index_t point : cluster.indices) first = std::min(first, place[static_cast<std::size_t>(point)]);
      return first;
    };
    std::sort(right.begin(), right.end(), [&](const auto& a, const auto& b) { return firstPlace(a) < firstPlace(b); });
    std::sort(right.rbegin(), right.rend(), pcl::comparePointClusters);
  }

  Cloud::Ptr cloud;
  pcl::IndicesPtr indices;
  Request request;
  unsigned int threads = 1;
  bool with_labels = false;
  Clusters right;
};

class ExtractSession {
 public:
  explicit ExtractSession(const Extracted& extracted) : extracted_(extracted) {
    extraction_->setInputCloud(extracted.cloud);
    extraction_->setIndices(extracted.indices);
    extraction_->setNumberOfThreads(extracted.threads);
    set(*extraction_, extracted.request);
  }

  void call(std::size_t) {
    passed_ = false;
    if (extracted_.with_labels)
      extraction_->extract(clusters_, labels_);
    else
      extraction_->extract(clusters_);
    passed_ = true;
  }

  void checkInterrupted(std::size_t) {}

  std::string redo() {
    // PCL's initCompute () catches the refusal of its own indices and reports it: then there is nothing to cluster. If
    // they were refused before it, it asks for them again.
    if (passed_ && !clusters_.empty()) {
      const std::string wrong = differenceOf(extracted_.right, clusters_);
      if (!wrong.empty()) return "extract () went on: " + wrong;
    }
    clusters_.clear();
    call(0);
    std::string wrong = differenceOf(extracted_.right, clusters_);
    if (!wrong.empty() || !extracted_.with_labels) return wrong;
    std::vector<std::uint32_t> expected(extracted_.cloud->size(), 0);
    for (std::size_t i = 0; i < clusters_.size(); ++i)
      for (const pcl::index_t point : clusters_[i].indices)
        expected[static_cast<std::size_t>(point)] = static_cast<std::uint32_t>(i + 1);
    for (std::size_t point = 0; point < expected.size(); ++point)
      if (labels_[point].label != expected[point]) return "the label of point " + std::to_string(point);
    return wrong;
  }

 private:
  const Extracted& extracted_;
  std::unique_ptr<pcl::LiscoClusterExtraction<PointXYZ>> extraction_ =
      std::make_unique<pcl::LiscoClusterExtraction<PointXYZ>>();
  Clusters clusters_;
  pcl::PointCloud<pcl::Label> labels_;
  bool passed_ = false;
};

TEST_F(PclExceptionsCampaign, CloudsSurviveRefusedMemory) {
  std::size_t refused = 0;
  for (std::uint64_t seed = 1; seed <= timesEffort(6); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Extracted extracted(random);
    refused += refuseEachAllocation([&] { return ExtractSession(extracted); }, 0);
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, timesEffort(6 * 20));
}

// --- The ground of a whole cloud ---------------------------------------------------------------------------------

/// A sensor 1.8 m above a plane, within a wall.
Cloud::Ptr streetScan(bool is_organized) {
  constexpr std::uint32_t kLasers = 16, kColumns = 200;
  auto cloud = std::make_shared<Cloud>(kColumns, kLasers);
  for (std::uint32_t laser = 0; laser < kLasers; ++laser)
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const double azimuth = -2.0 * M_PI * column / kColumns, slope = 0.1 - 0.03 * laser;
      const double rho = std::min(20.0, slope < 0.0 ? -1.8 / slope : 20.0);
      cloud->at(column, laser) = PointXYZ(static_cast<float>(rho * std::cos(azimuth)),
                                          static_cast<float>(rho * std::sin(azimuth)), static_cast<float>(rho * slope));
    }
  if (is_organized) return cloud;
  cloud->width *= cloud->height;
  cloud->height = 1;
  return cloud;
}

class GroundSession {
 public:
  GroundSession(const Cloud::Ptr& cloud, const pcl::Indices& right) : right_(right) { filter_->setInputCloud(cloud); }

  void call(std::size_t) {
    objects_.assign(1, 7);
    filter_->filter(objects_);
  }
  void checkInterrupted(std::size_t) {}
  std::string redo() {
    call(0);
    return objects_ == right_ ? "" : std::to_string(objects_.size()) + " points remain";
  }

 private:
  const pcl::Indices& right_;
  std::unique_ptr<pcl::LiscoGroundFilter<PointXYZ>> filter_ = std::make_unique<pcl::LiscoGroundFilter<PointXYZ>>();
  pcl::Indices objects_;
};

TEST_F(PclExceptionsCampaign, GroundFiltersSurviveRefusedMemory) {
  for (const bool is_organized : {true, false}) {
    const Cloud::Ptr cloud = streetScan(is_organized);
    pcl::Indices right;
    pcl::LiscoGroundFilter<PointXYZ> filter;
    filter.setInputCloud(cloud);
    filter.filter(right);
    EXPECT_GT(right.size(), cloud->size() / 8);
    EXPECT_LT(right.size(), cloud->size() / 2);
    EXPECT_GT(refuseEachAllocation([&] { return GroundSession(cloud, right); }, 0), 20U);
  }
}

TEST_F(PclExceptionsCampaign, GroundFiltersReportThatThereIsNoMemory) {
  const Cloud::Ptr cloud = streetScan(true);
  pcl::LiscoGroundFilter<PointXYZ> filter;
  filter.setInputCloud(cloud);
  pcl::Indices objects;
  objects.reserve(cloud->size());
  const RefusedAllocation refusal(20);
  EXPECT_THROW(filter.filter(objects), std::bad_alloc);
}

// --- Streams --------------------------------------------------------------------------------------------------------

/// A short stream and how it is clustered.
struct Streamed {
  explicit Streamed(Random& random) {
    stream = randomColumnStream(random);
    const std::size_t most_columns = 20 + random.below(100);
    stream = partOf(stream, 0, std::min(stream.columns.size(), most_columns));
    columns = columnsOf(stream);
    request = requestFor(random, stream);
    hop = 1 + random.below(12);
    window = hop * (1 + random.below(5));
    truth = wanted(endlessTruth(stream).deliveries, request);
  }

  Clusters trueClustersBetween(std::size_t first, std::size_t end) const {
    Clusters clusters;
    appendTrueClusters(*organized(columns, first, end, anyHeader()), request, clusters);
    return clusters;
  }

  ColumnStream stream;
  Columns<PointXYZ> columns;
  Request request;
  std::size_t hop = 1, window = 1;
  std::vector<Delivery> truth;  ///< of the endless stream
};

/// Calls: begin twice, each column, the end; the second rotation uses the hints of the first one.
class RotationSession {
 public:
  explicit RotationSession(const Streamed& streamed) : streamed_(streamed) {
    set(*stream_, streamed.request);
    stream_->setHeader(anyHeader());
    stream_->setBlockColumns(streamed.hop);
  }

  static std::size_t calls(const Streamed& streamed) { return 2 * (streamed.columns.size() + 3); }

  void call(std::size_t number) {
    const std::size_t columns = streamed_.columns.size();
    number %= columns + 3;
    if (number == 0)
      stream_->beginRotation();
    else if (number <= columns)
      stream_->addColumn(streamed_.columns[number - 1]);
    else if (number == columns + 1)
      stream_->getSubclusters(queried_);
    else
      stream_->endRotation(clusters_);
  }

  /// The rotation has ended, unless a query failed.
  void checkInterrupted(std::size_t number) {
    const std::size_t columns = streamed_.columns.size();
    number %= columns + 3;
    Cloud cloud;
    std::vector<pcl::uindex_t> sizes;
    stream_->getSubclusterSizes(sizes);
    EXPECT_LE(stream_->getSubcluster(0, 0), static_cast<pcl::index_t>(sizes.size()));
    stream_->getCloud(cloud);
    EXPECT_EQ(cloud.width, stream_->getNumberOfColumns());
    clusters_.clear();
    stream_->getSubclusters(clusters_);
    // A call that failed before it reached the engine leaves all columns.
    EXPECT_TRUE(clusters_.empty() ||
                differenceOf(streamed_.trueClustersBetween(0, stream_->getNumberOfColumns()), clusters_).empty());
    const bool is_over = !stream_->addColumn(nullptr, 0);
    EXPECT_TRUE(is_over || number > columns);
    const std::size_t queried = clusters_.size();
    EXPECT_EQ(stream_->endRotation(clusters_), !is_over);
    EXPECT_EQ(clusters_.size(), is_over ? 0 : 2 * queried) << "not appended";
    EXPECT_TRUE(is_over || queried == streamed_.trueClustersBetween(0, columns).size());
  }

  std::string redo() {
    std::string wrong;
    const Clusters right = streamed_.trueClustersBetween(0, streamed_.columns.size());
    for (std::size_t number = 0; number < calls(streamed_) && wrong.empty(); ++number) {
      if (number % (streamed_.columns.size() + 3) == 0) clusters_.clear();
      call(number);
      if ((number + 1) % (streamed_.columns.size() + 3) == 0) wrong = differenceOf(right, clusters_);
    }
    return wrong;
  }

 private:
  const Streamed& streamed_;
  std::unique_ptr<pcl::LiscoStreamExtraction<PointXYZ>> stream_ =
      std::make_unique<pcl::LiscoStreamExtraction<PointXYZ>>();
  Clusters queried_, clusters_;
};

/// Calls: begin, then a column and a query each.
class WindowSession {
 public:
  explicit WindowSession(const Streamed& streamed) : streamed_(streamed) {
    set(*windows_, streamed.request);
    windows_->setHeader(anyHeader());
    windows_->setWindowSize(streamed.window);
    windows_->setHop(streamed.hop);
  }

  static std::size_t calls(const Streamed& streamed) { return 1 + 2 * streamed.columns.size(); }

  void call(std::size_t number) {
    if (number == 0) {
      windows_->beginStream();
      end_ = 0;
    } else if (number % 2 != 0) {
      if (windows_->addColumn(streamed_.columns[number / 2])) end_ = number / 2 + 1;
    } else if (end_ > 0) {
      clusters_.clear();
      windows_->extract(clusters_);
    }
  }

  /// The stream has ended, unless a query failed: then it continues.
  void checkInterrupted(std::size_t number) {
    Cloud cloud;
    windows_->getWindow(cloud);
    EXPECT_EQ(cloud.width, windows_->getNumberOfColumns());
    clusters_.resize(2);
    if (number > 0 && number % 2 == 0) {
      EXPECT_EQ(goOn(number), "");
      return;
    }
    EXPECT_FALSE(windows_->extract(clusters_));
    EXPECT_TRUE(clusters_.empty());
    for (const Cloud& column : streamed_.columns) EXPECT_FALSE(windows_->addColumn(column));
    EXPECT_FALSE(windows_->extract(clusters_));
  }

  std::string redo() { return goOn(0); }

 private:
  /// Makes this call and all after it.
  std::string goOn(std::size_t number) {
    std::string wrong;
    for (; number < calls(streamed_) && wrong.empty(); ++number) {
      call(number);
      if (number > 0 && number % 2 == 0 && end_ > 0) wrong = differenceOf(right(), clusters_);
    }
    return wrong;
  }

  Clusters right() const { return streamed_.trueClustersBetween(end_ - std::min(end_, streamed_.window), end_); }

  const Streamed& streamed_;
  std::unique_ptr<pcl::LiscoWindowExtraction<PointXYZ>> windows_ =
      std::make_unique<pcl::LiscoWindowExtraction<PointXYZ>>();
  Clusters clusters_;
  std::size_t end_ = 0;  ///< of the last window
};

/// Calls: begin, then each column and perhaps an update, finish.
class EndlessSession {
 public:
  explicit EndlessSession(const Streamed& streamed, Fuse* fuse = nullptr) : streamed_(streamed), fuse_(fuse) {
    const lisco::EndlessParameters& parameters = streamed.stream.parameters;
    set(*endless_, streamed.request);
    endless_->setHeader(anyHeader());
    endless_->setSensorOrigin({parameters.origin[0], parameters.origin[1], parameters.origin[2], 0});
    endless_->setClockwise(parameters.clockwise);
    endless_->setStartAzimuth(parameters.start_azimuth);
    endless_->setStagger(parameters.stagger);
    endless_->setBlockColumns(parameters.block_columns);
    state_->fuse = fuse_;
    endless_->setClusterCallback([state = state_.get()](const EndlessReceiver::Extraction::Cluster& cluster) {
      if (state->fuse != nullptr) state->fuse->burn();
      state->receiver.receive(cluster);
    });
    state_->receiver.expect(streamed.stream, anyHeader());
  }

  static std::size_t calls(const Streamed& streamed) { return 2 + 2 * streamed.columns.size(); }

  void call(std::size_t number) {
    if (number == 0) {
      endless_->beginStream();
      state_->receiver.expect(streamed_.stream, anyHeader());
      return;
    }
    const std::size_t column = (number - 1) / 2;
    state_->receiver.column = column;
    if (column == streamed_.columns.size()) return endless_->finish();
    if (number % 2 != 0)
      endless_->addColumn(streamed_.columns[column], streamed_.stream.columns[column].position);
    else if (column % streamed_.hop == 0)
      endless_->update();
  }

  void checkInterrupted(std::size_t) {
    state_->fuse = nullptr;
    for (const Delivery& delivery : state_->receiver.deliveries()) {
      const auto right = std::lower_bound(streamed_.truth.begin(), streamed_.truth.end(), delivery);
      EXPECT_TRUE(right != streamed_.truth.end() && right->members == delivery.members) << delivery;
    }
    // The stream is over.
    const std::size_t before = state_->receiver.deliveries().size();
    EXPECT_FALSE(endless_->addColumn(nullptr, 0, kLargestPosition));
    endless_->update();
    endless_->finish();
    EXPECT_FALSE(endless_->addColumn(nullptr, 0, kLargestPosition));
    EXPECT_EQ(state_->receiver.deliveries().size(), before);
  }

  std::string redo() {
    state_->fuse = nullptr;
    for (std::size_t number = 0; number < calls(streamed_); ++number) call(number);
    std::vector<std::size_t> updates;
    for (std::size_t column = 0; column < streamed_.columns.size(); column += streamed_.hop) updates.push_back(column);
    return wrongDeliveries(streamed_.stream, streamed_.truth, state_->receiver.deliveries(), updates, true);
  }

 private:
  struct State {
    Fuse* fuse = nullptr;
    EndlessReceiver receiver;
  };

  const Streamed& streamed_;
  Fuse* fuse_;
  std::unique_ptr<State> state_ = std::make_unique<State>();
  std::unique_ptr<EndlessReceiver::Extraction> endless_ = std::make_unique<EndlessReceiver::Extraction>();
};

template <typename Session>
void refuseStreams(std::uint64_t first_seed, std::uint64_t seeds) {
  std::size_t refused = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Streamed streamed(random);
    const std::size_t last = Session::calls(streamed) - 1;
    for (std::size_t number = 0; number <= last;) {
      refused += refuseEachAllocation([&] { return Session(streamed); }, number);
      if (testing::Test::HasFailure()) return;
      // The first and the last call are never left out: they allocate most.
      const std::size_t step = 1 + random.below(12);
      number = number < last ? std::min(last, number + step) : last + 1;
    }
  }
  EXPECT_GT(refused, 10 * seeds);
}

TEST_F(PclExceptionsCampaign, RotationsSurviveRefusedMemory) {
  refuseStreams<RotationSession>(1000, timesEffort(20));
}

TEST_F(PclExceptionsCampaign, WindowsSurviveRefusedMemory) {
  refuseStreams<WindowSession>(2000, timesEffort(20));
}

/// Refuses each allocation of an assignment in turn: the object assigned to goes on, or is another's copy.
template <typename Stream, typename Begin, typename End>
void refuseAssignments(Begin&& begin, End&& end) {
  const Cloud::Ptr cloud = streetScan(true);
  const auto addColumns = [&](Stream& stream, std::uint32_t count) {
    Cloud column;
    for (std::uint32_t i = 0; i < count; ++i) {
      column.clear();
      for (std::uint32_t row = 0; row < cloud->height; ++row) column.push_back(cloud->at(i, row));
      stream.addColumn(column);
    }
  };
  const auto begun = [&](std::uint32_t columns) {
    auto stream = std::make_unique<Stream>();
    stream->setClusterTolerance(0.5);
    begin(*stream);
    addColumns(*stream, columns);
    return stream;
  };
  const Clusters right = end(*begun(24));
  std::size_t refused = 0;
  for (bool happened = true; happened;) {
    const auto to = begun(24), from = begun(150);
    try {
      const RefusedAllocation refusal(++refused);
      *to = *from;
      happened = refusal.happened();
    } catch (const std::bad_alloc&) {
      EXPECT_EQ(differenceOf(right, end(*to)), "") << "allocation " << refused;
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(refused, 5U);
}

TEST_F(PclExceptionsCampaign, StreamsSurviveRefusedAssignments) {
  refuseAssignments<pcl::LiscoStreamExtraction<PointXYZ>>([](auto& stream) { stream.beginRotation(); },
                                                          [](auto& stream) {
                                                            Clusters clusters;
                                                            stream.endRotation(clusters);
                                                            return clusters;
                                                          });
  refuseAssignments<pcl::LiscoWindowExtraction<PointXYZ>>(
      [](auto& stream) {
        stream.setWindowSize(24);
        stream.setHop(6);
        stream.beginStream();
      },
      [](auto& stream) {
        Clusters clusters;
        stream.extract(clusters);
        return clusters;
      });
}

TEST_F(PclExceptionsCampaign, EndlessStreamsSurviveRefusedMemory) {
  refuseStreams<EndlessSession>(3000, timesEffort(20));
}

TEST_F(PclExceptionsCampaign, EndlessStreamsSurviveAThrowingCallback) {
  interruptEndlessStreams<EndlessSession, Streamed>(4000, timesEffort(300));
}

}  // namespace
}  // namespace lisco_test
