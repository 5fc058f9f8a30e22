// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <string>

#include "live/address.h"
#include "live/feed.h"
#include "live/hand_over.h"
#include "live/http_server.h"
#include "live/scene.h"

namespace lisco_apps {

/// Shows a stream in browsers, while it runs:
///   LiveView view (address, report, options, title);
///   makeStream (..., view.listener ());
///   ... after each packet: view.handOver (decoder, stream);
///   view.finish (decoder, stream);
///
/// The clustering thread only copies; frames are made and sent by the server's thread, at most kMaxRate a second and
/// in at most half of its time.
class LiveView {
 public:
  static constexpr unsigned kMaxRate = 30;

  /// \param title of the page
  /// \param window columns of a sliding window; 0: there is none
  /// \throws std::runtime_error with one line if the server cannot listen
  LiveView(const HttpAddress& address, Report& report, const StreamOptions& options, const std::string& title,
           std::size_t window);

  Listener& listener() { return feed_; }
  std::string url() const { return "http://" + server_.address().text() + "/"; }
  std::size_t viewers() const { return server_.viewers(); }
  void handOver(const Decoder& decoder, const Stream& stream) { feed_.handOver(viewers() > 0, decoder, stream); }
  /// To be called at the end of the stream: shows its last state, and says that it has ended.
  void finish(const Decoder& decoder, const Stream& stream);

 private:
  /// What is plotted: a quarter of a second.
  struct Sample {
    double worst_latency_ms = 0;  ///< 0: no clusters
    double columns_per_s = 0;
    std::uint64_t lost = 0;  ///< packets
  };

  HttpServer::Frame nextFrame();
  void addSample(const LiveBatch& batch);
  std::string status(bool has_ended) const;

  const std::string unit_;  ///< of the results: what Report::Totals::turns counts
  HandOver hand_over_;
  LiveFeed feed_;
  LiveBatch* rest_ = nullptr;  ///< once the stream has ended
  std::atomic<bool> has_ended_{false};

  // Of the server's thread:
  LiveScene scene_;
  LiveBatch batch_;
  Clock::time_point next_due_{};
  bool has_news_ = false;
  bool is_last_made_ = false;
  std::uint64_t frames_ = 0;
  std::deque<Sample> samples_;
  Clock::time_point sample_since_{};
  double sample_latency_ms_ = 0;
  std::uint64_t sample_columns_ = 0, sample_lost_ = 0;  ///< totals when it began

  HttpServer server_;  ///< last: its thread uses the other members
};

}  // namespace lisco_apps
