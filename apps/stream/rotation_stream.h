// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "lisco/column_clusterer.h"
#include "sensors/rotation_cutter.h"
#include "stream.h"

namespace lisco_apps {

/// Clusters rotation by rotation, each while it comes: the clusters of PCL's EuclideanClusterExtraction on the rotation
/// as an organized cloud (a row per laser, from top to bottom), in the same order.
class RotationStream : public Stream {
 public:
  RotationStream(const StreamOptions& options, const Decoder& decoder, Listener& listener);

  bool add(const Column& column, const Origin& origin) override;
  void wait() override {}
  void finish() override { end(); }

 private:
  void begin(const Column& column);
  void end();
  void collect();
  lisco::Parameters parameters() const;

  const StreamOptions options_;
  const Decoder& decoder_;
  Listener& listener_;
  RotationCutter cutter_;
  lisco::ColumnClusterer clusterer_;
  Turn turn_;
  bool has_begun_ = false;
  std::uint64_t rotations_ = 0, missing_before_ = 0;
  Clock::duration last_column_took_{};
  std::vector<lisco::Return> returns_;
  std::vector<FoundCluster> clusters_;

  /// A subcluster of an accepted size; its rank is by first points.
  struct Candidate {
    std::uint32_t size, rank;
  };
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> rank_of_subcluster_, label_of_rank_;
};

}  // namespace lisco_apps
