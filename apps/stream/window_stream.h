// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/window_clusterer.h"
#include "stream/cluster_collector.h"
#include "stream/stream.h"

namespace lisco_apps {

/// Clusters the last columns of a stream every few columns, see lisco::WindowClusterer: the clusters of PCL's
/// EuclideanClusterExtraction on the window as an organized cloud (a row per laser), in the same order.
class WindowStream : public Stream {
 public:
  /// \param window, hop columns; the window is a multiple of the hop
  WindowStream(const StreamOptions& options, const Decoder& decoder, Listener& listener, std::size_t window,
               std::size_t hop)
      : Stream(options, decoder, listener), window_(window), hop_(hop) {}

  void wait() override { finishGround(); }
  /// Columns after the last hop belong to no window.
  void finish() override { finishGround(); }

 private:
  bool take(const PreparedColumn& column) override;
  void turnIsOver(Clock::time_point /*start*/) override {}
  bool endsWithTurns() const override { return false; }
  void begin(std::size_t lasers);
  void deliver(Clock::duration took);

  const std::size_t window_, hop_;
  lisco::WindowClusterer clusterer_;
  std::vector<Cell> cells_;          ///< of the last columns: column c is at c % capacity
  std::vector<CellUse> uses_;        ///< of these cells
  std::vector<double> azimuths_;     ///< of these columns
  std::vector<std::uint64_t> lost_;  ///< packets missing before each of them
  std::size_t lasers_ = 0;
  std::uint64_t columns_ = 0;  ///< since the clusterer began
  Turn turn_;                  ///< the last window
  std::vector<FoundCluster> clusters_;
  ClusterCollector collector_;
};

}  // namespace lisco_apps
