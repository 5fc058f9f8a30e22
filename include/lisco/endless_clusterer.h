// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lisco/column_block.h"
#include "lisco/export.h"
#include "lisco/pane.h"
#include "lisco/return.h"
#include "lisco/tolerance.h"

namespace lisco {

class EndlessCluster;

/// How a stream without end is to be clustered. Positions are in turns of the sensor since any moment.
struct EndlessParameters {
  float tolerance = 0.0F;                  ///< eps, metres; see Tolerance for 0, negative, NaN and infinite values
  std::size_t min_size = 1;                ///< as max_size
  std::size_t max_size = ~std::size_t{0};  ///< clusters of fewer or more returns are not delivered
  std::array<float, 3> origin{};           ///< where the sensor stands, metres
  bool clockwise = false;                  ///< how the sensor turns, seen from above
  double start_azimuth = 0;                ///< of position 0, radians, counter-clockwise from the x axis
  /// Radians: no return's azimuth differs by more from that of its column; at most kMostStagger. Clusters are
  /// delivered the later, the larger it is. Returns that differ by more are *astray*: each is a cluster of its own.
  double stagger = kMostStagger;
  double columns_per_turn = 0;     ///< for addColumn () without a position; 0: there must be one
  std::size_t lasers = 0;          ///< most cells of a column; 0: any number
  std::size_t block_columns = 16;  ///< how many columns are read together, 1..64; at 1, clusters are delivered soonest

  static constexpr double kMostStagger = 0.39269908169872414;  ///< a sixteenth of a turn
};

/// Clusters of a stream that never ends: each is delivered once, as soon as no later column can reach it, whole across the
/// borders of rotations.
///
/// The turn is divided into eighths, by position. Two returns are neighbours if they lie within eps of each other, in the
/// same eighth or in eighths that are at most three apart (so always less than half a turn), and neither is astray. So
/// no column can reach a return of eighth n, horizontally rho from the sensor, whose position is at least
///
///   reach end = min (position + (asin (eps / rho) + 2 stagger) / 2 pi, (n + 4) / 8)
///
/// and for rho <= eps, (n + 4) / 8. When a column comes that is at or beyond the reach end of all returns of a cluster, it
/// is delivered. A cluster that began in eighth n and is still open when the first column of eighth n + 8 or later comes is
/// delivered then, *cut*: its returns have no neighbours from there on, and clusters that would otherwise have been joined
/// to it are *continued*. doc/streaming.md says more.
///
/// Memory is bounded by the returns of two turns; nothing is allocated once the buffers have grown. Not thread safe; any
/// number of instances may work side by side.
class LISCO_EXPORT EndlessClusterer {
 public:
  /// Receives a cluster, which is valid during the call. Must not call the clusterer.
  using Callback = std::function<void(const EndlessCluster&)>;

  /// Starts a new stream; of the last one, nothing more is delivered. After an exception that is not about the arguments (memory
  /// was refused, or a callback threw), this is the only call that is of use.
  /// \throws std::invalid_argument if the stagger is not within 0..kMostStagger
  void begin(const EndlessParameters& parameters, Callback callback);

  /// Takes the next column.
  /// \param cells cells[l] is what laser l measured; those that are no returns are skipped. Source indices are handed
  ///        back within the next turn and a half.
  /// \param position turns, never less than the one before
  /// \throws std::logic_error before begin (); std::invalid_argument if there are more cells than lasers, or the position
  ///         is less than the one before or not finite
  void addColumn(const Return* cells, std::size_t lasers, double position);
  /// The same, 1 / columns_per_turn after the one before.
  /// \throws std::logic_error if that is not known
  void addColumn(const Return* cells, std::size_t lasers);

  /// Delivers what can be delivered with the columns added so far, without waiting for the block to be complete.
  void update();

  /// The stream has ended: delivers all. More columns may follow; they have nothing to do with those before.
  void finish();

  std::uint64_t returnCount() const { return returns_; }  ///< since begin (); update () counts all
  std::uint64_t strayCount() const { return strays_; }    ///< of these, astray
  /// Returns in memory: of the open clusters and of delivered ones that are not yet forgotten.
  std::size_t returnsHeld() const;

 private:
  friend class EndlessCluster;
  /// A run: its pane's slot, and its number there.
  using Element = std::uint32_t;
  static constexpr int kNumberBits = 28;
  static constexpr std::int64_t kTurn = 8;        ///< panes: eighths of a turn
  static constexpr std::int64_t kComparable = 4;  ///< panes whose returns may be neighbours
  static constexpr std::int64_t kSlots = 16;      ///< panes in memory: more than a cluster and its neighbours span
  static constexpr Element kNone = ~Element{0};

  /// What is known of a cluster, at its head; and the chain of its runs.
  struct Set {
    Element parent;
    Element next_run;
    Element last_run;
    std::uint32_t size;
    double reach_end;
    double first_position, last_position;
    std::int64_t first_pane;
    bool delivered, cut, continued;
  };
  struct EndlessPane : Pane {
    std::int64_t number = 0;
    bool in_use = false;
    std::vector<Set> sets;  ///< one for each run
    std::vector<DisjointSets::Merge> merges;
  };
  /// A cluster that waits for its delivery; perhaps joined to another one, or grown, since.
  struct Waiting {
    double reach_end;
    Element head;
    bool operator<(const Waiting& other) const {
      return reach_end > other.reach_end;
    }  // the first is the top of a heap
  };
  class PaneJoiner;

  Element elementOf(std::int64_t pane, std::uint32_t run) const {
    return static_cast<Element>(pane & (kSlots - 1)) << kNumberBits | run;
  }
  EndlessPane& paneOf(Element element) { return panes_[element >> kNumberBits]; }
  const EndlessPane& paneOf(Element element) const { return panes_[element >> kNumberBits]; }
  static std::uint32_t runOf(Element element) { return element & ((Element{1} << kNumberBits) - 1); }
  Set& set(Element element) { return paneOf(element).sets[runOf(element)]; }
  EndlessPane& pane(std::int64_t number) { return panes_[static_cast<std::size_t>(number & (kSlots - 1))]; }

  void startPane(std::int64_t number, double position);
  void workOnBlock();
  void readBlock();
  std::uint64_t findStrays(const Row& row, const MeasuredRow& measured) const;
  void createSets(EndlessPane& pane, const MeasuredRow& measured, std::uint64_t strays);
  double reachEnd(double position, double rho, double known) const;
  void replayMerges(EndlessPane& pane);
  Element head(Element element);
  void merge(Element a, Element b);
  void wait(Element head);
  void deliverUpTo(double position);
  void deliver(Element head);

  EndlessParameters parameters_;
  Callback callback_;
  Tolerance tolerance_;
  FarRange range_;         ///< only its origin counts
  float cos_stagger_ = 0;  ///< a little less, so that rounding leads nobody astray
  double turns_of_stagger_ = 0;
  bool begun_ = false;  ///< and left by no exception since
  ColumnBlock block_;
  std::array<double, Row::kColumns> positions_{};         ///< of the columns of the block
  std::array<float, Row::kColumns> cosines_{}, sines_{};  ///< of their azimuths
  double position_ = 0;                                   ///< of the latest column
  bool any_column_ = false;
  std::int64_t current_ = 0;  ///< number of the pane that is being filled
  std::array<EndlessPane, kSlots> panes_;
  std::vector<Waiting> waiting_;  ///< a heap: all clusters that are not delivered
  std::vector<Element> delivered_runs_;
  std::uint64_t returns_ = 0, strays_ = 0;
};

/// A cluster that no later column can reach.
class EndlessCluster {
 public:
  /// Number of its returns.
  std::size_t size() const { return set_.size; }
  /// Position of its first column, turns.
  double firstPosition() const { return set_.first_position; }
  /// Position of its last column, turns; less than one turn after the first.
  double lastPosition() const { return set_.last_position; }
  /// Columns from this position on could not reach it.
  double reachEnd() const { return set_.reach_end; }
  /// Whether it was delivered for having lasted a whole turn, perhaps before its end.
  bool isCut() const { return set_.cut; }
  /// Whether it goes on from a cut one.
  bool isContinued() const { return set_.continued; }

  /// Calls visit(source_indices, count) for all its returns, in groups of one laser and columns side by side.
  template <typename Visit>
  void forEachRun(Visit&& visit) const {
    for (const EndlessClusterer::Element element : clusterer_.delivered_runs_) {
      const Runs& runs = clusterer_.paneOf(element).runs;
      const Runs::Run& run = runs.runs[EndlessClusterer::runOf(element)];
      visit(runs.source_index.data() + run.first_cell, static_cast<std::size_t>(run.count));
    }
  }

 private:
  friend class EndlessClusterer;
  EndlessCluster(const EndlessClusterer& clusterer, const EndlessClusterer::Set& set)
      : clusterer_(clusterer), set_(set) {}

  const EndlessClusterer& clusterer_;
  const EndlessClusterer::Set& set_;
};

}  // namespace lisco
