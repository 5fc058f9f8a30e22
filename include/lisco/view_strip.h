// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "lisco/disjoint_sets.h"
#include "lisco/export.h"
#include "lisco/row.h"
#include "lisco/tolerance.h"
#include "lisco/view_hints.h"

namespace lisco {

/// What a strip holds; see ViewStrip. The vector code works on it.
struct StripData {
  static constexpr std::size_t kSector = 16;  ///< places
  static constexpr std::size_t kMargin = 64;  ///< places before the first return's, for staggered lasers
  static constexpr std::int64_t kNowhere = std::numeric_limits<std::int64_t>::min();
  static constexpr std::size_t kSectorsKept = 8;
  static constexpr std::int64_t kNoSector = -1;
  static constexpr std::size_t kParts = 80;  ///< in which a sector may be linked

  /// What is known of a laser.
  struct Laser {
    float lowest, highest;    ///< slopes (z / rho) measured so far
    std::int64_t next_place;  ///< after its last return, not wrapped; kNowhere: none yet
    std::uint32_t next_column;
  };
  struct Loose {
    float x, y, z;
    std::uint32_t element;
  };
  /// What is kept while returns are placed.
  struct Placing {
    std::vector<Loose> loose;
    std::vector<Loose> late;  ///< placed where all had been compared
    std::size_t placed = 0;
    std::size_t begin = 0, end = 0;  ///< the first place taken, and after the last
    bool full = false;               ///< too many were loose: all that follow are, too
  };
  /// The segments of a sector, ordered by laser and place.
  struct Sector {
    std::int64_t number = kNoSector;
    std::vector<float> nearest, farthest;  ///< horizontal distance
    std::vector<float> lowest, highest;    ///< z
    std::vector<float> first, last;        ///< place
    std::vector<std::uint32_t> head;       ///< of its subcluster, perhaps not the newest
    std::vector<std::uint32_t> cell;       ///< where its returns begin
    std::vector<std::uint8_t> count;       ///< of returns
    std::vector<std::uint32_t> begin;      ///< of each laser's segments, and the end
  };
  /// The mask of one laser's returns in a sector.
  struct Mask {
    float nearest = 0;  ///< horizontal distance, metres
    int before = 0;     ///< places that it reaches over
    std::uint32_t first_laser = 0, last_laser = 0;
    std::uint32_t above = 0, below = 0;  ///< the same lasers, counted from this one: where the next search begins
    bool by_places = false;              ///< what is cheaper: to compare places, or segments
  };
  /// What is kept while they are linked.
  struct Linking {
    std::array<Sector, kSectorsKept> sectors;
    Sector beyond;            ///< a sector of another strip, or one around the beginning, seen as if a turn later
    std::vector<Mask> masks;  ///< of each laser in the sector at hand
    std::size_t work = 0;     ///< done so far, about in comparisons of registers
  };

  /// A return as it lies seen from the strip's start, turning with time.
  struct Seen {
    float u, v;  ///< metres, towards place 0 and across
  };

  /// \param place not less than -kMargin
  std::size_t at(std::size_t laser, std::int64_t place) const {
    return laser * stride + static_cast<std::size_t>(place + static_cast<std::int64_t>(kMargin));
  }
  struct Lasers {
    std::size_t begin, end;
  };
  Lasers allLasers() const { return {0, lasers.size()}; }
  Lasers someLasers(std::size_t part, std::size_t parts) const {
    return {lasers.size() * part / parts, lasers.size() * (part + 1) / parts};
  }

  bool isFree(std::size_t cell) const { return x[cell] != x[cell]; }
  Seen seenFromStart(float east, float north) const {
    return {east * start_cosine + north * start_sine, direction * (north * start_cosine - east * start_sine)};
  }
  /// The place of its azimuth, within half a turn of place 0.
  std::int64_t placeOf(const Seen& seen) const {
    return std::llround(static_cast<double>(std::atan2(seen.v, seen.u)) / static_cast<double>(radians_per_place));
  }

  Tolerance tolerance;
  FarRange range;
  float reach = 0;
  std::size_t steps = 0;   ///< places in a turn
  std::size_t places = 0;  ///< of a laser: some more than columns, or than a turn
  std::size_t stride = 0;  ///< floats per laser
  float direction = 1;     ///< +1: azimuth grows with time
  float radians_per_place = 0;
  double start_azimuth = 0;  ///< of place 0
  float start_cosine = 1;
  float start_sine = 0;
  std::uint32_t first_column = 0;
  bool started = false;
  std::vector<float> cosine, sine;  ///< of each place, and of some before and behind
  std::vector<float> x, y, z;       ///< x is NaN where a place is free
  std::vector<std::uint32_t> element;
  std::vector<Laser> lasers;
  bool upside_down = false;                        ///< the lasers come from bottom to top
  std::vector<float> lowest, highest;              ///< radians, of each laser; turned over if upside down
  std::vector<float> lowest_above, highest_below;  ///< of all lasers up to, and from, each one
  std::size_t linked = 0;                          ///< places before this are compared
  std::size_t linked_parts = 0;                    ///< of the sector that follows
  std::size_t claimed = 0;                         ///< places before this are compared, or about to be
  bool elevations_changed = false;
  Placing placing;
  Linking linking;
};

/// Far returns, each in a place of its own: the sensor's view unrolled, a row per laser and a place per step of the
/// turn.
///
/// Where the tolerance is seen under few steps and lasers, the paper's mask is a window of places. It is measured: a
/// return stands at the place of its *azimuth*, whatever its column, and lasers are reached by the elevations *measured*
/// on them. Sixteen places of all lasers are a *sector*; what a run has in a sector is a *segment*. Neighbours are found in
/// two steps:
///   1. returns at the same place of lasers next to each other are compared, sixteen at a time, which joins most of
///      what belongs together;
///   2. each segment looks at the segments in its window that are not in its subcluster by then, bounds first, and
///      compares its returns with those of the few that are left.
///
/// A return is far if its horizontal distance is at least a certain multiple of the tolerance. Neighbours that are both
/// far are found here, but for those with a loose one: a far return that found its place taken. Loose returns must be
/// kept elsewhere as well.
class LISCO_EXPORT ViewStrip : private StripData {
 public:
  /// Starts a rotation, or a part of one. Keeps its memory.
  /// \param columns how many are expected; a turn is enough
  void prepare(const Tolerance& tolerance, const ViewHints& hints, std::size_t columns = ~std::size_t{0});

  /// False if the hints give no steps, or the tolerance joins nothing: then no return is far.
  bool inUse() const { return steps > 0; }
  const FarRange& farRange() const { return range; }

  /// Makes room for so many lasers.
  void addLasers(std::size_t lasers);
  bool hasStarted() const { return started; }
  /// Lays the first place where this return is seen, or a little before.
  void start(float x_seen, float y_seen, std::uint32_t column);

  /// Puts the far returns of a row in their places.
  /// \param first_column column of the row's first cell, counted from the first of the rotation
  /// \return bit i is set if return i is loose
  std::uint64_t place(const Row& row, const MeasuredRow& measured, std::size_t laser, std::uint32_t first_column);

  /// Compares what has come since the last call, as far as all lasers have passed it.
  void link(DisjointSets& subclusters);
  /// The same in small parts, so that no column takes much longer than others: claim () says what is to be compared.
  void claim();
  std::size_t partsLeft() const { return (claimed - linked) / kSector * kParts - linked_parts; }
  /// \return what it took, about in comparisons of registers
  std::size_t linkPart(DisjointSets& subclusters);

  /// All that linking has taken so far, in the same.
  std::size_t work() const { return linking.work; }

  /// Compares all that has not been compared within the strip. linkTo (*this) is to follow. More returns may come later.
  void linkRest(DisjointSets& subclusters);
  /// Compares the returns here with those of another strip of the same rotation; or, of this one, those at its end with those
  /// a turn before.
  void linkTo(ViewStrip& other, DisjointSets& subclusters);

  /// Whether too many returns are loose for one strip of a rotation. Then all of them are to stopPlacing (), when each has
  /// been linked to each: all far returns that follow are loose, and those before need not be searched for again.
  bool isFull() const { return placing.full; }
  void stopPlacing();

 private:
  void shareElevations(const ViewStrip& other);
  void updateElevations();
  void forgetSectors();
  void search(const Loose& loose, DisjointSets& subclusters) const;
  std::size_t passed() const;
};

}  // namespace lisco
