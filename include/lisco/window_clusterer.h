// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/column_block.h"
#include "lisco/disjoint_sets.h"
#include "lisco/export.h"
#include "lisco/pane.h"
#include "lisco/return.h"
#include "lisco/tolerance.h"

namespace lisco {

/// How sliding windows are to be clustered.
struct WindowParameters {
  float tolerance = 0.0F;          ///< eps, metres; see Tolerance for 0, negative, NaN and infinite values
  std::size_t window_columns = 0;  ///< W: how many columns a window holds; a multiple of the hop
  std::size_t hop_columns = 0;     ///< H: after how many columns the next window ends
  std::size_t lasers = 0;          ///< most cells of a column; 0: any number
};

/// The clusters of the last W columns, every H columns, without clustering from scratch: each equals what
/// ColumnClusterer finds in the same columns (after the idea of Pi-Lisco, Najdataei et al. 2022).
///
///   lisco::WindowClusterer clusterer;
///   clusterer.begin({0.4F, 1800, 100});
///   while (...)
///     if (clusterer.addColumn(returns, lasers)) clusterer.forEachRun(...);
///
/// H columns are a *pane*, which is clustered once, by itself. A new pane is compared with the older ones of its window,
/// and what was found is remembered as edges between the subclusters of panes. A window's subclusters then need only
/// these edges, no geometry. An edge is of no use once its older pane has left the window; so older panes are asked
/// last, and an edge between what newer ones join already is forgotten (a maximum spanning forest by age).
///
/// Nothing is allocated once the buffers have grown to the largest window seen. Not thread safe; any number of instances
/// may work side by side.
class LISCO_EXPORT WindowClusterer {
 public:
  /// Starts a new stream and forgets the last one. After an exception that is not about the arguments, this is the only
  /// call that is of use.
  /// \throws std::invalid_argument if the window is no multiple, 1 or more, of the hop
  void begin(const WindowParameters& parameters);

  /// Takes the next column.
  /// \param cells cells[l] is what laser l measured; those that are no returns are skipped
  /// \return whether a window ends with it. The first windows are shorter: all columns so far.
  /// \throws std::logic_error before begin (), std::invalid_argument if there are more cells than lasers
  bool addColumn(const Return* cells, std::size_t lasers);

  /// Number of columns of the last window.
  std::size_t columnCount() const { return columns_; }
  /// Number of returns of the last window.
  std::size_t returnCount() const { return returns_; }

  /// Number of subclusters of the last window.
  std::size_t subclusterCount() const { return sizes_.size(); }
  /// Number of returns in a subcluster of the last window.
  /// \param subcluster 0..subclusterCount()-1
  std::uint32_t sizeOf(std::uint32_t subcluster) const { return sizes_[subcluster]; }

  /// Calls visit(source_indices, count, subcluster) for all returns of the last window, in groups of the same subcluster,
  /// of one laser and of columns side by side: laser by laser, and the returns of each in the order of their columns. To
  /// be called before the next window ends.
  template <typename Visit>
  void forEachRun(Visit&& visit);

 private:
  /// What two panes have in common: a subcluster of one and one of the other are one.
  struct Edge {
    std::uint32_t older_subcluster, newer_subcluster;
    std::uint64_t newer_pane;  ///< its number
  };
  struct WindowPane : Pane {
    std::uint32_t first_element = 0;   ///< of its subclusters in the window's forest
    std::vector<std::uint32_t> sizes;  ///< of its subclusters
    std::vector<Edge> edges;           ///< to newer panes
  };
  class PaneJoiner;

  WindowPane& pane(std::uint64_t number) { return panes_[number % panes_.size()]; }
  void finishPane();
  void numberSubclusters(WindowPane& pane);
  void join(WindowPane& older);

  WindowParameters parameters_;
  bool begun_ = false;  ///< and left by no exception since
  Tolerance tolerance_;
  ColumnBlock block_;
  std::vector<WindowPane> panes_;  ///< a ring
  std::uint64_t newest_ = 0;       ///< number of the pane that is being filled
  std::uint64_t oldest_ = 0;
  std::size_t pane_columns_ = 0;  ///< read into it
  DisjointSets window_;           ///< of the panes' subclusters
  std::vector<std::uint32_t> subcluster_of_element_;
  std::vector<std::uint32_t> sizes_;
  std::size_t columns_ = 0;
  std::size_t returns_ = 0;
  LaserOrder order_;
};

template <typename Visit>
void WindowClusterer::forEachRun(Visit&& visit) {
  if (!begun_ || columns_ == 0) return;
  const auto runs_of = [this](std::size_t part) -> const Runs& { return pane(oldest_ + part).runs; };
  order_.sort(newest_ - oldest_, runs_of);
  order_.forEachRun(runs_of, [&](std::size_t part, const Runs& runs, const Runs::Run& run) {
    visit(runs.source_index.data() + run.first_cell, static_cast<std::size_t>(run.count),
          subcluster_of_element_[pane(oldest_ + part).first_element + run.subcluster]);
  });
}

}  // namespace lisco
