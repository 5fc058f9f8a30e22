// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "live/feed.h"

#include <algorithm>

namespace lisco_apps {

void LiveFeed::column(const PreparedColumn& column) {
  if (is_copying_) {
    if (latest_.cells.size() + column.cells.size() > kMaxLatest) flushColumns();
    latest_.add(column);
  }
  next_cell_ += column.cells.size();
}

void LiveFeed::flushColumns() {
  if (batch_.columns.cells.size() + latest_.cells.size() > kMaxCells) {
    batch_.columns.clear();
    batch_.first_cell = next_cell_ - latest_.cells.size();
  }
  batch_.columns.add(latest_);
  latest_.clear();
}

/// Drops what has been copied.
void LiveFeed::clear() {
  latest_.clear();
  batch_.clear(next_cell_);
}

void LiveFeed::found(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) {
  note(latency);
  if (is_copying_) {
    batch_.result_end = next_cell_;
    batch_.result_number = turn.number;
    batch_.labels.assign(turn.labels.begin(), turn.labels.end());
    batch_.clusters.assign(clusters.begin(), clusters.end());
  }
  report_.found(turn, clusters, latency);
}

void LiveFeed::cluster(const DeliveredCluster& cluster) {
  if (cluster.latency) note(*cluster.latency);
  if (is_copying_ && batch_.delivered_cells.size() + cluster.cells->size() <= kMaxCells) {
    batch_.delivered_cells.insert(batch_.delivered_cells.end(), cluster.cells->begin(), cluster.cells->end());
    batch_.deliveries.push_back({cluster.found, batch_.delivered_cells.size()});
  }
  report_.cluster(cluster);
}

void LiveFeed::turnEnds(const Turn& turn) {
  batch_.turn_end = next_cell_;
  batch_.turn_cells = turn.cells.size();
  report_.turnEnds(turn);
}

void LiveFeed::note(Clock::duration latency) {
  batch_.worst_latency_ms = std::max(batch_.worst_latency_ms, millisecondsOf(latency));
}

void LiveFeed::fillTotals(const Decoder& decoder, const Stream& stream) {
  batch_.totals = report_.totals();
  batch_.packets = decoder.counts();
  const Latency& latency = stream.clusterLatency();
  batch_.latency_p50_ms = latency.percentileMs(0.5);
  batch_.latency_p99_ms = latency.percentileMs(0.99);
  batch_.latency_max_ms = latency.maxMs();
}

void LiveFeed::handOver(bool has_viewers, const Decoder& decoder, const Stream& stream) {
  if (!has_viewers) {
    if (is_copying_) clear();
    is_copying_ = false;
    return;
  }
  if (!is_copying_) clear();
  is_copying_ = true;
  flushColumns();
  const auto now = Clock::now();
  if (now - last_attempt_ < kPause) return;
  last_attempt_ = now;
  fillTotals(decoder, stream);
  batch_.time = now;
  if (hand_over_.give(batch_)) batch_.clear(next_cell_);
}

LiveBatch& LiveFeed::rest(const Decoder& decoder, const Stream& stream) {
  flushColumns();
  fillTotals(decoder, stream);
  batch_.time = Clock::now();
  return batch_;
}

}  // namespace lisco_apps
