// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "sensors/decoder.h"
#include "stream/report.h"
#include "stream/stream.h"

namespace lisco_apps {

/// A cluster of an endless stream.
struct LiveDelivery {
  FoundCluster cluster;
  std::size_t cells_end = 0;  ///< of its cells in LiveBatch::delivered_cells; they begin at the end of those before
};

/// Columns one after the other.
struct LiveColumns {
  std::vector<std::uint32_t> sizes;  ///< cells of each column
  std::vector<Cell> cells;
  std::vector<CellUse> uses;  ///< of the cells

  void add(const PreparedColumn& column) {
    sizes.push_back(static_cast<std::uint32_t>(column.cells.size()));
    cells.insert(cells.end(), column.cells.begin(), column.cells.end());
    uses.insert(uses.end(), column.uses.begin(), column.uses.end());
  }
  void add(const LiveColumns& columns) {
    sizes.insert(sizes.end(), columns.sizes.begin(), columns.sizes.end());
    cells.insert(cells.end(), columns.cells.begin(), columns.cells.end());
    uses.insert(uses.end(), columns.uses.begin(), columns.uses.end());
  }
  /// Keeps the memory.
  void clear() {
    sizes.clear();
    cells.clear();
    uses.clear();
  }
};

/// What has happened since the last hand-over. Cells are numbered from the first one of the stream.
struct LiveBatch {
  std::uint64_t first_cell = 0;  ///< number of the first of these cells
  LiveColumns columns;

  /// The last rotation or window: labels of the cells before result_end.
  std::uint64_t result_end = 0;  ///< 0: none
  std::uint64_t result_number = 0;
  std::vector<std::uint32_t> labels;
  std::vector<FoundCluster> clusters;

  /// The last turn of an endless stream that has ended, and clusters delivered.
  std::uint64_t turn_end = 0;  ///< 0: none
  std::uint64_t turn_cells = 0;
  std::vector<LiveDelivery> deliveries;
  std::vector<std::uint64_t> delivered_cells;

  double worst_latency_ms = 0;  ///< of clusters; 0: there were none
  Report::Totals totals;        ///< since the beginning
  Decoder::Counts packets;      ///< the same
  double latency_p50_ms = 0, latency_p99_ms = 0, latency_max_ms = 0;
  Clock::time_point time;  ///< of the hand-over

  /// Keeps the memory.
  void clear(std::uint64_t next_cell) {
    first_cell = next_cell;
    columns.clear();
    result_end = turn_end = 0;
    deliveries.clear();
    delivered_cells.clear();
    worst_latency_ms = 0;
  }
};

/// Passes batches from one thread to another, neither of which waits for the other: one batch may wait to be taken.
class HandOver {
 public:
  /// \return false if the last batch has not been taken; otherwise `batch` is an old one, to be cleared
  bool give(LiveBatch& batch) {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || is_full_) return false;
    std::swap(batch, waiting_);
    is_full_ = true;
    return true;
  }

  /// \return false if none waits
  bool take(LiveBatch& batch) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!is_full_) return false;
    std::swap(batch, waiting_);
    is_full_ = false;
    return true;
  }

 private:
  std::mutex mutex_;  ///< held for a swap only
  LiveBatch waiting_;
  bool is_full_ = false;
};

}  // namespace lisco_apps
