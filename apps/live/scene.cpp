// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "live/scene.h"

#include <algorithm>
#include <utility>

#include "io/text.h"
#include "lisco/sensor_hints.h"

namespace lisco_apps {

LiveScene::LiveScene(const StreamOptions& options, std::string title, std::size_t window)
    : options_(options), window_(window) {
  scan_.name = std::move(title);
  // As it was given: 0.4, not the nearest float.
  scan_.labellings.push_back({"", std::stod(formatted("%g", static_cast<double>(options.tolerance))), {}, {}});
}

/// Columns are missing: what was held before them does not belong to what follows.
void LiveScene::restart(std::uint64_t next_cell) {
  held_ = {};
  columns_.clear();
  first_ = shown_from_ = next_cell;
  clusters_.clear();
  delivered_.clear();
  beginPreview();
}

void LiveScene::take(const LiveBatch& batch) {
  if (batch.first_cell != next()) restart(batch.first_cell);
  std::size_t at = 0;
  const std::uint64_t turn_end = std::max(batch.result_end, batch.turn_end);
  bool has_ended = turn_end == 0 || turn_end < batch.first_cell;
  const auto end = [&] {
    if (batch.result_end > 0) applyResult(batch);
    if (batch.turn_end > 0) endTurn(batch.turn_cells);
    has_ended = true;
  };
  for (const std::uint32_t size : batch.columns.sizes) {
    if (!has_ended && next() >= turn_end) end();
    addColumn(&batch.columns.cells[at], &batch.columns.uses[at], size);
    at += size;
  }
  if (!has_ended) end();
  deliver(batch);
}

void LiveScene::addColumn(const Cell* cells, const CellUse* uses, std::uint32_t count) {
  if (count > preview_lasers_) {
    preview_lasers_ = count;
    beginPreview();
  }
  returns_.resize(count);
  const auto index = static_cast<std::uint32_t>(next() - preview_from_);
  for (std::uint32_t i = 0; i < count; ++i) returns_[i] = returnOf(cells[i], uses[i], index + i);
  preview_.addColumn(returns_.data(), count);
  held_.cells.insert(held_.cells.end(), cells, cells + count);
  held_.uses.insert(held_.uses.end(), uses, uses + count);
  held_.labels.resize(held_.cells.size(), 0);
  columns_.push_back(count);
  dropOldest();
}

/// Shows no more cells than the last turn has, or the current one, and frees those not shown once they are half of all.
void LiveScene::dropOldest() {
  const std::uint64_t turn = turn_cells_ > 0 ? turn_cells_ : LiveFeed::kMaxCells;
  const std::uint64_t most = std::min<std::uint64_t>(
      std::max({turn, next() - preview_from_, std::uint64_t{window_} * preview_lasers_}), LiveFeed::kMaxCells);
  while (!columns_.empty() && next() - shown_from_ > most) {
    shown_from_ += columns_.front();
    columns_.pop_front();
  }
  const auto hidden = static_cast<std::ptrdiff_t>(shown_from_ - first_);
  if (2 * static_cast<std::size_t>(hidden) < held_.cells.size() || hidden < 4096) return;
  held_.cells.erase(held_.cells.begin(), held_.cells.begin() + hidden);
  held_.uses.erase(held_.uses.begin(), held_.uses.begin() + hidden);
  held_.labels.erase(held_.labels.begin(), held_.labels.begin() + hidden);
  first_ = shown_from_;
}

void LiveScene::applyResult(const LiveBatch& batch) {
  result_number_ = batch.result_number;
  clusters_ = batch.clusters;
  const std::uint64_t labelled_from = batch.result_end - std::min<std::uint64_t>(batch.labels.size(), batch.result_end);
  const std::uint64_t from = std::max(labelled_from, first_);
  std::fill(held_.labels.begin(), held_.labels.end(), 0);
  for (std::uint64_t number = from; number < std::min(batch.result_end, next()); ++number)
    held_.labels[number - first_] = batch.labels[number - labelled_from];
  endTurn(batch.labels.size());
}

void LiveScene::endTurn(std::uint64_t cells) {
  turn_cells_ = cells;
  preview_from_ = next();
  dropOldest();
  beginPreview();
}

void LiveScene::deliver(const LiveBatch& batch) {
  std::size_t at = 0;
  for (const LiveDelivery& delivery : batch.deliveries) {
    for (; at < delivery.cells_end; ++at) {
      const std::uint64_t number = batch.delivered_cells[at];
      if (number >= first_ && number < next()) held_.labels[number - first_] = delivery.cluster.id;
    }
    delivered_[delivery.cluster.id] = delivery.cluster;
  }
}

/// Starts with the next column; hints are those of the columns held.
void LiveScene::beginPreview() {
  lisco::Parameters parameters;
  parameters.tolerance = options_.tolerance;
  parameters.lasers = preview_lasers_;
  const std::size_t lasers = preview_lasers_;
  const bool is_organized =
      std::all_of(columns_.begin(), columns_.end(), [&](std::uint32_t size) { return size == lasers; });
  if (is_organized && columns_.size() > 1) {
    const std::size_t from = shown_from_ - first_;
    const auto cell_at = [&](std::size_t laser, std::size_t column) {
      const std::size_t at = from + column * lasers + laser;
      return returnOf(held_.cells[at], held_.uses[at], 0);
    };
    const lisco::SensorHints estimated = lisco::estimateSensor(columns_.size(), lasers, {}, lisco::CellSource(cell_at));
    if (estimated.steps_per_turn > 0) parameters.sensor = estimated;
  }
  preview_.begin(parameters);
  preview_from_ = next();
}

void LiveScene::updatePreview() {
  held_.open.assign(held_.cells.size(), 0);
  preview_.update();
  order_.assign(preview_, options_.min_size, options_.max_size);
  preview_.forEachRun([&](const std::uint32_t* indices, std::size_t count, std::uint32_t subcluster) {
    const std::int32_t label = order_.labelOf(subcluster);
    if (label == lisco::ClusterOrder::kNoCluster) return;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t number = preview_from_ + indices[i];
      if (number >= first_) held_.open[number - first_] = static_cast<std::uint32_t>(label) + 1;
    }
  });
}

const ViewScan& LiveScene::show() {
  updatePreview();
  scan_.points.clear();
  scan_.intensity.clear();
  scan_.ring.clear();
  scan_.is_ground.clear();
  ViewLabelling& labelling = scan_.labellings.front();
  labelling.labels.clear();
  labelling.clusters.clear();

  // An endless stream's clusters are numbered in the order of their ids, which the page shows.
  std::map<std::uint32_t, std::uint32_t> number_of;
  if (!delivered_.empty()) {
    for (std::uint64_t number = shown_from_; number < next(); ++number)
      if (const std::uint32_t id = held_.labels[number - first_]; id != 0) number_of[id] = 0;
    for (auto it = delivered_.begin(); it != delivered_.end();) {
      const auto found = number_of.find(it->first);
      if (found == number_of.end()) {
        it = delivered_.erase(it);
        continue;
      }
      labelling.clusters.push_back(viewClusterOf(it->second.features, it->first));
      found->second = static_cast<std::uint32_t>(labelling.clusters.size());
      ++it;
    }
  } else {
    for (const FoundCluster& cluster : clusters_) labelling.clusters.push_back(viewClusterOf(cluster.features));
  }

  const auto final_clusters = static_cast<std::uint32_t>(labelling.clusters.size());
  const std::uint32_t most_lasers = columns_.empty() ? 0 : *std::max_element(columns_.begin(), columns_.end());
  std::uint32_t last_id = 0, last_number = 0;
  // Laser by laser: adjacent returns of a laser differ least, and take the fewest bytes.
  for (std::uint32_t laser = 0; laser < most_lasers; ++laser) {
    std::size_t at = shown_from_ - first_ + laser;
    for (const std::uint32_t size : columns_) {
      const std::size_t cell = std::exchange(at, at + size);
      if (laser >= size || held_.uses[cell] == CellUse::kNothing) continue;
      const Cell& place = held_.cells[cell];
      scan_.points.push_back({place.x, place.y, place.z});
      scan_.intensity.push_back(place.intensity);
      scan_.ring.push_back(static_cast<std::uint16_t>(laser));
      scan_.is_ground.push_back(held_.uses[cell] == CellUse::kGround ? 1 : 0);
      std::uint32_t label = held_.labels[cell];
      if (label != 0 && !number_of.empty()) {
        if (label != last_id) last_number = number_of[label];
        last_id = label;
        label = last_number;
      }
      if (label == 0 && held_.open[cell] != 0) label = final_clusters + held_.open[cell];
      labelling.labels.push_back(label);
    }
  }
  return scan_;
}

}  // namespace lisco_apps
