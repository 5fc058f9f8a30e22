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
/// is a copy of the columns, and every few milliseconds a swap of buffers; without viewers, nothing. Columns beyond
/// kMaxCells that have not been taken are dropped, the oldest first.
class LiveFeed : public Listener {
 public:
  static constexpr std::size_t kMaxCells = std::size_t{1} << 20;

  LiveFeed(Report& report, HandOver& hand_over) : report_(report), hand_over_(hand_over) {}

  void column(const PreparedColumn& column) override;
  void rotation(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) override;
  void window(const Turn& window, const std::vector<FoundCluster>& clusters, Clock::duration latency) override;
  void cluster(const DeliveredCluster& cluster) override;
  void turnEnds(const Turn& turn) override;
  void turnIsLabelled(const Turn& turn) override { report_.turnIsLabelled(turn); }

  /// To be called after each packet.
  /// \param has_viewers without, nothing is copied from now on
  void handOver(bool has_viewers, const Decoder& decoder, const Stream& stream);
  /// To be called at the end of the stream, when nothing is taken any more: the batch that has not been handed over.
  LiveBatch& rest(const Decoder& decoder, const Stream& stream);

 private:
  static constexpr std::chrono::milliseconds kPause{5};  ///< between two attempts

  void result(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency);
  void note(Clock::duration latency);
  void fillTotals(const Decoder& decoder, const Stream& stream);

  Report& report_;
  HandOver& hand_over_;
  LiveBatch batch_;
  bool is_copying_ = false;
  std::uint64_t next_cell_ = 0;
  Clock::time_point last_attempt_{};
};

}  // namespace lisco_apps
