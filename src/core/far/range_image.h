// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/bits.h"
#include "core/far/image_cells.h"
#include "core/far/laser_ranks.h"
#include "core/growing_array.h"
#include "core/neighbour.h"
#include "core/ring_block.h"
#include "lisco/sensor_hints.h"

namespace lisco {

/// The far returns of consecutive columns by laser and *azimuth bin*: a row per laser, a bin per step of the turn.
/// Rows are in the order of the lasers, or of their elevations if these come unsorted (sortLasers).
///
/// A return lies in the bin of its measured azimuth, whatever its column. A *row* holds one return in each bin. A laser
/// has `layers` rows, one behind the other: a return goes to the first in which its bin is free. There is one layer at
/// first, and one more whenever enough returns have no free bin (isLayerWorthwhile). A far return without a free bin,
/// or beyond the bins of the image, is *unplaced*: its neighbours are searched one by one, and it must be kept in the
/// voxels as well. Rows are reached by the elevations measured on their laser.
///
/// Bins are counted from the first return's, less kMargin, in the sense of rotation. A row has as many as a turn, or as
/// the columns if these are fewer, and four times kMargin, as staggered lasers see azimuths before the first return's
/// and behind the last column's; what comes behind the last bin goes into the bins a turn before. At either end there
/// are kMargin more that hold no returns, which masks and vectors may read.
struct RangeImage {
  static constexpr std::size_t kSector = 16;  ///< bins of a sector, the unit of linking
  static constexpr std::size_t kMargin = 64;  ///< bins, at least those of a ring block
  static constexpr std::size_t kMaxLayers = 4;
  static constexpr std::size_t kNoRow = ~std::size_t{0};
  static constexpr std::int64_t kNoBin = std::numeric_limits<std::int64_t>::min();

  struct Row {
    bool is_open;           ///< false: its bins have no values yet, and hold no returns
    float lowest, highest;  ///< slopes measured on its laser so far: (z - tilt_x x - tilt_y y) / rho
    std::int64_t next_bin;  ///< after the laser's last return, in its first row; kNoBin: there was none
    std::uint32_t next_column;
  };
  struct Unplaced {
    float x, y, z;
    std::uint32_t element;
  };
  /// Components of a horizontal vector towards bin 0 and across, in the sense of rotation, metres.
  struct FromStart {
    float u, v;
  };
  /// A range of rows.
  struct Rows {
    std::size_t begin, end;
  };

  /// Starts a rotation, or a part of one. Keeps its memory.
  /// \param columns number of columns expected; more than a turn needs no more memory
  /// \param capacity number of columns up to which expectColumns () moves no returns
  void prepare(const Tolerance& new_tolerance, const SensorHints& hints, std::size_t columns, std::size_t capacity = 0);

  /// Exchanges the memory of the first rows with that of an array: exchangeMemory () always, takeLargerMemory () if the
  /// array's is larger, leaveLargerMemory () if it is smaller. All values are lost; prepare () comes next.
  template <typename Element>
  void exchangeMemory(GrowingArray<Element>& array) noexcept {
    cells.exchangeMemory(array);
  }
  template <typename Element>
  void takeLargerMemory(GrowingArray<Element>& array) noexcept {
    if (cells.exchangedBytes() < array.size() * sizeof(Element)) cells.exchangeMemory(array);
  }
  template <typename Element>
  void leaveLargerMemory(GrowingArray<Element>& array) noexcept {
    if (hasLargerMemoryThan(array)) cells.exchangeMemory(array);
  }
  template <typename Element>
  bool hasLargerMemoryThan(const GrowingArray<Element>& array) const {
    return cells.exchangedBytes() > array.size() * sizeof(Element);
  }

  /// Makes room for more columns than expected before. Returns that are placed stay where they are.
  void expectColumns(std::size_t columns);

  /// Whether a rotation before has left memory.
  bool hasMemory() const { return cells.bytes() > 0; }
  /// Whether that is enough for the rows of some lasers, and for all rows that there are, in a number of columns.
  bool hasMemoryFor(std::size_t lasers, std::size_t columns, const SensorHints& hints) const;
  /// Gives back the memory of columns that are not expected. All values are lost; prepare () comes next.
  void shrinkMemory() { cells.shrinkTo(stride); }

  /// False if no return is far: see farRangeFor.
  bool inUse() const { return steps > 0; }

  /// Grows to a number of lasers.
  void addLasers(std::size_t count);

  /// Puts the far returns of a ring block, one at least, into their bins. The first of all sets bin 0.
  /// \param column the block's first, counted from the first of the rotation
  /// \return those that are unplaced
  ColumnBits place(const RingBlock& block, const RingBlockInfo& info, std::size_t laser, std::uint32_t column);

  /// Whether too many returns are unplaced for one image of a rotation: their search costs more than bins save. Then
  /// stopPlacing () all images of the rotation, after each has been linked to each: all far returns that follow are
  /// unplaced, and those before are not searched again.
  bool isFull() const { return full; }
  void stopPlacing();

  /// Puts the rows in the order of the lasers' slopes if they are unsorted, and if lasers have been seen since the last
  /// time, or twice as many returns. Later rotations keep the order.
  void sortLasers();
  /// Brings the elevations of the rows up to date.
  void updateElevations();
  /// Takes over the number of rows of another image of the same sensor, and the elevations measured there; shareRows ()
  /// takes over the order of the lasers, too.
  void mergeRows(const RangeImage& other);
  void shareRows(const RangeImage& other);

  /// The end of the sectors that all lasers have passed, bins.
  std::size_t passed() const;

  std::size_t laserCount() const { return rows.size() / layers; }
  std::size_t firstRowOf(std::size_t laser) const { return ranks.rankOf(laser) * layers; }
  /// The row below whose bins linkSameBins compares with those of a row; kNoRow: none.
  std::size_t rowInSameBins(std::size_t row) const {
    return row % layers == 0 && row + layers < rows.size() ? row + layers : kNoRow;
  }
  Rows allRows() const { return {0, rows.size()}; }
  Rows someRows(std::size_t part, std::size_t parts) const {
    return {rows.size() * part / parts, rows.size() * (part + 1) / parts};
  }

  /// Sets bin 0 a margin before the azimuth of a block's first far return.
  void start(const RingBlock& block, const RingBlockInfo& info, std::uint32_t column);

  /// Whether so many returns are unplaced that another layer is worth its memory.
  bool isLayerWorthwhile() const;
  /// Sets the number of bins for some columns, and their directions.
  void setBins(std::size_t columns);
  /// Adds a layer: every laser gets one more row, without memory yet. Rows are numbered anew.
  void addLayer();
  /// Gives the lasers, which come by rank, the rows in this order.
  void orderLasers(const std::vector<std::uint32_t>& lasers);
  /// Exchanges all rows of the lasers at two ranks.
  void swapLasers(std::size_t a, std::size_t b);
  /// Gives a row memory, without values yet.
  void addMemory(std::size_t row);
  /// Gives a row memory, if it has none, and frees all its bins, before its first return.
  void openRow(std::size_t row);

  /// The bins of an open row from one of them on.
  /// \param bin at least -kMargin
  RowBins at(std::size_t row, std::int64_t bin) const {
    return cells.at(row, static_cast<std::size_t>(bin + static_cast<std::int64_t>(kMargin)));
  }
  WritableRowBins at(std::size_t row, std::int64_t bin) {
    return cells.at(row, static_cast<std::size_t>(bin + static_cast<std::int64_t>(kMargin)));
  }
  FromStart fromStart(float east, float north) const {
    return {east * start_cosine + north * start_sine, direction * (north * start_cosine - east * start_sine)};
  }
  /// Height above the sensor's horizon.
  float heightOf(float east, float north, float up) const {
    return up - (east * range.tilt[0] + north * range.tilt[1]);
  }
  /// The bin of an azimuth, within half a turn of bin 0.
  std::int64_t binOf(const FromStart& seen) const {
    return std::llround(static_cast<double>(std::atan2(seen.v, seen.u)) / static_cast<double>(radians_per_bin));
  }

  Tolerance tolerance;
  FarRange range;
  float deviation = 0;       ///< bins between that of a return and that of its azimuth, at most
  float deviation_sine = 0;  ///< sine of as many bins
  float reach = 0;           ///< paddedReach () of the tolerance, metres
  float slope_reach = 0;     ///< the same where heights are measured from the tilted horizon
  std::size_t steps = 0;     ///< bins of a turn
  std::size_t bins = 0;      ///< of a row, that may hold returns
  std::size_t stride = 0;    ///< bins of a row in use, with those at its ends that hold none
  float direction = 1;       ///< +1: azimuth grows with time
  float radians_per_bin = 0;
  double start_azimuth = 0;  ///< of bin 0
  float start_cosine = 1;
  float start_sine = 0;
  std::uint32_t first_column = 0;
  bool started = false;
  std::vector<float> cosine, sine;  ///< of each bin, from -kMargin on, and perhaps more
  std::size_t steps_of_tables = 0;  ///< for which they hold
  ImageCells cells;                 ///< of the rows

  std::vector<Row> rows;  ///< by rank of the laser, and layer
  std::size_t layers = 1;
  LaserRanks ranks;                                ///< with the slopes of this rotation, and of those before
  bool may_be_unsorted = false;                    ///< slopes have changed since sortLasers ()
  std::size_t known_when_sorted = 0;               ///< lasers
  std::size_t placed_when_sorted = 0;              ///< returns of this rotation
  std::size_t times_reordered = 0;                 ///< how often lasers have been exchanged
  bool upside_down = false;                        ///< the rows come from bottom to top
  std::vector<float> lowest, highest;              ///< radians, of each row; turned over if upside down
  std::vector<float> lowest_above, highest_below;  ///< of all rows up to, and from, each one
  bool elevations_changed = false;

  std::size_t linked = 0;     ///< bins before this are linked
  std::size_t scheduled = 0;  ///< bins before this are linked or will be next
  std::vector<Unplaced> unplaced;
  std::vector<Unplaced> late;  ///< placed in bins before `scheduled`
  std::size_t placed = 0;
  std::size_t realigned = 0;       ///< returns off the bin that follows the last one's
  std::size_t begin = 0, end = 0;  ///< the first bin taken, and after the last
  bool full = false;
};

/// The vectorized part of RangeImage::place.
ColumnBits placeReturns(RangeImage& image, const RingBlock& block, const RingBlockInfo& info, std::size_t laser,
                        std::uint32_t first_column);

}  // namespace lisco
