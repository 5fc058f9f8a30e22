// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "cluster_collector.h"
#include "lisco/column_clusterer.h"
#include "stream.h"

namespace lisco_apps {

/// Clusters rotation by rotation, each while it comes: the clusters of PCL's EuclideanClusterExtraction on the rotation
/// as an organized cloud (a row per laser, from top to bottom), in the same order.
class RotationStream : public Stream {
 public:
  using Stream::Stream;

  bool add(const Column& column, const Origin& origin) override;
  void wait() override {}
  void finish() override { end(); }

 private:
  void begin(const Column& column);
  void end();
  lisco::Parameters parametersFor(const Column& first) const;

  lisco::ColumnClusterer clusterer_;
  Turn turn_;
  Clock::duration last_column_took_{};
  std::vector<FoundCluster> clusters_;
  ClusterCollector collector_;
};

}  // namespace lisco_apps
