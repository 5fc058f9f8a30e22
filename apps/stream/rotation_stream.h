// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "lisco/column_clusterer.h"
#include "stream/cluster_collector.h"
#include "stream/stream.h"

namespace lisco_apps {

/// Clusters rotation by rotation, each while it comes: the clusters of PCL's EuclideanClusterExtraction on the rotation
/// as an organized cloud (a row per laser, from top to bottom), in the same order.
class RotationStream : public Stream {
 public:
  using Stream::Stream;

  void wait() override {}
  void finish() override;

 private:
  bool take(const PreparedColumn& column) override;
  void turnIsOver(Clock::time_point start) override;
  void begin(const PreparedColumn& column);
  /// \param start when the rotation was known to be over
  void end(Clock::time_point start);
  lisco::Parameters parametersFor(const PreparedColumn& first) const;

  lisco::ColumnClusterer clusterer_;
  Turn turn_;
  std::vector<FoundCluster> clusters_;
  ClusterCollector collector_;
};

}  // namespace lisco_apps
