// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>

namespace lisco {

/// One cell of a column: what one laser measured in one step of the rotation (the paper's section II-A), in
/// Cartesian coordinates.
struct Return {
  float x;                     ///< metres, in the cloud's own frame
  float y;                     ///< the same
  float z;                     ///< the same
  std::uint32_t source_index;  ///< the caller's number for this cell, handed back with its subcluster
};

/// A cell without a return (the paper's d = 0).
inline constexpr Return kNoReturn{0.0F, 0.0F, 0.0F, 0U};

/// Whether a cell holds a return: all coordinates finite, and not exactly (0, 0, 0), which is the paper's d = 0 and
/// what many drivers write where nothing came back.
inline bool isReturn(float x, float y, float z) {
  constexpr float kMax = std::numeric_limits<float>::max();
  const bool finite = std::fabs(x) <= kMax && std::fabs(y) <= kMax && std::fabs(z) <= kMax;
  return finite && !(x == 0.0F && y == 0.0F && z == 0.0F);
}

/// Cells of lasers and columns, read by one function call per laser and block of columns. Keeps a reference to the
/// callable, which must outlive it.
class CellSource {
 public:
  /// Coordinates and source indices of consecutive cells of one laser: arrays that overlap neither each other nor what
  /// the cells are read from.
  struct Destination {
    float* x;                     ///< metres
    float* y;                     ///< the same
    float* z;                     ///< the same
    std::uint32_t* source_index;  ///< see Return
  };

  /// \param cells callable as Return (std::size_t laser, std::size_t column), or, which reads a whole block, as
  ///        void (std::size_t laser, std::size_t first, std::size_t count, const Destination& to); by several threads
  ///        at once where the function that takes it says so
  template <typename Cells>
  explicit CellSource(Cells& cells) : context_(std::addressof(cells)), read_(&readFrom<Cells>) {}

  /// Reads `count` cells of a laser from column `first` on.
  void read(std::size_t laser, std::size_t first, std::size_t count, const Destination& to) const {
    read_(context_, laser, first, count, to);
  }

  /// Reads one cell.
  Return at(std::size_t laser, std::size_t column) const {
    Return cell;
    read(laser, column, 1, {&cell.x, &cell.y, &cell.z, &cell.source_index});
    return cell;
  }

 private:
  // Without overlaps, compilers vectorize this loop.
  template <typename Cells>
  static void readEach(Cells& cells, std::size_t laser, std::size_t first, std::size_t count, float* __restrict x,
                       float* __restrict y, float* __restrict z, std::uint32_t* __restrict source_index) {
    for (std::size_t i = 0; i < count; ++i) {
      const Return cell = cells(laser, first + i);
      x[i] = cell.x;
      y[i] = cell.y;
      z[i] = cell.z;
      source_index[i] = cell.source_index;
    }
  }
  template <typename Cells>
  static void readFrom(const void* context, std::size_t laser, std::size_t first, std::size_t count,
                       const Destination& to) {
    Cells& cells = *static_cast<Cells*>(const_cast<void*>(context));
    if constexpr (std::is_invocable_v<Cells&, std::size_t, std::size_t, std::size_t, const Destination&>) {
      cells(laser, first, count, to);
    } else {
      readEach(cells, laser, first, count, to.x, to.y, to.z, to.source_index);
    }
  }

  const void* context_;
  void (*read_)(const void* context, std::size_t laser, std::size_t first, std::size_t count, const Destination& to);
};

/// Sizes of subclusters, in returns.
struct SizeRange {
  std::uint32_t min = 0;                                          ///< the least
  std::uint32_t max = std::numeric_limits<std::uint32_t>::max();  ///< the largest
};

/// Returns of one subcluster, one laser and consecutive columns.
struct Run {
  std::uint32_t first_cell;  ///< of its cells, in the order in which they were read
  std::uint32_t count;       ///< number of returns
  std::uint32_t subcluster;  ///< 0..subclusterCount ()-1
};

/// The runs of a laser in a block of columns.
struct RunBlock {
  const Run* runs;                      ///< `count` of them, by column
  std::size_t count;                    ///< of runs
  std::uint32_t laser;                  ///< 0, 1, ...
  std::uint32_t first_column;           ///< of the block, 0, 1, ...
  std::uint32_t first_cell;             ///< that of first_column
  const std::uint32_t* source_indices;  ///< by Run::first_cell; nullptr: they are not kept

  /// The column of a run's first return.
  std::uint32_t columnOf(const Run& run) const { return first_column + (run.first_cell - first_cell); }
};

/// The runs of a laser in a block of columns, if each is of one return.
struct SingleRunBlock {
  const std::uint32_t* subclusters;     ///< of each, by column
  std::size_t count;                    ///< of runs
  std::uint32_t laser;                  ///< 0, 1, ...
  const std::uint32_t* columns;         ///< of each; only where RunVisitor::takesPlaces ()
  const std::uint32_t* source_indices;  ///< of each; only elsewhere
};

/// Receives runs laser by laser, from the first on or from the last backwards: one function call per laser and block of
/// columns. Keeps a reference to the callable, which must outlive it.
class RunVisitor {
 public:
  /// Where a visit begins.
  enum class From { kFirst, kLast };

  /// \param visit callable as one of
  ///          void (From, const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster)
  ///          void (From, std::uint32_t laser, std::uint32_t column, std::size_t count, std::uint32_t subcluster)
  ///        where `column` is that of the run's first return; and, optional, for several runs of one return each, as
  ///          void (From, const std::uint32_t* source_indices, std::size_t count, const std::uint32_t* subclusters)
  ///          void (From, std::uint32_t laser, const std::uint32_t* columns, std::size_t count,
  ///                const std::uint32_t* subclusters)
  ///        whose arrays are in the order of the columns: with From::kLast, visit them from the last element backwards
  template <typename Visit>
  explicit RunVisitor(Visit& visit)
      : context_(std::addressof(visit)),
        takes_places_(kTakesPlaces<Visit>),
        visit_([](const void* context, From from, const RunBlock& block) {
          Visit& visit_run = *static_cast<Visit*>(const_cast<void*>(context));
          forEach(from, block.count, [&](std::size_t i) {
            const Run& run = block.runs[i];
            if constexpr (kTakesPlaces<Visit>)
              visit_run(from, block.laser, block.columnOf(run), std::size_t{run.count}, run.subcluster);
            else
              visit_run(from, block.source_indices + run.first_cell, std::size_t{run.count}, run.subcluster);
          });
        }),
        visit_single_([](const void* context, From from, const SingleRunBlock& block) {
          Visit& visit_run = *static_cast<Visit*>(const_cast<void*>(context));
          constexpr std::size_t kOne = 1;
          if constexpr (std::is_invocable_v<Visit&, From, std::uint32_t, Words, std::size_t, Words>)
            visit_run(from, block.laser, block.columns, block.count, block.subclusters);
          else if constexpr (std::is_invocable_v<Visit&, From, Words, std::size_t, Words>)
            visit_run(from, block.source_indices, block.count, block.subclusters);
          else if constexpr (kTakesPlaces<Visit>)
            forEach(from, block.count,
                    [&](std::size_t i) { visit_run(from, block.laser, block.columns[i], kOne, block.subclusters[i]); });
          else
            forEach(from, block.count,
                    [&](std::size_t i) { visit_run(from, block.source_indices + i, kOne, block.subclusters[i]); });
        }) {}

  /// A visit, as RunVisitor takes it, that leaves out From.
  /// \tparam Visit callable as RunVisitor's, without its first argument
  template <typename Visit>
  struct WithoutFrom {
    Visit& visit;  ///< which is called

    /// Visits a run, or several at once: whatever `visit` takes.
    template <typename... Arguments, typename = std::enable_if_t<std::is_invocable_v<Visit&, const Arguments&...>>>
    void operator()(From, const Arguments&... arguments) const {
      visit(arguments...);
    }
  };

  /// Whether it receives places instead of source indices.
  bool takesPlaces() const { return takes_places_; }

  /// Visits runs. Only one that takes places may be called without source indices.
  void operator()(From from, const RunBlock& block) const { visit_(context_, from, block); }
  /// Visits runs of one return each.
  void operator()(From from, const SingleRunBlock& block) const { visit_single_(context_, from, block); }

 private:
  using Words = const std::uint32_t*;
  template <typename Visit>
  static constexpr bool kTakesPlaces =
      std::is_invocable_v<Visit&, From, std::uint32_t, std::uint32_t, std::size_t, std::uint32_t>;

  template <typename VisitAt>
  static void forEach(From from, std::size_t count, VisitAt&& visit_at) {
    if (from == From::kFirst)
      for (std::size_t i = 0; i < count; ++i) visit_at(i);
    else
      for (std::size_t i = count; i-- > 0;) visit_at(i);
  }

  const void* context_;
  bool takes_places_;
  void (*visit_)(const void* context, From from, const RunBlock& block);
  void (*visit_single_)(const void* context, From from, const SingleRunBlock& block);
};

}  // namespace lisco
