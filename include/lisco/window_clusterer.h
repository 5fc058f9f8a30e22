// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <memory>

#include "lisco/return.h"

namespace lisco {

/// How sliding windows are clustered.
struct WindowParameters {
  float tolerance = 0.0F;           ///< eps, metres; see Parameters::tolerance for 0, negative, NaN and infinite values
  std::size_t window_columns = 0;   ///< W: number of columns of a window; a multiple of the hop
  std::size_t hop_columns = 0;      ///< H: a window ends after every H columns
  std::size_t lasers = 0;           ///< largest number of cells of a column; 0: any number
  bool keep_source_indices = true;  ///< see Parameters::keep_source_indices
};

/// The clusters of the last W columns, every H columns, without clustering from scratch: each equals what
/// ColumnClusterer finds in the same columns (after the idea of Pi-Lisco, Najdataei et al. 2022).
///
///   lisco::WindowClusterer clusterer;
///   clusterer.begin({0.4F, 1800, 100});
///   while (...)
///     if (clusterer.addColumn(returns, lasers)) clusterer.forEachRun(...);
///
/// H columns are a *pane*, which is clustered once, by itself. A new pane is compared with the older ones of its
/// window, and pairs found are kept as edges between the subclusters of panes. A window's subclusters then need only
/// these edges, no geometry. An edge expires with its older pane, so edges to younger panes are preferred and those
/// between subclusters that younger edges join are dropped (a maximum spanning forest by age).
///
/// Nothing is allocated once the buffers have grown to the largest window seen. Not thread safe; any number of
/// instances may work side by side.
class LISCO_EXPORT WindowClusterer {
 public:
  WindowClusterer();
  ~WindowClusterer();
  WindowClusterer(const WindowClusterer& other);             ///< a copy goes on from the same column
  WindowClusterer& operator=(const WindowClusterer& other);  ///< the same

  /// Starts a new stream and forgets the last one. After an exception that is not listed at the function (refused
  /// memory), all calls but begin () throw std::logic_error or do nothing.
  /// \throws std::invalid_argument if the window is not a positive multiple of the hop
  void begin(const WindowParameters& parameters);

  /// Takes the next column.
  /// \param cells cells[l] is what laser l measured; those that are no returns are skipped
  /// \param lasers number of cells, may differ from column to column
  /// \return whether a window ends with it. The first windows are shorter: all columns so far.
  /// \throws std::logic_error before begin (); std::invalid_argument if there are more cells than
  ///         WindowParameters::lasers, unless that is 0, or 2^31 or more in W such columns
  bool addColumn(const Return* cells, std::size_t lasers);

  std::size_t columnCount() const;      ///< of the last window
  std::size_t returnCount() const;      ///< of the last window
  std::size_t subclusterCount() const;  ///< of the last window
  /// Number of returns in a subcluster of the last window, 0..subclusterCount()-1.
  std::uint32_t sizeOf(std::uint32_t subcluster) const { return sizes()[subcluster]; }
  const std::uint32_t* sizes() const;  ///< of all subclusters of the last window, until the next one ends

  /// Visits all returns of the last window as ColumnClusterer::forEachRun does, until the next window ends. Columns are
  /// counted from the window's first.
  /// \throws std::logic_error if visit takes source indices and WindowParameters::keep_source_indices is false
  template <typename Visit>
  void forEachRun(Visit&& visit, const SizeRange& sizes = {}) {
    const RunVisitor::WithoutFrom<Visit> visit_run{visit};
    visitRuns(RunVisitor(visit_run), sizes);
  }

 private:
  void visitRuns(const RunVisitor& visit, const SizeRange& sizes);

  class LISCO_HIDDEN Window;
  std::unique_ptr<Window> window_;
};

}  // namespace lisco
