// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/cluster_shape.h"
#include "latency.h"
#include "turn.h"

namespace lisco_apps {

/// A cluster and its number.
struct FoundCluster : ClusterShape {
  std::uint32_t id = 0;  ///< from 1
};

/// A cluster of a stream without end.
struct DeliveredCluster {
  FoundCluster found;
  double first_position = 0, last_position = 0;  ///< of its first and of its last column, turns
  bool is_cut = false, is_continued = false;     ///< see lisco::EndlessCluster
  std::int64_t time_us = 0;                      ///< when the packet came after which it was delivered
  std::optional<Clock::duration> latency;        ///< none if the end of the stream delivered it
};

/// Is told what was found.
class Listener {
 public:
  virtual ~Listener() = default;

  /// A rotation has been clustered: clusters largest first, cells labelled.
  virtual void rotation(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) = 0;

  /// A cluster has been delivered.
  virtual void cluster(const DeliveredCluster& cluster) = 0;
  /// The sensor goes on to the next turn; clusters of this one may still be open.
  virtual void turnEnds(const Turn& turn) = 0;
  /// All clusters of this turn have been delivered, and its cells labelled.
  virtual void turnIsLabelled(const Turn& turn) = 0;

 protected:
  Listener() = default;
  Listener(const Listener&) = default;
  Listener& operator=(const Listener&) = default;
};

}  // namespace lisco_apps
