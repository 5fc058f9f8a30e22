// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/endless_stream.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lisco_apps {
EndlessStream::EndlessStream(const StreamOptions& options, const Decoder& decoder, Listener& listener)
    : Stream(options, decoder, listener) {
  parameters_.tolerance = options.tolerance;
  parameters_.min_size = options.min_size;
  parameters_.max_size = options.max_size;
  parameters_.clockwise = true;
  parameters_.stagger = std::min(decoder.stagger(), lisco::EndlessParameters::kMaxStagger);
  parameters_.block_columns = kBlock;
  beginStream();
}

void EndlessStream::beginStream() {
  clusterer_.begin(parameters_, [this](const lisco::EndlessCluster& cluster) { deliver(cluster); });
  position_ = {};
  marks_.clear();
}

bool EndlessStream::take(const PreparedColumn& column) {
  const bool is_too_long = has_begun_ && turns_.back().turn.columns() == kMaxColumns;
  if (is_too_long) endStream();
  if (column.starts_turn || is_too_long || !has_begun_) {
    endTurn();
    if (isOver()) return false;
    begin(column);
  }
  listener_.column(column);
  time_us_ = column.origin.time_us;
  OpenTurn& open = turns_.back();
  open.last_position = column.position;
  marks_.push_back({column.position, column.origin.received});
  open.turn.add(column);
  column.fill(static_cast<std::uint32_t>(next_cell_), returns_);
  next_cell_ += column.cells.size();
  clusterer_.addColumn(returns_.data(), returns_.size(), column.position);
  if (marks_.size() >= 2 * kBlock) marks_.erase(marks_.begin(), marks_.end() - kBlock);
  closeTurns(column.position);
  return true;
}

void EndlessStream::wait() {
  finishGround();
  clusterer_.update();
}

void EndlessStream::finish() {
  finishGround();
  endStream();
}

void EndlessStream::endStream() {
  is_finishing_ = true;
  clusterer_.finish();
  is_finishing_ = false;
  endTurn();
  closeTurns(std::numeric_limits<double>::infinity());
}

void EndlessStream::begin(const PreparedColumn& column) {
  if (spare_.empty()) spare_.emplace_back();
  turns_.push_back(std::move(spare_.back()));
  spare_.pop_back();
  turns_.back().turn.begin(++rotations_, column.cells.size(), column.azimuth);
  turns_.back().first_cell = next_cell_;
  has_begun_ = true;
}

void EndlessStream::endTurn() {
  if (!has_begun_) return;
  has_begun_ = false;
  Turn& turn = turns_.back().turn;
  turn.lost = takeLost();
  listener_.turnEnds(turn);
}

/// Reports turns whose returns have all been delivered. A return in eighth n of a turn is delivered by the first column
/// of eighth n + 8, as a cluster is cut after a turn.
void EndlessStream::closeTurns(double position) {
  constexpr double kEighths = 8;
  while (!turns_.empty() && !(has_begun_ && turns_.size() == 1)) {
    const double last = std::floor(turns_.front().last_position * kEighths);
    if (!(std::floor(position * kEighths) >= last + kEighths)) return;
    listener_.turnIsLabelled(turns_.front().turn);
    spare_.push_back(std::move(turns_.front()));
    turns_.pop_front();
  }
}

/// Positions count azimuths from +x in the sense of rotation. Where clouds of another sensor follow, the stream ends.
double EndlessStream::positionOf(const Column& column) {
  constexpr double kHourUs = 3600e6;
  const SensorPlace place = decoder_.sensorPlace();
  if (parameters_.clockwise != decoder_.turnsClockwise() || !place_.isAbout(place)) {
    finishGround();
    endStream();
    outliers_before_ += clusterer_.outlierCount();
    parameters_.clockwise = decoder_.turnsClockwise();
    parameters_.origin = place.origin;
    place_ = place;
    beginStream();
  }
  std::optional<double> turns;
  if (last_time_us_ && decoder_.turnUs() > 0 && !column.after_break) {
    turns = std::remainder(column.time_us - *last_time_us_, kHourUs) / decoder_.turnUs();
  } else if (column.after_break && decoder_.turnUs() > 0) {
    turns = decoder_.gapUs() / decoder_.turnUs();  // 0 if unknown
  }
  last_time_us_ = column.time_us;
  const double azimuth = parameters_.clockwise ? column.azimuth : std::fmod(360 - column.azimuth, 360.);
  return position_.next(azimuth, turns, column.after_break);
}

/// When the first column came that cannot reach a cluster; of a cut cluster, the last column.
std::optional<Clock::time_point> EndlessStream::closedAt(double reach_end) const {
  if (is_finishing_ || marks_.empty()) return std::nullopt;
  const auto mark = std::find_if(marks_.begin(), marks_.end(), [&](const Mark& m) { return m.position >= reach_end; });
  return mark == marks_.end() ? marks_.back().received : mark->received;
}

void EndlessStream::deliver(const lisco::EndlessCluster& cluster) {
  DeliveredCluster delivered;
  if (++delivered_ == 0) delivered_ = 1;  // after 2^32 clusters; 0 is no cluster
  delivered.found.id = delivered_;
  points_.clear();
  cells_.clear();
  delivered.cells = &cells_;
  cluster.forEachRun([&](const std::uint32_t* indices, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      // The turn that holds the index; differences are correct across the wrap-around of indices.
      auto open = turns_.rbegin();
      while (indices[i] - static_cast<std::uint32_t>(open->first_cell) >= open->turn.cells.size()) ++open;
      const std::size_t cell = indices[i] - static_cast<std::uint32_t>(open->first_cell);
      open->turn.labels[cell] = delivered.found.id;
      const Cell& place = open->turn.cells[cell];
      points_.push_back({place.x, place.y, place.z});
      cells_.push_back(open->first_cell + cell);
    }
  });
  delivered.turns_clockwise = parameters_.clockwise;
  delivered.first_position = cluster.firstPosition();
  delivered.last_position = cluster.lastPosition();
  delivered.is_cut = cluster.isCut();
  delivered.is_continued = cluster.isContinued();
  delivered.time_us = time_us_;
  if (const auto closed = closedAt(cluster.reachEnd())) {
    delivered.latency = Clock::now() - *closed;
    cluster_latency_.add(*delivered.latency);
  }
  delivered.found.features = lisco::clusterFeatures(points_.data(), points_.size(), sizeof points_[0]);
  listener_.cluster(delivered);
}

}  // namespace lisco_apps
