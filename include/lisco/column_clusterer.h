// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "lisco/box.h"
#include "lisco/disjoint_sets.h"
#include "lisco/grid_mask.h"
#include "lisco/return.h"
#include "lisco/shelf.h"
#include "lisco/tolerance.h"
#include "lisco/view_mask.h"
#include "lisco/view_strip.h"

namespace lisco {

/// How a rotation is to be clustered. Only the tolerance changes the result.
struct Parameters {
  float tolerance = 0.0F;  ///< eps, metres; see Tolerance for 0, negative, NaN and infinite values
  /// Which mask finds neighbours: tiles of one sensor's view, or a grid of cubic cells.
  enum class Mask { kView, kGrid } mask = Mask::kView;
  ViewHints view;                        ///< for Mask::kView
  std::size_t expected_returns = 65536;  ///< for Mask::kGrid and to reserve memory; more are welcome
  /// How many columns are read together, 1..64. Whoever asks for the subclusters gets them for all columns
  /// added, so it is not seen from outside: 64 is the fastest, since the returns of a laser lie side by side in a
  /// cloud's memory; 1 does the work of each column at once.
  std::size_t block_columns = 64;
  /// For how many columns a patch waits for more of its returns before it is compared with others. Not seen
  /// from outside either; a cloud whose columns are no columns (unorganized) wants the greatest number.
  std::size_t open_columns = 16;
};

/// Lisco: Euclidean clustering of a rotating LiDAR's returns, column by column (Algorithms 3 and 4 of the paper).
///
///   lisco::ColumnClusterer clusterer;
///   clusterer.begin({0.4F});                                // eps = 0.4 m
///   while (...) clusterer.addColumn(returns, lasers);       // upon reception of step s
///   clusterer.update();                                     // upon all steps processed, or before
///   clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t head) { ... });
///
/// Returns that lie within eps of each other belong to the same subcluster, which is named by its head.
/// update() makes the subclusters exact for all columns added so far; more columns may follow it.
///
/// From the smallest unit to the largest: a *run* is a chain of neighbours that one laser returned within one
/// block of columns; a *subcluster* is a set of runs. Far returns are compared one by one (ViewStrip). Near ones are
/// compared by patches: a *patch* is a connected group of *pieces* of runs within one tile of the mask. It stays open
/// to new pieces for a while; then it is closed and compared once with all patches before it that its mask shows
/// (the half mask of the paper).
///
/// Nothing is allocated once the buffers have grown to the largest rotation seen. Not thread safe; any number
/// of instances may work side by side.
class ColumnClusterer {
 public:
  ColumnClusterer();

  /// Starts a new rotation and forgets the last one.
  void begin(const Parameters& parameters);

  /// Event "reception of step s": cells[l] is what laser l measured; cells that are no returns are skipped.
  /// \param lasers number of cells, may differ from column to column; the order of the lasers is free, but must stay
  ///        the same for speed.
  void addColumn(const Return* cells, std::size_t lasers) {
    addColumns(1, lasers, [cells](std::size_t laser, std::size_t) { return cells[laser]; });
  }

  /// Adds several columns at once, in the order of their numbers, read laser by laser as an organized cloud lies in
  /// memory. The outcome is the same as by addColumn.
  /// \param cell_at callable as Return (std::size_t laser, std::size_t column), column in 0..columns-1
  template <typename CellAt>
  void addColumns(std::size_t columns, std::size_t lasers, CellAt&& cell_at);

  /// Event "all steps processed", or a look in between: brings the subclusters up to date with all columns added.
  void update();

  /// Calls visit(source_indices, count, head) for all returns, in groups of the same subcluster. Call update()
  /// first.
  template <typename Visit>
  void forEachRun(Visit&& visit);

  /// Number of returns in the subcluster with this head (as given by forEachRun).
  std::uint32_t weight(std::uint32_t head) const { return subclusters_.weight(head); }

  /// Heads lie in 0..headLimit()-1.
  std::size_t headLimit() const { return subclusters_.size(); }

  /// Number of returns read so far.
  std::size_t returnCount() const { return source_index_.size(); }

  /// How often two patches were held against each other so far: what the mask costs.
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  static constexpr std::size_t kMostBlockColumns = ViewStrip::kMostInRow;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Run {
    std::uint32_t first_return;  ///< its returns follow each other
    std::uint32_t count;
  };
  /// A run's part in one tile.
  struct Piece {
    Box box;
    std::uint32_t first_return;
    std::uint32_t count;
    std::uint32_t next_in_patch;
    std::uint32_t run;
  };
  struct Patch {
    Box box;
    std::uint32_t next_in_tile;  ///< an older patch
    std::uint32_t tile;
    std::uint32_t first_piece, last_piece;
    std::uint32_t run;  ///< one of its runs
  };
  /// What a tile of the mask holds. Numbers are kept with the rotation's stamp added, so that what earlier
  /// rotations left behind is recognized by being smaller and the tiles need no emptying.
  struct Tile {
    std::uint32_t newest_open = 0;   ///< a patch; it and those behind it are open if >= first_open_patch_
    std::uint32_t newest_shelf = 0;  ///< of closed patches
  };
  /// Returns of one laser that wait for their block to be complete.
  struct StagedRow {
    float x[kMostBlockColumns], y[kMostBlockColumns], z[kMostBlockColumns];
    std::uint32_t source_index[kMostBlockColumns];
    std::uint32_t column[kMostBlockColumns];  ///< counted from the first of the rotation
    std::size_t count = 0;
  };

  std::uint32_t unstamped(std::uint32_t number) const { return number >= stamp_ ? number - stamp_ : kNone; }
  void clusterBlock();
  template <typename Mask>
  void readRow(const Mask& mask, const StagedRow& row, std::size_t laser);
  template <typename Mask>
  void cutIntoPieces(const Mask& mask, const StagedRow& row, std::uint32_t first_return, const std::uint32_t* run,
                     std::uint64_t wanted);
  void placePiece(std::uint32_t piece, std::uint32_t tile);
  template <typename Mask>
  void closePatches(const Mask& mask, std::uint32_t end);
  template <typename Mask>
  void cluster(const Mask& mask, std::uint32_t patch);
  void shelve(std::uint32_t patch);
  bool neighbours(const Patch& a, const Patch& b) const;
  bool neighbours(const Piece& a, const Piece& b) const;
  static std::uint32_t mergeRuns(void* clusterer, std::uint32_t a, std::uint32_t b);

  Parameters parameters_;
  Tolerance tolerance_;
  std::variant<GridMask, ViewMask> mask_;

  std::vector<StagedRow> staged_;
  std::size_t staged_columns_ = 0;
  std::uint32_t column_ = 0;  ///< number of columns added

  std::vector<float> x_, y_, z_;  ///< all returns, run by run
  std::vector<std::uint32_t> source_index_;
  std::vector<Run> runs_;
  DisjointSets subclusters_;   ///< of runs
  ViewStrip strip_;            ///< far returns
  std::vector<Piece> pieces_;  ///< of all others
  std::vector<Patch> patches_;
  std::vector<Tile> tiles_;
  std::uint32_t stamp_ = 0;
  std::vector<Shelf> shelves_;
  std::uint32_t first_open_patch_ = 0;  ///< patches from here on are still open
  std::uint32_t young_patch_ = 0;       ///< patches from here on were opened during young_columns_
  std::size_t young_columns_ = 0;
  std::uint64_t comparisons_ = 0;
};

template <typename CellAt>
void ColumnClusterer::addColumns(std::size_t columns, std::size_t lasers, CellAt&& cell_at) {
  if (staged_.size() < lasers) staged_.resize(lasers);
  for (std::size_t first = 0; first < columns;) {
    const std::size_t count = std::min(columns - first, parameters_.block_columns - staged_columns_);
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      StagedRow& row = staged_[laser];
      std::size_t n = row.count;
      for (std::size_t column = first; column < first + count; ++column) {
        const Return cell = cell_at(laser, column);
        row.x[n] = cell.x;
        row.y[n] = cell.y;
        row.z[n] = cell.z;
        row.source_index[n] = cell.source_index;
        row.column[n] = column_ + static_cast<std::uint32_t>(column - first);
        n += isReturn(cell.x, cell.y, cell.z) ? 1 : 0;
      }
      row.count = n;
    }
    first += count;
    column_ += static_cast<std::uint32_t>(count);
    staged_columns_ += count;
    if (staged_columns_ == parameters_.block_columns) clusterBlock();
  }
}

template <typename Visit>
void ColumnClusterer::forEachRun(Visit&& visit) {
  for (std::size_t run = 0; run < runs_.size(); ++run)
    visit(source_index_.data() + runs_[run].first_return, static_cast<std::size_t>(runs_[run].count),
          subclusters_.head(static_cast<std::uint32_t>(run)));
}

}  // namespace lisco
