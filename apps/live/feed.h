// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "live/hand_over.h"
#include "stream/report.h"
#include "stream/stream.h"

namespace lisco_apps {

/// Copies columns and results for viewers, and passes the results on to a report. What it costs the clustering thread
/// is two copies of the columns, and a swap of buffers for each frame; without viewers, nothing. The first copy is to
/// memory that no other thread uses, whose cache lines are at hand; the second one waits for the end of the packet.
/// Columns beyond kMaxCells that have not been taken are dropped, the oldest first.
class LiveFeed : public Listener {
 public:
  static constexpr std::size_t kMaxCells = std::size_t{1} << 20;

  LiveFeed(Report& report, HandOver& hand_over) : report_(report), hand_over_(hand_over) {}

  void column(const PreparedColumn& column) override;
  void found(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) override;
  void cluster(const DeliveredCluster& cluster) override;
  void turnEnds(const Turn& turn) override;
  void turnIsLabelled(const Turn& turn) override { report_.turnIsLabelled(turn); }

  /// To be called after each packet.
  /// \param has_viewers without, nothing is copied from now on
  void handOver(bool has_viewers, const Decoder& decoder, const Stream& stream);
  /// To be called at the end of the stream, when nothing is taken any more: the batch that has not been handed over.
  LiveBatch& rest(const Decoder& decoder, const Stream& stream);

 private:
  /// Cells copied before the end of a packet: a packet of a sensor has fewer, a recorded cloud has more.
  static constexpr std::size_t kMaxLatest = std::size_t{1} << 13;
  /// Between two attempts: half a frame's time. At 5 ms, the columns after a swap were 1 % of all, and the 99th
  /// percentile of the columns' latency 12 % higher (benchmarks/live_view.sh, VLS-128).
  static constexpr std::chrono::milliseconds kPause{16};

  void note(Clock::duration latency);
  void clear();
  void flushColumns();
  void fillTotals(const Decoder& decoder, const Stream& stream);

  Report& report_;
  HandOver& hand_over_;
  LiveColumns latest_;  ///< of the current packet, not yet in the batch
  LiveBatch batch_;
  bool is_copying_ = false;
  std::uint64_t next_cell_ = 0;
  Clock::time_point last_attempt_{};
};

}  // namespace lisco_apps
