// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Exceptions during every kind of call: memory is refused, callbacks throw. Nothing leaks, and after begin () the
// clusters are the oracle's. A program for itself: refused_allocations.cpp replaces operator new.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "column_streams.h"
#include "core/parallel.h"
#include "engine.h"
#include "ground_scans.h"
#include "interruptions.h"
#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/ground_filter.h"
#include "lisco/window_clusterer.h"
#include "oracle.h"
#include "pair_scans.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

// --- Rotations ------------------------------------------------------------------------------------------------------

/// A scan and how it is clustered; shared by the sessions of a seed.
struct Rotation {
  explicit Rotation(Random& random) {
    constexpr std::size_t kMinCellsForThreads = 8192;  // cells
    const bool by_threads = random.chance(0.5);
    PairScan pairs = randomPairs(random);
    while (by_threads && pairs.scan.columns * pairs.scan.lasers < kMinCellsForThreads) pairs = randomPairs(random);
    scan = std::move(pairs.scan);
    parameters.tolerance = pairs.tolerance;
    if (random.chance(0.7)) parameters.sensor = pairs.hints;
    parameters.block_columns = random.oneOf(std::array<std::size_t, 4>{64, 64, 16, 1});
    parameters.expected_returns = 10;
    parameters.threads = by_threads ? 2 + random.below(3) : 1;
    right = trueClusters(scan.points(), parameters.tolerance);
    // Calls: begin, some of addColumns (), one of addColumn (), update, the rest at once, update, two queries.
    first_columns = by_threads ? scan.columns * 9 / 10 : random.below(scan.columns);
    queries_by_cell = random.chance(0.5);
  }

  Scan scan{0, 0};
  lisco::Parameters parameters;
  Clustering right;
  std::size_t first_columns = 0;
  bool queries_by_cell = false;
};

class RotationSession {
 public:
  enum Call : std::size_t {
    kBegin,
    kAddColumns,
    kAddColumn,
    kUpdate,
    kAddRest,
    kUpdateAgain,
    kQuery,
    kQueryAgain,
    kCalls
  };

  explicit RotationSession(const Rotation& rotation, Fuse* fuse = nullptr)
      : rotation_(rotation), fuse_(fuse), column_(rotation.scan.column(rotation.first_columns)) {}

  void call(std::size_t number) {
    const std::size_t columns = rotation_.scan.columns;
    switch (number) {
      case kBegin:
        return clusterer_->begin(rotation_.parameters);
      case kAddColumns:
        return add(0, rotation_.first_columns);
      case kAddColumn:
        return clusterer_->addColumn(column_.data(), column_.size());
      case kUpdate:
      case kUpdateAgain:
        return clusterer_->update();
      case kAddRest:
        return add(rotation_.first_columns + 1, columns);
      default:
        if (rotation_.queries_by_cell == (number == kQuery))
          clusterer_->subclusterAt(rotation_.scan.lasers - 1, columns - 1);
        else
          clusterer_->forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t) { burn(); });
    }
  }

  /// Only begin () may be called; the others report it, or do nothing.
  void checkInterrupted(std::size_t number) {
    fuse_ = nullptr;
    if (number == kQuery || number == kQueryAgain) {  // nothing was changed
      EXPECT_EQ(difference(rotation_.right, clustersOf(*clusterer_)), "");
      return;
    }
    EXPECT_THROW(clusterer_->addColumn(nullptr, 0), std::logic_error);
    EXPECT_THROW(clusterer_->addColumns(2, 1, [](std::size_t, std::size_t) { return lisco::kNoReturn; }),
                 std::logic_error);
    EXPECT_NO_THROW(clusterer_->update());
    clusterer_->forEachRun([](const std::uint32_t*, std::size_t, std::uint32_t) { ADD_FAILURE() << "visited"; });
    for (std::size_t laser = 0; laser <= rotation_.scan.lasers; ++laser)
      for (std::size_t column = 0; column <= rotation_.scan.columns; column += 63)
        EXPECT_EQ(clusterer_->subclusterAt(laser, column), lisco::ColumnClusterer::kNone);
    EXPECT_LE(clusterer_->returnCount(), rotation_.scan.cells.size());
  }

  std::string redo() {
    fuse_ = nullptr;
    for (std::size_t number = 0; number < kCalls; ++number) call(number);
    return difference(rotation_.right, clustersOf(*clusterer_));
  }

 private:
  void burn() {
    if (fuse_ != nullptr) fuse_->burn();
  }

  void add(std::size_t first, std::size_t end) {
    clusterer_->addColumns(end - std::min(first, end), rotation_.scan.lasers,
                           [&](std::size_t laser, std::size_t column) {
                             burn();
                             return rotation_.scan.at(laser, first + column);
                           });
  }

  const Rotation& rotation_;
  Fuse* fuse_;
  std::unique_ptr<lisco::ColumnClusterer> clusterer_ = std::make_unique<lisco::ColumnClusterer>();
  std::vector<lisco::Return> column_;  ///< added by itself
};

TEST(ExceptionsCampaign, RotationsSurviveRefusedMemory) {
  std::array<std::size_t, RotationSession::kCalls> refused{};
  for (std::uint64_t seed = 1; seed <= timesEffort(10); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Rotation rotation(random);
    SCOPED_TRACE(std::to_string(rotation.parameters.threads) + " threads");
    for (std::size_t number = 0; number < refused.size(); ++number)
      refused[number] += refuseEachAllocation([&] { return RotationSession(rotation); }, number);
    if (HasFailure()) return;
  }
  for (const std::size_t number : {RotationSession::kBegin, RotationSession::kAddColumns, RotationSession::kUpdate,
                                   RotationSession::kAddRest, RotationSession::kUpdateAgain, RotationSession::kQuery})
    EXPECT_GT(refused[number], 0U) << "call " << number << " was refused nothing";
}

TEST(ExceptionsCampaign, RotationsSurviveThrowingCallbacks) {
  std::array<std::size_t, RotationSession::kCalls> interrupted{};
  for (std::uint64_t seed = 1000; seed < 1000 + timesEffort(50); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Rotation rotation(random);
    const std::size_t live = liveAllocations();
    for (const std::size_t number : {RotationSession::kAddColumns, RotationSession::kAddRest, RotationSession::kQuery,
                                     RotationSession::kQueryAgain}) {
      Fuse fuse(0);
      RotationSession session(rotation, &fuse);
      for (std::size_t before = 0; before < number; ++before) session.call(before);
      fuse.replace(1 + random.below(random.chance(0.3) ? 10 : rotation.scan.cells.size()));
      bool thrown = false;
      interruptedCall(session, number, 0, thrown);
      if (thrown) session.checkInterrupted(number);
      ASSERT_EQ(session.redo(), "") << "call " << number;
      interrupted[number] += thrown ? 1 : 0;
    }
    ASSERT_EQ(liveAllocations(), live) << "a leak";
    if (HasFailure()) return;
  }
  for (const std::size_t number :
       {RotationSession::kAddColumns, RotationSession::kAddRest, RotationSession::kQuery, RotationSession::kQueryAgain})
    EXPECT_GT(interrupted[number], 0U) << "call " << number << " was not interrupted";
}

// Where threads are started for each call, each may be refused.
TEST(ExceptionsCampaign, ParallelWorkSurvivesRefusedMemory) {
  constexpr std::size_t kThreads = 4;
  bool happened = true;
  for (std::size_t refused = 1; happened; ++refused) {
    std::array<std::atomic<int>, kThreads> calls{};
    bool thrown = false;
    const std::size_t live = liveAllocations();
    {
      const RefusedAllocation refusal(refused);
      try {
        lisco::inParallel(kThreads, [&](std::size_t thread) { ++calls.at(thread); });
      } catch (const std::bad_alloc&) {
        thrown = true;
      }
      happened = refusal.happened();
    }
    EXPECT_EQ(liveAllocations(), live);
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, thrown ? 0 : 1) << "allocation " << refused;
    if (HasFailure()) return;
  }
}

/// Refuses each allocation of an assignment in turn.
template <typename Clusterer>
void refuseCopies(Clusterer& clusterer, Clusterer& other) {
  const Clustering right = clustersOf(clusterer), others = clustersOf(other);
  bool happened = true;
  std::size_t refused = 0;
  while (happened) {
    Clusterer assigned(clusterer);
    bool thrown = false;
    {
      const RefusedAllocation refusal(++refused);
      try {
        assigned = other;
      } catch (const std::bad_alloc&) {
        thrown = true;
      }
      happened = refusal.happened();
    }
    ASSERT_EQ(difference(thrown ? right : others, clustersOf(assigned)), "") << "allocation " << refused;
  }
  EXPECT_GT(refused, 5U);
}

/// The same for clusterers that receive(random, clusterer) has given random columns.
template <typename Clusterer, typename Receive>
void refuseCopiesOfRandom(std::uint64_t first_seed, const Receive& receive) {
  for (std::uint64_t seed = first_seed; seed < first_seed + timesEffort(10); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Clusterer clusterers[2];
    for (Clusterer& clusterer : clusterers) receive(random, clusterer);
    refuseCopies(clusterers[0], clusterers[1]);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(ExceptionsCampaign, FailedAssignmentsChangeNothing) {
  refuseCopiesOfRandom<lisco::ColumnClusterer>(1500, [](Random& random, lisco::ColumnClusterer& clusterer) {
    const Rotation rotation(random);
    clusterer.begin(rotation.parameters);
    clusterer.addColumns(rotation.scan.columns, rotation.scan.lasers,
                         [&](std::size_t laser, std::size_t column) { return rotation.scan.at(laser, column); });
    clusterer.update();
  });
}

// --- The ground -----------------------------------------------------------------------------------------------------

TEST(ExceptionsCampaign, GroundFilterSurvivesRefusedMemory) {
  namespace ground = ground_scans;
  const auto floor = [](double azimuth, double slope) { return ground::meetsPlane(azimuth, slope, 1.8); };
  const ground::Scan few = ground::scanOf(8, 64, floor), many = ground::scanOf(48, 200, floor);
  const auto filterScan = [](lisco::GroundFilter& filter, const ground::Scan& scan) {
    std::vector<std::uint8_t> found(scan.cells.size());
    filter.filterScan(
        lisco::GroundParameters(), scan.columns, scan.lasers,
        [&](std::size_t laser, std::size_t column) { return scan.cells[laser * scan.columns + column]; }, found.data());
    return found;
  };
  lisco::GroundFilter fresh;
  const std::vector<std::uint8_t> right = filterScan(fresh, many);
  ASSERT_GT(std::count(right.begin(), right.end(), 1), 1000);
  const std::vector<lisco::Return> column(48, lisco::Return{5, 0, -1.8F, 0});
  const auto visit = [](std::size_t, const std::uint8_t*, std::size_t) {};
  for (const bool is_whole : {false, true}) {
    bool happened = true;
    std::size_t refused = 0;
    while (happened) {
      SCOPED_TRACE("allocation " + std::to_string(++refused));
      lisco::GroundFilter filter;
      filterScan(filter, few);
      filter.begin(lisco::GroundParameters(), 8);
      bool thrown = false;
      {
        const RefusedAllocation refusal(refused);
        try {
          if (is_whole)
            filterScan(filter, many);
          else
            filter.begin(lisco::GroundParameters(), 48);
        } catch (const std::bad_alloc&) {
          thrown = true;
        }
        happened = refusal.happened();
      }
      if (thrown && !is_whole) {
        EXPECT_THROW(filter.addColumn(column.data(), 48, visit), std::logic_error);
      }
      EXPECT_EQ(filterScan(filter, many), right);
      if (HasFailure()) return;
    }
    EXPECT_GT(refused, 20U);
  }
}

// --- Sliding windows ------------------------------------------------------------------------------------------------

struct Sliding {
  explicit Sliding(Random& random) : stream(randomColumnStream(random)) {
    parameters.tolerance = stream.parameters.tolerance;
    parameters.hop_columns = 1 + random.below(random.chance(0.2) ? 80 : 12);
    parameters.window_columns = parameters.hop_columns * (1 + random.below(5));
    stream = partOf(stream, 0, std::min(stream.columns.size(), 3 * parameters.window_columns));
    for (std::size_t end = parameters.hop_columns; end <= stream.columns.size(); end += parameters.hop_columns)
      right.push_back(
          trueClusters(pointsOf(stream, end - std::min(end, parameters.window_columns), end), parameters.tolerance));
  }

  ColumnStream stream;
  lisco::WindowParameters parameters;
  std::vector<Clustering> right;  ///< of each window
};

/// Calls: begin, then one for each column, after which the last window is visited by the next call.
class WindowSession {
 public:
  explicit WindowSession(const Sliding& sliding, Fuse* fuse = nullptr) : sliding_(sliding), fuse_(fuse) {}

  static std::size_t calls(const Sliding& sliding) { return 1 + 2 * sliding.stream.columns.size(); }

  void call(std::size_t number) {
    if (number == 0) return clusterer_->begin(sliding_.parameters);
    const std::vector<lisco::Return>& cells = sliding_.stream.columns[(number - 1) / 2].cells;
    if (number % 2 != 0)
      window_ends_ = clusterer_->addColumn(cells.data(), cells.size());
    else
      clusterer_->forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t) {
        if (fuse_ != nullptr) fuse_->burn();
      });
  }

  void checkInterrupted(std::size_t number) {
    fuse_ = nullptr;
    if (number > 0 && number % 2 == 0) {  // nothing was changed
      EXPECT_EQ(difference(sliding_.right[number / 2 / sliding_.parameters.hop_columns - 1], clustersOf(*clusterer_)),
                "");
      return;
    }
    EXPECT_THROW(clusterer_->addColumn(nullptr, 0), std::logic_error);
    clusterer_->forEachRun([](const std::uint32_t*, std::size_t, std::uint32_t) { ADD_FAILURE() << "visited"; });
  }

  std::string redo() {
    fuse_ = nullptr;
    std::size_t windows = 0;
    call(0);
    for (std::size_t number = 1; number < calls(sliding_); ++number) {
      call(number);
      if (number % 2 == 0 || !window_ends_) continue;
      std::string wrong = difference(sliding_.right[windows++], clustersOf(*clusterer_));
      if (!wrong.empty()) return wrong;
    }
    return windows == sliding_.right.size() ? "" : "a window did not end";
  }

 private:
  const Sliding& sliding_;
  Fuse* fuse_;
  std::unique_ptr<lisco::WindowClusterer> clusterer_ = std::make_unique<lisco::WindowClusterer>();
  bool window_ends_ = false;
};

TEST(ExceptionsCampaign, WindowsSurviveRefusedMemory) {
  std::array<std::size_t, 3> refused{};  // by begin (), addColumn () and visits
  for (std::uint64_t seed = 2000; seed < 2000 + timesEffort(60); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Sliding sliding(random);
    for (std::size_t number = 0; number < WindowSession::calls(sliding); number += 1 + random.below(6))
      refused[number == 0 ? 0 : 1 + (number + 1) % 2] +=
          refuseEachAllocation([&] { return WindowSession(sliding); }, number);
    if (HasFailure()) return;
  }
  for (const std::size_t count : refused) EXPECT_GT(count, 20U);
}

TEST(ExceptionsCampaign, FailedAssignmentsOfWindowsChangeNothing) {
  refuseCopiesOfRandom<lisco::WindowClusterer>(2500, [](Random& random, lisco::WindowClusterer& clusterer) {
    const Sliding sliding(random);
    clusterer.begin(sliding.parameters);
    for (const auto& column : sliding.stream.columns) clusterer.addColumn(column.cells.data(), column.cells.size());
  });
}

TEST(ExceptionsCampaign, WindowsSurviveThrowingVisitors) {
  std::size_t interrupted = 0;
  for (std::uint64_t seed = 3000; seed < 3000 + timesEffort(100); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Sliding sliding(random);
    const std::size_t live = liveAllocations();
    if (!sliding.right.empty()) {
      Fuse fuse(0);
      WindowSession session(sliding, &fuse);
      const std::size_t number = 2 * sliding.parameters.hop_columns * (1 + random.below(sliding.right.size()));
      for (std::size_t before = 0; before < number; ++before) session.call(before);
      fuse.replace(1 + random.below(20));
      bool thrown = false;
      interruptedCall(session, number, 0, thrown);
      if (thrown) session.checkInterrupted(number);
      ASSERT_EQ(session.redo(), "");
      interrupted += thrown ? 1 : 0;
    }
    ASSERT_EQ(liveAllocations(), live) << "a leak";
    if (HasFailure()) return;
  }
  EXPECT_GT(interrupted, 20U);
}

// --- Endless streams ------------------------------------------------------------------------------------------------

struct Unending {
  explicit Unending(Random& random) : stream(randomColumnStream(random)) {
    const std::size_t most_columns = 60 + random.below(100);
    stream = partOf(stream, 0, std::min(stream.columns.size(), most_columns));
    truth = endlessTruth(stream).deliveries;
    for (std::size_t column = 0; column < stream.columns.size(); ++column)
      if (random.chance(0.1)) updates.push_back(column);
  }

  ColumnStream stream;
  std::vector<Delivery> truth;
  std::vector<std::size_t> updates;  ///< numbers of the columns before them
};

/// Calls: begin, then each column and perhaps an update, finish.
class EndlessSession {
 public:
  explicit EndlessSession(const Unending& unending, Fuse* fuse = nullptr) : unending_(unending), fuse_(fuse) {}

  static std::size_t calls(const Unending& unending) { return 2 + 2 * unending.stream.columns.size(); }

  void call(std::size_t number) {
    if (number == 0) {
      deliveries_.clear();
      return clusterer_->begin(unending_.stream.parameters,
                               [this](const lisco::EndlessCluster& cluster) { receive(cluster); });
    }
    column_ = (number - 1) / 2;
    if (column_ == unending_.stream.columns.size()) return clusterer_->finish();
    const StreamColumn& column = unending_.stream.columns[column_];
    if (number % 2 != 0)
      clusterer_->addColumn(column.cells.data(), column.cells.size(), column.position);
    else if (std::binary_search(unending_.updates.begin(), unending_.updates.end(), column_))
      clusterer_->update();
  }

  void checkInterrupted(std::size_t) {
    fuse_ = nullptr;
    const std::size_t before = deliveries_.size();
    EXPECT_THROW(clusterer_->addColumn(nullptr, 0, 1e9), std::logic_error);
    EXPECT_NO_THROW(clusterer_->update());
    EXPECT_NO_THROW(clusterer_->finish());
    EXPECT_EQ(deliveries_.size(), before);
    for (const Delivery& delivery : deliveries_) {  // before the exception
      const auto right = std::lower_bound(unending_.truth.begin(), unending_.truth.end(), delivery);
      EXPECT_TRUE(right != unending_.truth.end() && right->members == delivery.members) << delivery;
    }
  }

  std::string redo() {
    fuse_ = nullptr;
    for (std::size_t number = 0; number < calls(unending_); ++number) call(number);
    return wrongDeliveries(unending_.stream, unending_.truth, deliveries_, unending_.updates, true);
  }

 private:
  void receive(const lisco::EndlessCluster& cluster) {
    if (fuse_ != nullptr) fuse_->burn();
    deliveries_.push_back(deliveryOf(cluster, column_));
  }

  const Unending& unending_;
  Fuse* fuse_;
  std::unique_ptr<lisco::EndlessClusterer> clusterer_ = std::make_unique<lisco::EndlessClusterer>();
  std::vector<Delivery> deliveries_;
  std::size_t column_ = 0;
};

TEST(ExceptionsCampaign, EndlessStreamsSurviveRefusedMemory) {
  std::array<std::size_t, 4> refused{};  // by begin (), addColumn (), update () and finish ()
  for (std::uint64_t seed = 4000; seed < 4000 + timesEffort(50); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Unending unending(random);
    const std::size_t last = EndlessSession::calls(unending) - 1;
    for (std::size_t number = 0; number <= last;
         number += number < last ? std::min(last - number, 1 + random.below(16)) : 1)
      refused[number == 0      ? 0
              : number == last ? 3
                               : 1 + (number + 1) % 2] +=
          refuseEachAllocation([&] { return EndlessSession(unending); }, number);
    if (HasFailure()) return;
  }
  EXPECT_EQ(refused[0], 0U) << "begin () allocates";
  for (std::size_t call = 1; call < refused.size(); ++call) EXPECT_GT(refused[call], 5U) << call;
}

TEST(ExceptionsCampaign, EndlessStreamsSurviveAThrowingCallback) {
  interruptEndlessStreams<EndlessSession, Unending>(5000, timesEffort(200));
}

}  // namespace
}  // namespace lisco_test
