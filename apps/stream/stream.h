// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "io/cluster_shape.h"
#include "latency.h"
#include "sensors/decoder.h"
#include "turn.h"

namespace lisco_apps {

/// How a stream of columns is to be clustered.
struct StreamOptions {
  float tolerance = 0;  ///< metres
  std::size_t min_size = 10;
  std::size_t max_size = std::numeric_limits<int>::max();
  float ground_z = -std::numeric_limits<float>::infinity();  ///< returns below it are left out, metres
  std::uint64_t rotations = 0;                               ///< after which to end; 0: no limit
};

/// Where a column came from.
struct Origin {
  std::int64_t time_us = 0;    ///< of its packet, microseconds since 1970
  Clock::time_point received;  ///< when the packet was at hand
};

/// A turn ends after this many columns, which bounds its memory if the sensor stands still: 0.01 degrees per column,
/// the resolution of azimuths in packets.
inline constexpr std::size_t kMaxColumns = 36000;

struct FoundCluster : ClusterShape {
  std::uint32_t id = 0;  ///< from 1
};

/// A cluster of an endless stream.
struct DeliveredCluster {
  FoundCluster found;
  double first_position = 0, last_position = 0;  ///< of its first and last column, turns
  bool is_cut = false, is_continued = false;     ///< see lisco::EndlessCluster
  std::int64_t time_us = 0;                      ///< of the last packet before the delivery
  std::optional<Clock::duration> latency;        ///< none if delivered by the end of the stream
};

/// Receives the results of a Stream.
class Listener {
 public:
  virtual ~Listener() = default;

  /// A rotation has been clustered: clusters largest first, cells labelled.
  virtual void rotation(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) = 0;

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
  virtual ~Stream() = default;

  /// Takes the next column.
  /// \return false, without taking it, if it belongs to a rotation beyond StreamOptions::rotations
  virtual bool add(const Column& column, const Origin& origin) = 0;
  /// To be called when no column comes for a while.
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
  Latency column_latency_, cluster_latency_;
};

}  // namespace lisco_apps
