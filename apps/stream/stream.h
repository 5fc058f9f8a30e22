// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "io/scan_options.h"
#include "lisco/cluster_features.h"
#include "lisco/return.h"
#include "sensors/decoder.h"
#include "sensors/rotation_cutter.h"
#include "stream/ground_stage.h"
#include "stream/latency.h"

namespace lisco_apps {

/// The columns received of one turn of the sensor, or of a sliding window.
struct Turn {
  std::uint64_t number = 0;  ///< from 1
  std::size_t lasers = 0;
  std::vector<Cell> cells;            ///< column by column, in each from the top laser to the bottom one
  std::vector<CellUse> uses;          ///< of the cells
  std::vector<std::uint32_t> labels;  ///< of the cells: cluster id, 0: in none
  double azimuth = 0;                 ///< of its first column, degrees clockwise
  std::int64_t time_us = 0;           ///< of the packet of its last column, microseconds since 1970
  std::uint64_t returns = 0;          ///< clustered
  std::uint64_t ground = 0;           ///< returns left out as ground
  std::uint64_t lost = 0;             ///< packets missing in it, or between it and the next one
  bool is_window = false;

  std::size_t columns() const { return lasers == 0 ? 0 : cells.size() / lasers; }
  bool isGround(std::size_t cell) const { return uses[cell] == CellUse::kGround; }

  /// Starts an empty turn; keeps its memory.
  void begin(std::uint64_t new_number, std::size_t new_lasers, double new_azimuth) {
    cells.clear();
    uses.clear();
    labels.clear();
    *this = {new_number, new_lasers, std::move(cells), std::move(uses), std::move(labels), new_azimuth};
  }

  void add(const PreparedColumn& column) {
    cells.insert(cells.end(), column.cells.begin(), column.cells.end());
    uses.insert(uses.end(), column.uses.begin(), column.uses.end());
    labels.resize(cells.size(), 0);
    for (const CellUse use : column.uses) {
      returns += use == CellUse::kClustered ? 1 : 0;
      ground += use == CellUse::kGround ? 1 : 0;
    }
    time_us = column.origin.time_us;
  }
};

/// Settings of a stream.
struct StreamOptions {
  float tolerance = 0;  ///< metres
  std::size_t min_size = 10;
  std::size_t max_size = std::numeric_limits<int>::max();
  GroundChoice ground;
  Region region;
  std::uint64_t rotations = 0;  ///< after which to end; 0: no limit
};

struct FoundCluster {
  std::uint32_t id = 0;  ///< from 1
  lisco::ClusterFeatures features;
};

/// A cluster of an endless stream.
struct DeliveredCluster {
  const std::vector<std::uint64_t>* cells = nullptr;  ///< numbers, from the first cell of the stream's first column
  FoundCluster found;
  double first_position = 0, last_position = 0;  ///< of its first and last column, turns
  bool turns_clockwise = true;                   ///< positions count azimuths clockwise, else counterclockwise
  bool is_cut = false, is_continued = false;     ///< see lisco::EndlessCluster
  std::int64_t time_us = 0;                      ///< of the last packet before the delivery
  std::optional<Clock::duration> latency;        ///< none if delivered by the end of the stream
};

/// Receives the results of a Stream.
class Listener {
 public:
  virtual ~Listener() = default;

  /// A column has been received; results that cover it follow.
  virtual void column(const PreparedColumn& /*column*/) {}

  /// A rotation or sliding window has been clustered: clusters largest first, cells labelled.
  virtual void found(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) = 0;

  /// A cluster has been delivered.
  virtual void cluster(const DeliveredCluster& cluster) = 0;
  /// The last column of a turn has been added; some of its clusters may still be open.
  virtual void turnEnds(const Turn& turn) = 0;
  /// All clusters of a turn have been delivered, and its cells labelled.
  virtual void turnIsLabelled(const Turn& turn) = 0;
};

/// Clusters a stream of columns and passes the results to a Listener.
class Stream {
 public:
  Stream(const StreamOptions& options, const Decoder& decoder, Listener& listener)
      : options_(options), decoder_(decoder), listener_(listener), cutter_(decoder.rotationStart()) {}
  virtual ~Stream() = default;

  /// Adds the next column.
  /// \return false, without taking it, if it belongs to a rotation beyond StreamOptions::rotations
  bool add(const Column& column, const Origin& origin);
  /// To be called when no column has come for a while.
  virtual void wait() = 0;
  /// To be called at the end of the stream.
  virtual void finish() = 0;

  /// Duration of add ().
  const Latency& columnLatency() const { return column_latency_; }
  /// Returns at another azimuth than their column's, each a cluster of its own; nullopt for rotations.
  virtual std::optional<std::uint64_t> outliers() const { return std::nullopt; }
  /// Delay of clusters: from the last column of the rotation, or from the first column that cannot reach the cluster.
  const Latency& clusterLatency() const { return cluster_latency_; }

 protected:
  /// Clusters a column whose ground is known.
  /// \return false, without taking it, if it belongs to a rotation beyond StreamOptions::rotations
  virtual bool take(const PreparedColumn& column) = 0;
  /// Called before the first column of a turn is taken. \param start when that column came
  virtual void turnIsOver(Clock::time_point start) = 0;
  /// Whether StreamOptions::rotations counts turns, rather than what take () counts.
  virtual bool endsWithTurns() const { return true; }
  /// Of a column in endless streams, turns; called for each column as it comes.
  virtual double positionOf(const Column& /*column*/) { return 0; }

  /// Passes the columns that wait for the ground filter to take ().
  void finishGround();
  /// Whether the rotation that the next column starts is beyond StreamOptions::rotations.
  bool isOver() const { return options_.rotations != 0 && rotations_ == options_.rotations; }
  /// Packets missing since the last call.
  std::uint64_t takeLost() {
    const std::uint64_t before = std::exchange(missing_before_, decoder_.counts().missing);
    return missing_before_ - before;
  }

  const StreamOptions options_;
  const Decoder& decoder_;
  Listener& listener_;
  RotationCutter cutter_;
  bool has_begun_ = false;       ///< the current turn
  std::uint64_t rotations_ = 0;  ///< begun
  std::vector<lisco::Return> returns_;
  Clock::duration last_column_took_{};
  Latency column_latency_, cluster_latency_;

 private:
  void pass(const PreparedColumn& column);

  GroundStage stage_{options_.ground, options_.region};
  std::uint64_t received_turns_ = 0;  ///< some of their columns may wait for the ground filter
  bool is_open_ = true;               ///< for further columns; false: beyond StreamOptions::rotations
  bool takes_ = true;                 ///< for columns whose ground is known
  std::uint64_t missing_before_ = 0;
};

}  // namespace lisco_apps
