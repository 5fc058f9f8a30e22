// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "lisco/endless_clusterer.h"
#include "stream/stream.h"
#include "stream/turn_position.h"

namespace lisco_apps {

/// Clusters without rotations: each cluster is delivered once no later column can reach it, see
/// lisco::EndlessClusterer. Clusters are numbered in the order of delivery.
class EndlessStream : public Stream {
 public:
  EndlessStream(const StreamOptions& options, const Decoder& decoder, Listener& listener);

  void wait() override;
  void finish() override;
  std::optional<std::uint64_t> outliers() const override { return outliers_before_ + clusterer_.outlierCount(); }

 private:
  /// Columns that are read together: at most a millisecond of these sensors. One by one they take three times as long.
  static constexpr std::size_t kBlock = 16;

  /// A turn some of whose clusters may be open.
  struct OpenTurn {
    Turn turn;
    std::uint64_t first_cell = 0;  ///< number of its first cell
    double last_position = 0;      ///< of its last column
  };
  /// A column that may close clusters.
  struct Mark {
    double position = 0;
    Clock::time_point received;
  };

  bool take(const PreparedColumn& column) override;
  void turnIsOver(Clock::time_point /*start*/) override {}
  double positionOf(const Column& column) override;
  void beginStream();
  void begin(const PreparedColumn& column);
  void endTurn();
  void closeTurns(double position);
  void endStream();
  void deliver(const lisco::EndlessCluster& cluster);
  std::optional<Clock::time_point> closedAt(double reach_end) const;

  lisco::EndlessParameters parameters_;
  SensorPlace place_;  ///< of the sensor
  TurnPosition position_;
  lisco::EndlessClusterer clusterer_;
  std::uint64_t outliers_before_ = 0;  ///< of streams of the clusterer that have ended
  std::deque<OpenTurn> turns_;         ///< the current one is last
  std::vector<OpenTurn> spare_;
  bool is_finishing_ = false;
  std::uint64_t next_cell_ = 0;  ///< number of the next cell; its lower half is the cell's source index
  std::optional<double> last_time_us_;
  std::int64_t time_us_ = 0;
  std::uint32_t delivered_ = 0;
  std::vector<Mark> marks_;                   ///< of the latest columns
  std::vector<std::array<float, 3>> points_;  ///< of the cluster that is delivered
  std::vector<std::uint64_t> cells_;          ///< of the same
};

}  // namespace lisco_apps
