// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/column_block.h"
#include "lisco/column_shares.h"
#include "lisco/disjoint_sets.h"
#include "lisco/export.h"
#include "lisco/pace.h"
#include "lisco/parallel.h"
#include "lisco/return.h"
#include "lisco/row.h"
#include "lisco/runs.h"
#include "lisco/tolerance.h"
#include "lisco/view_hints.h"
#include "lisco/view_strip.h"
#include "lisco/voxels.h"

namespace lisco {

/// How a rotation is to be clustered. Only the tolerance changes the result.
struct Parameters {
  float tolerance = 0.0F;                ///< eps, metres; see Tolerance for 0, negative, NaN and infinite values
  ViewHints view;                        ///< what is known of the sensor
  std::size_t expected_returns = 65536;  ///< to reserve memory; more are welcome
  std::size_t lasers = 0;                ///< most cells of a column; 0: any number
  /// How many columns are read together, 1..64. Whoever asks for the subclusters gets them for all columns
  /// added, so it is not seen from outside: 64 is the fastest, since the returns of a laser lie side by side in a
  /// cloud's memory; 1 does the work of each column at once. The work of a block is spread over the columns of the next
  /// one, so that no column takes much longer than others.
  std::size_t block_columns = Row::kColumns;
  /// How many threads share the work of the first addColumns () after begin (), which should bring a whole rotation, and of
  /// the update () after it; 0: one for each core. Columns that come one by one, or after these, are the work of one thread.
  std::size_t threads = 1;
};

/// Lisco: Euclidean clustering of a rotating LiDAR's returns, column by column (Algorithms 3 and 4 of the paper).
///
///   lisco::ColumnClusterer clusterer;
///   clusterer.begin({0.4F});                                // eps = 0.4 m
///   while (...) clusterer.addColumn(returns, lasers);       // upon reception of step s
///   clusterer.update();                                     // upon all steps processed, or before
///   clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) { ... });
///
/// Returns that lie within eps of each other belong to the same subcluster. update() makes the subclusters exact for
/// all columns added so far; more columns may follow it.
///
/// A *run* is a chain of neighbours that one laser returned within one block of columns; a *subcluster* is a set of
/// runs. Far returns find their neighbours in the sensor's view (ViewStrip), near ones in space (Voxels).
///
/// Nothing is allocated once the buffers have grown to the largest rotation seen (with several threads, whose shares change
/// with the scene, to the largest shares). Not thread safe; any number
/// of instances may work side by side.
class LISCO_EXPORT ColumnClusterer {
 public:
  /// Starts a new rotation and forgets the last one. After an exception that is not about the arguments (memory was
  /// refused, or a callback threw), this is the only call that is of use.
  void begin(const Parameters& parameters);

  /// Event "reception of step s": cells[l] is what laser l measured; cells that are no returns are skipped.
  /// \param lasers number of cells, may differ from column to column; the order of the lasers is free, but must stay
  ///        the same for speed.
  /// \throws std::logic_error before begin(); std::invalid_argument if there are more cells than lasers
  void addColumn(const Return* cells, std::size_t lasers) {
    addColumns(1, lasers, [cells](std::size_t laser, std::size_t) { return cells[laser]; });
  }

  /// Adds several columns at once, in the order of their numbers, read laser by laser as an organized cloud lies in
  /// memory. The outcome is the same as by addColumn.
  /// \param cell_at callable as Return (std::size_t laser, std::size_t column), column in 0..columns-1; by several
  ///        threads at once if the parameters say so
  template <typename CellAt>
  void addColumns(std::size_t columns, std::size_t lasers, CellAt&& cell_at);

  /// Event "all steps processed", or a look in between: brings the subclusters up to date with all columns added.
  void update();

  /// Number of subclusters, after update().
  std::size_t subclusterCount() const { return subcluster_sizes_.size(); }
  /// Number of returns in a subcluster, after update().
  /// \param subcluster 0..subclusterCount()-1
  std::uint32_t sizeOf(std::uint32_t subcluster) const { return subcluster_sizes_[subcluster]; }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  ///< no subcluster
  /// The subcluster of what a laser measured in a column, kNone if that was no return; after update().
  /// \param column counted from begin()
  std::uint32_t subclusterAt(std::size_t laser, std::size_t column);

  /// Calls visit(source_indices, count, subcluster) for all returns, in groups of the same subcluster, of one laser and of
  /// columns side by side: laser by laser, and the returns of each in the order of their columns. Call update() first.
  template <typename Visit>
  void forEachRun(Visit&& visit);

  /// Number of returns read so far.
  std::size_t returnCount() const;

 private:
  /// What one thread has read: some columns, of which it knows all but what they have to do with others.
  struct Reading {
    std::size_t first_column = 0, end_column = 0;  ///< its share of what is read in parallel
    std::uint32_t first_element = 0;               ///< run i is element first_element + i
    Runs runs;
    ViewStrip strip;  ///< far returns
    Voxels voxels;    ///< near ones
    Row row{};
    MeasuredRow measured{};
  };
  class VoxelJoiner;

  void stagedBlockIsComplete();
  void workOnPending(std::size_t columns);
  void readPending(std::size_t columns);
  void finishPending();
  template <typename CellAt>
  void readColumns(Reading& reading, std::uint32_t column, std::size_t first, std::size_t count, std::size_t lasers,
                   CellAt&& cell_at);
  void readRow(Reading& reading, Row& row, std::size_t laser, std::uint32_t first_column, std::size_t columns);
  void linkAll();
  void linkReadings(Reading& later, Reading& earlier);
  void orderRows();
  void checkColumns(std::size_t lasers) const;
  bool isWorthThreads(std::size_t columns, std::size_t lasers) const;
  static constexpr std::size_t kWorkOfCell = 2;    ///< of reading it, in the strip's units
  static constexpr std::size_t kWorkOfReturn = 2;  ///< more than of a cell alone
  static std::size_t workOf(const Reading& reading) {
    return reading.strip.work() + kWorkOfReturn * reading.runs.returns;
  }
  template <typename CellAt>
  void startReading(std::size_t columns, std::size_t lasers, CellAt&& cell_at);
  template <typename CellAt>
  void readInParallel(std::size_t lasers, CellAt&& cell_at);
  void readAlone();
  void prepareReading(Reading& reading);
  /// What reads the columns that come one by one.
  Reading& lastReading() { return readings_[threads_ - 1]; }

  Parameters parameters_;
  bool begun_ = false;  ///< and left by no exception since
  Tolerance tolerance_;
  DisjointSets subclusters_;       ///< of runs
  std::vector<Reading> readings_;  ///< one for each thread
  std::size_t threads_ = 0;        ///< that have read
  ColumnShares shares_;            ///< of what threads read
  bool are_linked_ = false;        ///< their readings, with each other
  ColumnBlock staged_;             ///< columns that wait for their block to be complete
  ColumnBlock pending_;            ///< a complete block, read while the next one is staged
  std::size_t pending_laser_ = 0;  ///< whose row is the next to be read
  std::size_t columns_since_block_ = 0;
  Pace pace_;                 ///< of linking
  std::uint32_t column_ = 0;  ///< number of columns added
  std::vector<std::uint32_t> subcluster_sizes_;
  LaserOrder order_;
  bool is_ordered_ = false;  ///< since the last update()
};

template <typename CellAt>
void ColumnClusterer::addColumns(std::size_t columns, std::size_t lasers, CellAt&& cell_at) {
  checkColumns(lasers);
  if (columns == 0) return;
  begun_ = false;  // unless nothing is thrown
  if (threads_ == 0) {
    startReading(columns, lasers, cell_at);
    if (threads_ > 1) {
      readInParallel(lasers, cell_at);
      column_ = static_cast<std::uint32_t>(columns);
      begun_ = true;
      return;
    }
  }
  constexpr std::size_t kWorthReadingAtOnce = 16;
  Reading& reading = lastReading();
  if (reading.strip.inUse()) reading.strip.addLasers(lasers);
  for (std::size_t first = 0; first < columns;) {
    const std::size_t count = std::min(columns - first, parameters_.block_columns - staged_.columns());
    if (count == parameters_.block_columns || (staged_.columns() == 0 && count >= kWorthReadingAtOnce)) {
      finishPending();
      readColumns(reading, column_, first, count, lasers, cell_at);
      column_ += static_cast<std::uint32_t>(count);
    } else {
      staged_.add(first, count, lasers, cell_at);
      if (staged_.columns() == parameters_.block_columns) stagedBlockIsComplete();
      workOnPending(count);
    }
    first += count;
  }
  begun_ = true;
}

/// Decides how many threads read, and what.
template <typename CellAt>
void ColumnClusterer::startReading(std::size_t columns, std::size_t lasers, CellAt&& cell_at) {
  std::size_t threads = 1;
  if (isWorthThreads(columns, lasers)) {
    shares_.prepare(columns, lasers, cell_at);
    threads = shares_.shares(parameters_.threads);
  }
  if (threads == 1) return readAlone();
  threads_ = threads;
  shares_.cut(threads, [&](std::size_t thread, std::size_t first_column, std::size_t end_column) {
    readings_[thread].first_column = first_column;
    readings_[thread].end_column = end_column;
    readings_[thread].first_element = static_cast<std::uint32_t>(lasers * first_column);  // a run for each cell
  });
}

/// Each thread reads its columns, and links them as far as it goes without the others.
template <typename CellAt>
void ColumnClusterer::readInParallel(std::size_t lasers, CellAt&& cell_at) {
  subclusters_.reset(lasers * readings_[threads_ - 1].end_column + Row::kColumns);
  inParallel(threads_, [&](std::size_t thread) {
    Reading& reading = readings_[thread];
    prepareReading(reading);
    if (reading.strip.inUse()) reading.strip.addLasers(lasers);
    for (std::size_t first = reading.first_column; first < reading.end_column; first += Row::kColumns) {
      const std::size_t count = std::min(reading.end_column - first, Row::kColumns);
      const std::size_t before = workOf(reading);
      readColumns(reading, static_cast<std::uint32_t>(first), first, count, lasers, cell_at);
      shares_.weigh(first, count, count * lasers * kWorkOfCell + workOf(reading) - before);
    }
  });
}

/// Reads so many columns at once, and links what they complete.
/// \param column the first one's number, of the rotation
/// \param first the first one's number, of what cell_at knows
template <typename CellAt>
void ColumnClusterer::readColumns(Reading& reading, std::uint32_t column, std::size_t first, std::size_t count,
                                  std::size_t lasers, CellAt&& cell_at) {
  for (std::size_t laser = 0; laser < lasers; ++laser) {
    ColumnBlock::fill(reading.row, 0, laser, first, count, cell_at);
    readRow(reading, reading.row, laser, column, count);
  }
  reading.strip.link(subclusters_);
}

template <typename Visit>
void ColumnClusterer::forEachRun(Visit&& visit) {
  if (!begun_) return;
  orderRows();
  order_.forEachRun([this](std::size_t thread) -> const Runs& { return readings_[thread].runs; },
                    [&](std::size_t, const Runs& runs, const Runs::Run& run) {
                      visit(runs.source_index.data() + run.first_cell, static_cast<std::size_t>(run.count),
                            run.subcluster);
                    });
}

}  // namespace lisco
