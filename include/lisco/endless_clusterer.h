// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "lisco/return.h"

namespace lisco {

class EndlessCluster;
struct EndlessParameters;

/// Clusters of a stream that never ends: each is delivered once, as soon as no later column can reach it, whole across
/// the borders of rotations.
///
///   lisco::EndlessClusterer clusterer;
///   clusterer.begin(parameters, [](const lisco::EndlessCluster& cluster) { ... });
///   while (...) clusterer.addColumn(returns, lasers, turns);
///   clusterer.finish();
///
/// The turn is divided into eighths, by position. Two returns are neighbours if they lie within eps of each other, in
/// the same eighth or in eighths that are at most three apart (so always less than half a turn), and neither is an
/// outlier. So no column from the *reach end* of a return on has a neighbour of it. Of eighth n, horizontally rho from
/// the sensor, a return has
///
///   reach end = min (position + (asin (eps / rho) + 2 stagger) / 2 pi, (n + 4) / 8)
///
/// and (n + 4) / 8 for rho <= (1 + kNearMargin) eps. Rounding puts the reach end up to 0.006 radians of rotation later,
/// never earlier. When a column comes that is at or beyond the reach end of all returns of a cluster, the cluster is
/// delivered. A cluster that began in eighth n and is still open when the first column of eighth n + 8 or later comes
/// is delivered then, *cut*: its returns have no neighbours from there on, and clusters that would otherwise have been
/// joined to it are *continued*. doc/streaming.md says more.
///
/// Memory is bounded by the returns of two turns; nothing is allocated once the buffers have grown. Not thread safe;
/// any number of instances may work side by side.
class LISCO_EXPORT EndlessClusterer {
 public:
  /// Receives a cluster, which is valid during the call. Must not call the clusterer.
  using Callback = std::function<void(const EndlessCluster&)>;

  EndlessClusterer();
  ~EndlessClusterer();
  EndlessClusterer(const EndlessClusterer& other);             ///< a copy goes on from the same column
  EndlessClusterer& operator=(const EndlessClusterer& other);  ///< the same

  /// Starts a new stream; of the last one, nothing more is delivered. After an exception that is not listed at the
  /// function (refused memory, a throwing callback, std::length_error for more than 2^28 runs in an eighth of a turn),
  /// all calls but begin () throw std::logic_error or do nothing.
  /// \throws std::invalid_argument if the stagger is not within 0..kMaxStagger, the origin is not finite, the start
  ///         azimuth is not within +-kMaxAzimuth, or the callback is empty; the stream before goes on then
  void begin(const EndlessParameters& parameters, Callback callback);

  /// Takes the next column.
  /// \param cells cells[l] is what laser l measured; those that are no returns are skipped. Source indices are handed
  ///        back within the next turn and a half.
  /// \param position turns, at least that of the column before, within +-kMaxPosition; the definition above
  ///        holds for it as it is given
  /// \param lasers number of cells, may differ from column to column
  /// \throws std::logic_error before begin (); std::invalid_argument if there are more cells than
  ///         EndlessParameters::lasers, unless that is 0, or the position is less than the one before or out of range
  void addColumn(const Return* cells, std::size_t lasers, double position);
  /// The same at nextPosition ().
  /// \throws as above; std::logic_error if columns_per_turn is 0
  void addColumn(const Return* cells, std::size_t lasers);

  /// Position of the next column that is added without one: 0 for the first after begin () or finish (), then
  /// 1 / columns_per_turn after the last column, infinite if that is 0. Counted from the last position given, so that
  /// rounding does not add up.
  double nextPosition() const;

  /// Delivers what can be delivered with the columns added so far, without waiting for the block to be complete.
  void update();

  /// Ends the stream: delivers all. More columns may follow, at any position; they are not compared with those before.
  void finish();

  std::uint64_t returnCount() const;   ///< since begin (); update () counts all
  std::uint64_t outlierCount() const;  ///< of these, outliers
  /// Returns in memory: of the open clusters, and of delivered ones until their eighth is forgotten.
  std::size_t returnsHeld() const;

 private:
  class LISCO_HIDDEN Stream;
  std::unique_ptr<Stream> stream_;
};

/// How an endless stream is clustered. Positions are turns of the sensor, counted from any moment.
struct EndlessParameters {
  float tolerance = 0.0F;                  ///< eps, metres; see Parameters::tolerance for 0, negative and NaN values
  std::size_t min_size = 1;                ///< clusters of fewer returns are not delivered
  std::size_t max_size = ~std::size_t{0};  ///< nor are clusters of more returns
  std::array<float, 3> origin{};           ///< position of the sensor, metres; finite
  bool clockwise = false;                  ///< sense of rotation, seen from above
  double start_azimuth = 0;  ///< of position 0, radians, counter-clockwise from the x axis; at most kMaxAzimuth
  /// Largest difference between the azimuths of a return and of its column, radians, 0..kMaxStagger. Clusters are
  /// delivered the later, the larger it is. A return beyond it is an outlier: a cluster of its own.
  double stagger = kMaxStagger;
  double columns_per_turn = 0;  ///< for addColumn () without a position; 0: each column has a position
  std::size_t lasers = 0;       ///< largest number of cells of a column; 0: any number
  /// Columns read together, 1..64; other values are clamped. With 1, clusters are delivered soonest.
  std::size_t block_columns = 16;

  static constexpr double kMaxStagger = 0.39269908169872414;  ///< a sixteenth of a turn
  static constexpr double kMaxAzimuth = 1e6;                  ///< radians
  static constexpr double kMaxPosition = 1e12;  ///< turns, either sign; beyond, a double cannot tell columns apart
};

/// Width of the ring around eps within which a return's reach end is (n + 4) / 8, in units of eps: there the float
/// comparison may find neighbours on the other side of the sensor.
inline constexpr double kNearMargin = 2e-6;

/// A cluster that is delivered: no later column can reach it, unless it is cut.
class EndlessCluster {
 public:
  std::size_t size() const { return size_; }                ///< number of its returns
  double firstPosition() const { return first_position_; }  ///< of its first column, turns
  double lastPosition() const { return last_position_; }    ///< of its last column, less than one turn after the first
  double reachEnd() const { return reach_end_; }            ///< columns from this position on could not reach it, turns
  bool isCut() const { return is_cut_; }  ///< delivered for having lasted a whole turn, perhaps before its end
  bool isContinued() const { return is_continued_; }  ///< goes on from a cut one

  /// Calls visit(source_indices, count) for all its returns, in groups of one laser and columns side by side.
  template <typename Visit>
  void forEachRun(Visit&& visit) const {
    for (const Run& run : runs_) visit(run.source_indices, run.count);
  }

 private:
  friend class EndlessClusterer;
  struct Run {
    const std::uint32_t* source_indices;
    std::size_t count;
  };

  std::size_t size_ = 0;
  double first_position_ = 0, last_position_ = 0, reach_end_ = 0;
  bool is_cut_ = false, is_continued_ = false;
  std::vector<Run> runs_;
};

}  // namespace lisco
