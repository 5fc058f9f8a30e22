// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "lisco/cluster_order.h"
#include "lisco/column_clusterer.h"
#include "live/feed.h"
#include "stream/stream.h"
#include "view/view_scan.h"

namespace lisco_apps {

/// What viewers of a stream see, from the batches of its feed: the columns of the last turn of the sensor (or of the
/// last window), each replaced by the new one as it comes. Returns of the last result have its clusters; later ones
/// have the subclusters of the columns so far, which a clusterer of its own finds.
class LiveScene {
 public:
  /// \param title shown by the page
  /// \param window columns of a sliding window; 0: turns of the sensor are shown
  LiveScene(const StreamOptions& options, std::string title, std::size_t window = 0);

  void take(const LiveBatch& batch);
  /// The scene for the page. Clusters of the last result come first; open subclusters are the labels after them.
  const ViewScan& show();
  /// Number of the last rotation or window; 0: none yet.
  std::uint64_t resultNumber() const { return result_number_; }
  /// Whether the columns of a whole turn or window are shown, but for one.
  bool isWhole() const { return turn_cells_ > 0 && next() - shown_from_ + preview_lasers_ >= turn_cells_; }

 private:
  /// The cells that are held; number n has index n - first_.
  struct Held {
    std::vector<Cell> cells;
    std::vector<CellUse> uses;
    std::vector<std::uint32_t> labels;  ///< final: of the result, or of an endless stream's cluster; 0: none
    std::vector<std::uint32_t> open;    ///< subcluster, from 1; 0: none
  };

  void restart(std::uint64_t next_cell);
  void addColumn(const Cell* cells, const CellUse* uses, std::uint32_t count);
  void applyResult(const LiveBatch& batch);
  void endTurn(std::uint64_t cells);
  void deliver(const LiveBatch& batch);
  void beginPreview();
  void updatePreview();
  void dropOldest();
  std::uint64_t next() const { return first_ + held_.cells.size(); }

  StreamOptions options_;
  Held held_;
  std::uint64_t first_ = 0;            ///< number of the first cell that is held
  std::deque<std::uint32_t> columns_;  ///< sizes of those shown
  std::uint64_t shown_from_ = 0;       ///< number of a cell
  std::size_t window_;
  std::uint64_t turn_cells_ = 0;                     ///< cells shown at most; 0: not known yet
  std::vector<FoundCluster> clusters_;               ///< of the last result
  std::map<std::uint32_t, FoundCluster> delivered_;  ///< of an endless stream, by id, some of whose cells are shown
  std::uint64_t result_number_ = 0;

  lisco::ColumnClusterer preview_;
  lisco::ClusterOrder order_;
  std::uint64_t preview_from_ = 0;  ///< number of its first cell
  std::uint32_t preview_lasers_ = 0;
  std::vector<lisco::Return> returns_;
  ViewScan scan_;
};

}  // namespace lisco_apps
