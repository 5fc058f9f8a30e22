// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <memory>

#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco {

struct Parameters;

/// Lisco: Euclidean clustering of a rotating LiDAR's returns, column by column (Algorithms 3 and 4 of the paper).
///
///   lisco::ColumnClusterer clusterer;
///   clusterer.begin({0.4F});                                // eps = 0.4 m
///   while (...) clusterer.addColumn(returns, lasers);       // upon reception of step s
///   clusterer.update();                                     // upon all steps processed, or before
///   clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
///     ...
///   });
///
/// Returns that lie within eps of each other belong to the same subcluster. update() makes the subclusters exact for
/// all columns added so far; more columns may follow it.
///
/// Nothing is allocated once the buffers have grown to the largest rotation seen (with several threads, whose parts
/// change with the scene, to the largest parts), except when the engine changes how it reads rotations that come at
/// once: after three for which range images took longer, the next ones are read without (doc/algorithm.md, FarHistory).
/// Not thread safe; any number may be used.
class LISCO_EXPORT ColumnClusterer {
 public:
  ColumnClusterer();
  ~ColumnClusterer();
  ColumnClusterer(const ColumnClusterer& other);             ///< a copy goes on from the same column
  ColumnClusterer& operator=(const ColumnClusterer& other);  ///< the same

  /// Starts a new rotation and forgets the last one. An exception of addColumn (), addColumns () or update () that is
  /// not listed there (refused memory, throwing `cells`) ends the rotation: until begin (), the first two throw
  /// std::logic_error, update () and forEachRun () do nothing, and numbers and sizes are undefined. An exception of a
  /// visit changes nothing.
  void begin(const Parameters& parameters);

  /// Event "reception of step s".
  /// \param cells cells[l] is what laser l measured; those that are no returns are skipped
  /// \param lasers number of cells, may differ from column to column; in any order, for speed the same in each column
  /// \throws std::logic_error before begin(); std::invalid_argument if there are more cells than Parameters::lasers,
  ///         or more than kMaxCells since begin()
  void addColumn(const Return* cells, std::size_t lasers);

  /// Adds several columns at once, read laser by laser as an organized cloud lies in memory. The result is that of
  /// addColumn.
  /// \param cells callable as Return (std::size_t laser, std::size_t column), column in 0..columns-1, or block by block
  ///        as CellSource has it; may be called several times for a cell, and by several threads at once if
  ///        Parameters::threads allows it
  /// \throws as addColumn
  template <typename Cells>
  void addColumns(std::size_t columns, std::size_t lasers, Cells&& cells) {
    receive(columns, lasers, CellSource(cells));
  }

  /// Event "all steps processed", or at any time before: brings the subclusters up to date with all columns added.
  void update();

  std::size_t subclusterCount() const;  ///< after update()
  /// Number of returns in a subcluster, 0..subclusterCount()-1; after update().
  std::uint32_t sizeOf(std::uint32_t subcluster) const { return sizes()[subcluster]; }
  const std::uint32_t* sizes() const;  ///< of all subclusters; after update(), until the next call of another function

  static constexpr std::size_t kMaxCells = (std::size_t{1} << 31) - 1;  ///< of a rotation
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};             ///< no subcluster
  /// The subcluster of what a laser measured in a column, kNone if that was no return; after update().
  /// \param column counted from begin()
  std::uint32_t subclusterAt(std::size_t laser, std::size_t column);

  /// Calls visit(source_indices, count, subcluster) for all returns, in groups of the same subcluster, of one laser and
  /// of consecutive columns: laser by laser, and the returns of each in the order of their columns. After update().
  /// Or calls visit(laser, column, count, subcluster), with the place of the first return: column counted from begin().
  /// See RunVisitor for visits of several groups of one return each at once.
  /// \param sizes groups of subclusters of other sizes may be left out, which saves time where these are many
  /// \throws std::logic_error if visit takes source indices and Parameters::keep_source_indices is false
  template <typename Visit>
  void forEachRun(Visit&& visit, const SizeRange& sizes = {}) {
    const RunVisitor::WithoutFrom<Visit> visit_run{visit};
    visitRuns(RunVisitor(visit_run), sizes, false);
  }

  /// The same by two threads at once, which meet in the middle: calls visit(from, source_indices, count, subcluster)
  /// or visit(from, laser, column, count, subcluster), one with RunVisitor::From::kFirst from the first group on, the
  /// other with kLast from the last group backwards.
  template <typename Visit>
  void forEachRunFromBothEnds(Visit&& visit, const SizeRange& sizes = {}) {
    visitRuns(RunVisitor(visit), sizes, true);
  }

  /// Number of threads that share the columns of the last rotation; 1 if there are few columns.
  std::size_t threadCount() const;

  std::size_t returnCount() const;  ///< read so far; of all columns added, after update()

 private:
  void receive(std::size_t columns, std::size_t lasers, const CellSource& cells);
  void visitRuns(const RunVisitor& visit, const SizeRange& sizes, bool from_both_ends);

  class LISCO_HIDDEN Rotation;
  std::unique_ptr<Rotation> rotation_;
};

/// How a rotation is clustered. Only the tolerance changes the result.
struct Parameters {
  /// eps, metres. A negative value acts as its absolute value; 0 and NaN make no two returns neighbours; an infinite
  /// one makes all returns neighbours whose squared distance does not overflow a float.
  float tolerance = 0.0F;
  SensorHints sensor;                    ///< what is known of the sensor
  std::size_t expected_returns = 65536;  ///< for which memory is reserved; more may come
  std::size_t lasers = 0;                ///< largest number of cells of a column; 0: any number
  /// Columns read together, 1..64. With 64 the work is least, since the returns of a laser lie side by side in memory;
  /// it is spread over the columns of the next blocks. With 1 each column is read at once, and compared with the others
  /// during the next ones. Other values are clamped. Does not affect results: update() covers every column added.
  std::size_t block_columns = 64;
  /// Threads that share the work of the first addColumns () after begin (), which should bring a whole rotation, and of
  /// the update () after it; 0: one for each core. No more are used than kMaxThreads, nor more than one for 64 columns;
  /// more than cores take longer. Columns that come one by one, or after these, are the work of one thread.
  std::size_t threads = 1;
  /// False: forEachRun () gives the places of returns only, which takes less memory and time.
  bool keep_source_indices = true;

  static constexpr std::size_t kMaxThreads = 256;  ///< of a rotation
};

}  // namespace lisco
