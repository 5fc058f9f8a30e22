// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// What viewers see, without a server.
#include "live/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <thread>

#include "random.h"
#include "sensors/velodyne_decoder.h"
#include "sensors/velodyne_encoder.h"
#include "stream/endless_stream.h"
#include "stream/rotation_stream.h"
#include "stream/window_stream.h"

namespace lisco_test {
namespace {

using lisco_apps::Cell;
using lisco_apps::FoundCluster;
using lisco_apps::HandOver;
using lisco_apps::LiveBatch;
using lisco_apps::LiveFeed;
using lisco_apps::LiveScene;
using lisco_apps::Report;
using lisco_apps::StreamOptions;
using lisco_apps::Turn;
using lisco_apps::ViewScan;

constexpr std::size_t kColumns = 200;  ///< of a turn
constexpr std::size_t kPosts = 8;

/// A feed, its scene, and a sensor among posts, which change their range from turn to turn, above a floor.
class LiveSceneTest : public testing::Test {
 protected:
  LiveSceneTest() {
    options_.tolerance = 0.5F;
    options_.min_size = 5;
    options_.ground = lisco_apps::groundChoiceOf("height:-1");
    lisco_apps::VelodyneEncoder encoder("vlp16");
    encoder.step = 36000 / kColumns;  // hundredths of a degree, by which the decoder knows how many columns a turn has
    const lisco_apps::Bytes packet =
        encoder.next([](std::size_t, std::size_t, bool) { return lisco_apps::Measured(); });
    decoder_.decode({packet.data(), packet.size()}, [](const lisco_apps::Column&) {});
  }

  template <typename AnyStream, typename... More>
  void start(More... more) {
    scene_.emplace(options_, "title", std::max<std::size_t>({0, more...}));
    report_.callWith([this](const Turn& turn, const std::vector<FoundCluster>& clusters) {
      turn_ = turn;
      clusters_ = clusters;
    });
    stream_ = std::make_unique<AnyStream>(options_, decoder_, feed_, more...);
    feed_.handOver(true, decoder_, *stream_);
    LiveBatch nothing;
    EXPECT_TRUE(hand_over_.take(nothing));
  }

  void turn(std::size_t columns) {
    std::vector<Cell> cells(16);
    for (std::size_t i = 0; i < columns; ++i, ++column_) {
      const double azimuth = 360. * static_cast<double>(column_ % kColumns) / kColumns;
      const double angle = azimuth * 3.14159265358979 / 180;
      const std::size_t slice = column_ % kColumns / (kColumns / kPosts);
      const bool is_post = column_ % (kColumns / kPosts) < 10;
      for (std::size_t laser = 0; laser < cells.size(); ++laser) {
        const double range = 5 + static_cast<double>(slice) + 0.1 * static_cast<double>(column_ / kColumns);
        const bool is_floor = laser == 15;
        cells[laser] = is_post || is_floor ? Cell{static_cast<float>(range * std::cos(angle)),
                                                  static_cast<float>(-range * std::sin(angle)),
                                                  is_floor ? -2 : 0.1F * static_cast<float>(laser), 7}
                                           : lisco_apps::kNoCell;
      }
      ASSERT_TRUE(stream_->add({cells, azimuth, 50. * static_cast<double>(column_), false}, {}));
    }
  }
  /// \param is_slow the server's thread does not take the batch
  void handOver(bool is_slow = false) {
    std::this_thread::sleep_for(std::chrono::milliseconds(17));
    feed_.handOver(true, decoder_, *stream_);
    LiveBatch batch;
    if (!is_slow && hand_over_.take(batch)) scene_->take(batch);
  }
  void finish() {
    stream_->finish();
    LiveBatch batch;
    if (hand_over_.take(batch)) scene_->take(batch);
    scene_->take(feed_.rest(decoder_, *stream_));
  }

  /// Points by label; 0: those of no cluster, without the ground.
  std::map<std::uint32_t, std::size_t> sizes() {
    const ViewScan& scan = scene_->show();
    std::map<std::uint32_t, std::size_t> sizes;
    for (std::size_t i = 0; i < scan.points.size(); ++i)
      if (scan.is_ground[i] == 0) ++sizes[scan.labellings[0].labels[i]];
    return sizes;
  }
  void expectLastTurn() {
    const ViewScan& scan = scene_->show();
    EXPECT_EQ(scan.points.size(), turn_.returns + turn_.ground);
    const auto& listed = scan.labellings[0].clusters;
    ASSERT_EQ(listed.size(), clusters_.size());
    std::map<std::uint32_t, std::size_t> expected;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      EXPECT_EQ(listed[i].size, clusters_[i].features.size);
      expected[clusters_[i].id] = clusters_[i].features.size;
    }
    EXPECT_EQ(sizes(), expected);
  }

  StreamOptions options_;
  lisco_apps::VelodyneDecoder decoder_{lisco_apps::makeVelodyneModel("vlp16")};
  Report report_{Report::Format::kJson};
  HandOver hand_over_;
  LiveFeed feed_{report_, hand_over_};
  std::optional<LiveScene> scene_;
  std::unique_ptr<lisco_apps::Stream> stream_;
  std::size_t column_ = 0;
  Turn turn_;
  std::vector<FoundCluster> clusters_;
};

TEST_F(LiveSceneTest, ShowsSubclustersWhileTheSensorTurns) {
  start<lisco_apps::RotationStream>();
  turn(kColumns / 2);
  handOver();
  const std::map<std::uint32_t, std::size_t> half = sizes();
  EXPECT_EQ(half.size(), kPosts / 2);
  for (const auto& [label, size] : half) EXPECT_EQ(size, 150U) << label;
  EXPECT_TRUE(scene_->show().labellings[0].clusters.empty());
  turn(kColumns / 2);
  handOver();
  EXPECT_EQ(sizes().size(), kPosts);
}

TEST_F(LiveSceneTest, ShowsTheClustersOfARotationAndSweepsThem) {
  start<lisco_apps::RotationStream>();
  turn(kColumns + 1);
  handOver();
  ASSERT_EQ(clusters_.size(), kPosts);
  EXPECT_EQ(scene_->show().labellings[0].clusters.size(), kPosts);
  turn(kColumns / 2);
  handOver();
  const std::map<std::uint32_t, std::size_t> swept = sizes();
  EXPECT_EQ(scene_->show().points.size(), turn_.returns + turn_.ground);
  // The latter half of the first turn, and the first half of the second, as subclusters.
  std::size_t final_points = 0, open_points = 0;
  for (const auto& [label, size] : swept) (label <= kPosts ? final_points : open_points) += size;
  EXPECT_GT(final_points, 400U);
  EXPECT_GT(open_points, 400U);
  EXPECT_EQ(swept.count(0), 0U);
  turn(kColumns);
  finish();
  expectLastTurn();
}

TEST_F(LiveSceneTest, ASlowServerShowsTheLastRotation) {
  Random random(3);
  start<lisco_apps::RotationStream>();
  for (int i = 0; i < 60; ++i) {
    turn(random.below(90));
    handOver(random.chance(0.7));
  }
  finish();
  expectLastTurn();
}

TEST_F(LiveSceneTest, ShowsTheLastWindow) {
  start<lisco_apps::WindowStream>(std::size_t{100}, std::size_t{10});
  for (int i = 0; i < 7; ++i) {
    turn(50);
    handOver();
    expectLastTurn();
  }
}

TEST_F(LiveSceneTest, ShowsClustersOfAnEndlessStreamAsTheyAreDelivered) {
  start<lisco_apps::EndlessStream>();
  turn(kColumns * 3 / 2);
  handOver();
  const std::size_t delivered = scene_->show().labellings[0].clusters.size();
  EXPECT_GE(delivered, kPosts / 2);
  turn(kColumns);
  finish();
  const ViewScan& scan = scene_->show();
  const std::map<std::uint32_t, std::size_t> shown = sizes();
  EXPECT_EQ(shown.count(0), 0U);
  EXPECT_EQ(shown.size(), scan.labellings[0].clusters.size());
  // Labels are numbers on the page; ids are the stream's, of which the first clusters are no longer shown.
  std::uint32_t last = 0;
  for (const lisco_apps::ViewCluster& cluster : scan.labellings[0].clusters) {
    EXPECT_GT(cluster.id, last);
    last = cluster.id;
  }
  EXPECT_GT(last, scan.labellings[0].clusters.size());
}

TEST_F(LiveSceneTest, IsWholeAfterATurn) {
  start<lisco_apps::RotationStream>();
  turn(kColumns / 2);
  handOver();
  EXPECT_FALSE(scene_->isWhole());
  turn(kColumns);
  handOver();
  EXPECT_TRUE(scene_->isWhole());
}

TEST_F(LiveSceneTest, WithoutViewersNothingIsCopied) {
  start<lisco_apps::RotationStream>();
  feed_.handOver(false, decoder_, *stream_);
  turn(3 * kColumns);
  LiveBatch batch;
  EXPECT_FALSE(hand_over_.take(batch));
  EXPECT_TRUE(feed_.rest(decoder_, *stream_).columns.cells.empty());
  // A viewer comes: the rest of the turn is shown, by the clusters of the whole.
  feed_.handOver(true, decoder_, *stream_);
  if (hand_over_.take(batch)) scene_->take(batch);  // where the turns before took longer than the feed's pause
  turn(kColumns / 2);
  handOver();
  EXPECT_GT(sizes().size(), 2U);
  turn(2 * kColumns);
  finish();
  expectLastTurn();
}

}  // namespace
}  // namespace lisco_test
