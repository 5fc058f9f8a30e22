// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "rotation_stream.h"

#include <algorithm>

#include "lisco/sensor_hints.h"
#include "view_of.h"

namespace lisco_apps {

RotationStream::RotationStream(const StreamOptions& options, const Decoder& decoder, Listener& listener)
    : options_(options), decoder_(decoder), listener_(listener) {}

bool RotationStream::add(const Column& column, const Origin& origin) {
  auto start = Clock::now();
  if (cutter_.startsRotation(column.azimuth, column.after_break) || turn_.columns() == kMostColumns) {
    end();
    if (options_.rotations != 0 && rotations_ == options_.rotations) return false;
    start = Clock::now();
    begin(column);
  }
  const auto first_index = static_cast<std::uint32_t>(turn_.cells.size());
  turn_.add(column.cells, options_.ground_z, first_index, returns_);
  turn_.time_us = origin.time_us;
  clusterer_.addColumn(returns_.data(), returns_.size());
  last_column_took_ = Clock::now() - start;
  column_latency_.add(last_column_took_);
  return true;
}

void RotationStream::finish() {
  end();
}

/// What the next rotation is expected to look like, which decides the speed only.
lisco::Parameters RotationStream::parameters() const {
  lisco::Parameters parameters;
  parameters.sensor = viewOf(decoder_);
  if (turn_.columns() > 0) {
    // The last rotation tells more: how far returns lie, and how the sensor really turns.
    const auto cell_at = [this](std::size_t laser, std::size_t column) {
      const Cell& cell = turn_.cells[column * turn_.lasers + laser];
      return cell.z >= options_.ground_z ? lisco::Return{cell.x, cell.y, cell.z, 0} : lisco::kNoReturn;
    };
    const lisco::SensorHints estimated =
        lisco::estimateSensor(turn_.columns(), turn_.lasers, {}, lisco::CellSource(cell_at));
    if (estimated.steps_per_turn > 0) parameters.sensor = estimated;
  }
  parameters.tolerance = options_.tolerance;
  parameters.lasers = decoder_.model().lasers.size();
  return parameters;
}

void RotationStream::begin(const Column& column) {
  clusterer_.begin(parameters());
  turn_.begin(++rotations_, column.cells.size(), column.azimuth);
  has_begun_ = true;
}

void RotationStream::end() {
  if (!has_begun_) return;
  has_begun_ = false;
  const auto start = Clock::now();
  clusterer_.update();
  collect();
  const auto latency = last_column_took_ + (Clock::now() - start);
  cluster_latency_.add(latency);
  turn_.lost = decoder_.order().missing() - missing_before_;
  missing_before_ = decoder_.order().missing();
  listener_.rotation(turn_, clusters_, latency);
}

/// Numbers the clusters as PCL orders them, and labels the cells.
void RotationStream::collect() {
  constexpr std::uint32_t kUnseen = ~std::uint32_t{0}, kNone = kUnseen - 1;
  candidates_.clear();
  label_of_subcluster_.assign(clusterer_.subclusterCount(), kUnseen);
  clusterer_.forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t subcluster) {
    std::uint32_t& place = label_of_subcluster_[subcluster];
    if (place != kUnseen) return;
    const std::uint32_t size = clusterer_.sizeOf(subcluster);
    const bool is_cluster = size >= options_.min_size && size <= options_.max_size;
    place = is_cluster ? static_cast<std::uint32_t>(candidates_.size()) : kNone;
    if (is_cluster) candidates_.push_back({size, place});
  });
  // Not a stable sort: only PCL's own call, on the same sequence of sizes, gives PCL's order among clusters of one size.
  std::sort(candidates_.rbegin(), candidates_.rend(),
            [](const Candidate& a, const Candidate& b) { return a.size < b.size; });
  label_of_place_.resize(candidates_.size());
  clusters_.assign(candidates_.size(), {});
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    clusters_[i].id = static_cast<std::uint32_t>(i + 1);
    label_of_place_[candidates_[i].place] = clusters_[i].id;
  }
  clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
    const std::uint32_t place = label_of_subcluster_[subcluster];
    if (place == kNone) return;
    const std::uint32_t label = label_of_place_[place];
    for (std::size_t i = 0; i < count; ++i) {
      turn_.labels[cells[i]] = label;
      clusters_[label - 1].add(turn_.cells[cells[i]]);
    }
  });
}

}  // namespace lisco_apps
