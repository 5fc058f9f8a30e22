// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Both kinds of streams on irregular columns.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "random.h"
#include "sensors/velodyne_decoder.h"
#include "sensors/velodyne_encoder.h"
#include "stream/endless_stream.h"
#include "stream/rotation_stream.h"

namespace lisco_test {
namespace {

using lisco_apps::Cell;
using lisco_apps::Column;
using lisco_apps::DeliveredCluster;
using lisco_apps::FoundCluster;
using lisco_apps::GroundChoice;
using lisco_apps::Stream;
using lisco_apps::StreamOptions;
using lisco_apps::Turn;
using lisco_apps::VelodyneDecoder;

/// Checks that the results of a stream agree with each other.
class ConsistencyChecker : public lisco_apps::Listener {
 public:
  void found(const Turn& turn, const std::vector<FoundCluster>& clusters, lisco_apps::Clock::duration) override {
    EXPECT_EQ(turn.number, ++turns);
    columns += turn.columns();
    std::map<std::uint32_t, std::size_t> sizes = sizesByLabel(turn);
    EXPECT_EQ(sizes.size(), clusters.size());
    for (const FoundCluster& cluster : clusters) EXPECT_EQ(cluster.features.size, sizes[cluster.id]);
    for (std::size_t i = 1; i < clusters.size(); ++i)
      EXPECT_LE(clusters[i].features.size, clusters[i - 1].features.size);
    found_clusters += clusters.size();
  }
  void cluster(const DeliveredCluster& cluster) override {
    EXPECT_EQ(cluster.found.id, ++found_clusters);
    delivered_[cluster.found.id] = cluster.found.features.size;
  }
  void turnEnds(const Turn& turn) override {
    EXPECT_EQ(turn.number, ++turns);
    columns += turn.columns();
  }
  void turnIsLabelled(const Turn& turn) override {
    EXPECT_EQ(turn.number, ++labelled_);
    for (const auto& [label, size] : sizesByLabel(turn)) sizes_by_label_[label] += size;
  }

  /// To be called after the end of an endless stream.
  void expectAllLabelled() const {
    EXPECT_EQ(labelled_, turns);
    EXPECT_EQ(sizes_by_label_, delivered_);
  }

  std::uint64_t turns = 0, columns = 0, found_clusters = 0;

 private:
  static std::map<std::uint32_t, std::size_t> sizesByLabel(const Turn& turn) {
    EXPECT_EQ(turn.labels.size(), turn.cells.size());
    std::map<std::uint32_t, std::size_t> sizes;
    for (const std::uint32_t label : turn.labels) ++sizes[label];
    sizes.erase(0);
    return sizes;
  }

  std::uint64_t labelled_ = 0;
  std::map<std::uint32_t, std::size_t> delivered_, sizes_by_label_;  ///< sizes
};

/// Columns of a VLP-16 with jumps of its azimuth and clock.
void feed(Stream& stream, Random& random, std::size_t columns) {
  std::vector<Cell> cells(16);
  double azimuth = 0, time_us = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    azimuth += 0.4;
    time_us += 55.296;
    const std::size_t chance = random.below(1000);
    if (chance < 3) azimuth = static_cast<double>(random.below(36000)) / 100;
    if (chance == 3) azimuth += 359.9;
    if (chance == 4) time_us = static_cast<double>(random.below(3600000)) * 1000;
    azimuth = std::fmod(azimuth, 360.);
    const double angle = azimuth * 3.14159265358979 / 180;
    for (std::size_t laser = 0; laser < cells.size(); ++laser) {
      const double range = static_cast<double>(1 + random.below(3)) + 0.01 * static_cast<double>(random.below(9));
      cells[laser] = {static_cast<float>(range * std::cos(angle)), static_cast<float>(-range * std::sin(angle)),
                      0.1F * static_cast<float>(laser), 1};
      if (random.below(5) == 0) cells[laser].x = std::numeric_limits<float>::quiet_NaN();
      if (random.below(500) == 0) cells[laser].y = std::numeric_limits<float>::infinity();
      if (random.below(500) == 0) cells[laser] = {1e30F, -1e30F, 3e38F, 0};
      if (random.below(500) == 0) cells[laser] = {0, 0, 1e-30F, 0};
    }
    ASSERT_TRUE(stream.add(Column{cells, azimuth, time_us, chance == 5}, {}));
    if (chance == 6) stream.wait();
  }
}

TEST(Streams, AcceptIrregularColumns) {
  constexpr std::uint64_t kSeed = 5;
  for (const auto& [tolerance, ground] :
       {std::pair<float, GroundChoice>{0.1F, lisco_apps::groundChoiceOf("height:0.05")},
        {1.5F, lisco_apps::groundChoiceOf("slope")}}) {
    StreamOptions options;
    options.tolerance = tolerance;
    options.min_size = 1;
    options.ground = ground;
    VelodyneDecoder decoder(lisco_apps::makeVelodyneModel("vlp16"));
    lisco_apps::VelodyneEncoder encoder("vlp16");
    encoder.step = 80;  // hundredths of a degree, by which the decoder knows how many columns a turn has
    const lisco_apps::Bytes packet =
        encoder.next([](std::size_t, std::size_t, bool) { return lisco_apps::Measured(); });
    decoder.decode({packet.data(), packet.size()}, [](const Column&) {});
    constexpr std::size_t kColumns = 30000;

    ConsistencyChecker of_rotations;
    lisco_apps::RotationStream rotations(options, decoder, of_rotations);
    Random random(kSeed);
    feed(rotations, random, kColumns);
    rotations.finish();
    EXPECT_EQ(of_rotations.columns, kColumns);
    EXPECT_EQ(rotations.columnLatency().count(), kColumns);
    EXPECT_EQ(rotations.clusterLatency().count(), of_rotations.turns);

    ConsistencyChecker of_endless;
    lisco_apps::EndlessStream endless(options, decoder, of_endless);
    Random again(kSeed);
    feed(endless, again, kColumns);
    endless.finish();
    EXPECT_EQ(of_endless.columns, kColumns);
    EXPECT_EQ(endless.columnLatency().count(), kColumns);
    of_endless.expectAllLabelled();
    EXPECT_EQ(of_rotations.turns, of_endless.turns);
    EXPECT_GT(of_endless.found_clusters, 100U);
  }
}

TEST(Streams, FindNothingWithoutColumns) {
  VelodyneDecoder decoder(lisco_apps::makeVelodyneModel("vlp16"));
  ConsistencyChecker witness;
  lisco_apps::RotationStream rotations({}, decoder, witness);
  lisco_apps::EndlessStream endless({}, decoder, witness);
  for (Stream* stream : {static_cast<Stream*>(&rotations), static_cast<Stream*>(&endless)}) {
    stream->wait();
    stream->finish();
    stream->finish();
  }
  EXPECT_EQ(witness.turns + witness.found_clusters, 0U);
}

}  // namespace
}  // namespace lisco_test
