// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "live/live_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "io/cluster_json.h"
#include "live/request.h"
#include "view/page.h"
#include "view/scan_encoder.h"

namespace lisco_apps {
namespace {

constexpr std::chrono::milliseconds kSamplePeriod{250};
constexpr std::size_t kMaxSamples = 240;  ///< a minute
constexpr double kPerMillisecond = 1e3;

}  // namespace

LiveView::LiveView(const HttpAddress& address, Report& report, const StreamOptions& options, const std::string& title,
                   std::size_t window)
    : unit_(window > 0 ? "windows" : "rotations"),
      feed_(report, hand_over_),
      scene_(options, title, window),
      server_(address, liveViewPage(title, std::string(kLivePath)), [this] { return nextFrame(); }) {}

void LiveView::finish(const Decoder& decoder, const Stream& stream) {
  rest_ = &feed_.rest(decoder, stream);
  has_ended_ = true;
  server_.finish();
}

HttpServer::Frame LiveView::nextFrame() {
  if (is_last_made_) return nullptr;
  const bool has_ended = has_ended_;
  if (hand_over_.take(batch_)) {
    scene_.take(batch_);
    addSample(batch_);
    has_news_ = true;
  }
  if (has_ended) {
    std::swap(batch_, *rest_);
    scene_.take(batch_);
    addSample(batch_);
  }
  const auto start = Clock::now();
  if (!has_ended && (!has_news_ || start < next_due_)) return nullptr;
  has_news_ = false;
  is_last_made_ = has_ended;
  std::string bytes = withSize(status(has_ended)) + encodeViewScan(scene_.show(), PointOrder::kAsGiven);
  ++frames_;
  const auto took = Clock::now() - start;
  next_due_ = start + std::max<Clock::duration>(2 * took, std::chrono::microseconds(1000000 / kMaxRate));
  return std::make_shared<const std::string>(std::move(bytes));
}

void LiveView::addSample(const LiveBatch& batch) {
  sample_latency_ms_ = std::max(sample_latency_ms_, batch.worst_latency_ms);
  const auto time = batch.time - sample_since_;
  if (sample_since_ == Clock::time_point()) {
    sample_since_ = batch.time;
    sample_columns_ = batch.packets.columns;
    sample_lost_ = batch.packets.missing;
  } else if (time >= kSamplePeriod) {
    const double seconds = std::chrono::duration<double>(time).count();
    samples_.push_back({sample_latency_ms_, static_cast<double>(batch.packets.columns - sample_columns_) / seconds,
                        batch.packets.missing - sample_lost_});
    if (samples_.size() > kMaxSamples) samples_.pop_front();
    sample_since_ = batch.time;
    sample_latency_ms_ = 0;
    sample_columns_ = batch.packets.columns;
    sample_lost_ = batch.packets.missing;
  }
}

/// JSON, see doc/view.md.
std::string LiveView::status(bool has_ended) const {
  const Report::Totals& totals = batch_.totals;
  Json samples = Json::array();
  for (const Sample& sample : samples_)
    samples.push_back(
        {rounded(sample.worst_latency_ms, kPerMillisecond), std::round(sample.columns_per_s), sample.lost});
  return Json{{"state", has_ended ? "ended" : "running"},
              {"frame", frames_ + 1},
              {"result", scene_.resultNumber()},
              {"whole", scene_.isWhole()},
              {"unit", unit_},
              {"rotations", totals.turns},
              {"columns", totals.columns},
              {"returns", totals.returns},
              {"ground", totals.ground},
              {"clusters", totals.clusters},
              {"in_clusters", totals.in_clusters},
              {"packets", batch_.packets.data},
              {"lost", batch_.packets.missing},
              {"late", batch_.packets.late},
              {"latency_ms",
               {rounded(batch_.latency_p50_ms, kPerMillisecond), rounded(batch_.latency_p99_ms, kPerMillisecond),
                rounded(batch_.latency_max_ms, kPerMillisecond)}},
              {"sample_s", std::chrono::duration<double>(kSamplePeriod).count()},
              {"samples", std::move(samples)}}
      .dump();
}

}  // namespace lisco_apps
