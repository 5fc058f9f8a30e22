// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "latency.h"
#include "sensors/decoder.h"

namespace lisco_apps {

/// How a stream of columns is to be clustered.
struct StreamOptions {
  float tolerance = 0;  ///< metres
  std::size_t min_size = 10;
  std::size_t max_size = std::numeric_limits<int>::max();
  float ground_z = -std::numeric_limits<float>::infinity();  ///< returns below it are left out, metres
  std::uint64_t rotations = 0;                               ///< so many are wanted; 0: all
};

/// Where a column came from.
struct Origin {
  std::int64_t time_us = 0;    ///< of its packet, microseconds since 1970
  Clock::time_point received;  ///< when that packet was at hand
};

/// A turn is ended after so many columns, since memory is: a sensor that turns by less than what its azimuth can tell
/// from one column to the next stands still.
inline constexpr std::size_t kMostColumns = 36000;

/// A way of clustering a stream of columns. What it finds, it tells a Listener.
class Stream {
 public:
  virtual ~Stream() = default;

  /// Takes the next column.
  /// \return false if the rotations that were wanted have come: this column is of the next one, and was left out
  virtual bool add(const Column& column, const Origin& origin) = 0;
  /// No more columns come for a while.
  virtual void wait() = 0;
  /// The stream has ended.
  virtual void finish() = 0;

  /// What it takes to take a column.
  const Latency& columnLatency() const { return column_latency_; }
  /// How long the clusters take: of a rotation from its last column on, otherwise from the column on that cannot reach
  /// the cluster any more.
  const Latency& clusterLatency() const { return cluster_latency_; }

 protected:
  Stream() = default;
  Stream(const Stream&) = default;
  Stream& operator=(const Stream&) = default;

  Latency column_latency_, cluster_latency_;
};

}  // namespace lisco_apps
