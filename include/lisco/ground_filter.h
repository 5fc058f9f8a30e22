// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>

#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco {

/// Parameters of the ground filter. The z axis points up, to within about 10 degrees.
struct GroundParameters {
  /// Height of the sensor above the ground beneath it, metres, any finite value; NaN: estimated from the returns.
  float sensor_height = std::numeric_limits<float>::quiet_NaN();
  /// Slope of the ground around the sensor along x and y, metres per metre, -10 to 10: where the estimate begins.
  std::array<float, 2> slope{0.0F, 0.0F};
  /// Steepest slope of ground, degrees against the sensor's horizon, which is the x-y plane unless it is tilted; 1 to
  /// 60. Ground of more than 31 degrees is found only where gentler ground leads to it.
  float max_slope = 17.0F;
  /// Its origin and tilt decide where the ground is searched for; see estimateSensor. Ground is estimated only more
  /// than 0.2 m below the origin, or up to 0.5 m above it if steps_per_turn is 0 and the origin is (0, 0, 0).
  SensorHints sensor;
};

/// Finds the ground in a rotating LiDAR's returns, column by column: which returns lie on the ground is decided from
/// the columns before, and final after at most kMaxDelay further columns.
///
///   lisco::GroundFilter filter;
///   filter.begin({}, lasers);
///   const auto decided = [&](std::size_t column, const std::uint8_t* ground, std::size_t lasers) { ... };
///   while (...) filter.addColumn(returns, lasers, decided);  // ground[l] is 1 if laser l's return is ground, else 0
///   filter.finish(decided);
///
/// Any number of rotations may follow each other without another begin (). The rows of a column may have any order,
/// lasers may be staggered, the sensor may turn either way. State, memory and the work of a column are bounded.
/// Nothing is allocated after begin (), nor by a begin () with no more lasers than before. Not thread safe; any number
/// of instances may work side by side.
class LISCO_EXPORT GroundFilter {
 public:
  GroundFilter();
  ~GroundFilter();
  GroundFilter(const GroundFilter& other);             ///< a copy goes on from the same column
  GroundFilter& operator=(const GroundFilter& other);  ///< the same

  /// Further columns that may have to arrive before a column's decisions are final.
  static constexpr std::size_t kMaxDelay = 8;

  /// Starts anew and forgets all columns.
  /// \param lasers largest number of cells of a column
  /// \throws std::invalid_argument if the sensor height is infinite, max_slope is not within 1 to 60, the sensor's
  ///         origin is not finite, or the slope or the sensor's tilt is not within -10 to 10
  void begin(const GroundParameters& parameters, std::size_t lasers);

  /// Adds a column, and visits those whose decisions are final, in their order.
  /// \param cells cells[l] is what laser l measured; those that are no returns get 0. Coordinates of more than 1e6 m
  ///        from the sensor are not ground
  /// \param lasers number of cells, may differ from column to column
  /// \param visit callable as void (std::size_t column, const std::uint8_t* ground, std::size_t lasers): the column
  ///        counted from begin (), 1 for each cell on the ground, 0 for the others, and the number of cells as given.
  ///        If it throws, the column counts as visited, and the filter goes on
  /// \throws std::logic_error before begin (); std::invalid_argument if there are more cells than begin () was told
  template <typename Visit>
  void addColumn(const Return* cells, std::size_t lasers, Visit&& visit) {
    receive(cells, lasers, std::ref(visit));
  }

  /// Visits the columns that are not final yet. More columns may follow.
  /// \param visit as that of addColumn; if it throws, another finish () visits the rest
  template <typename Visit>
  void finish(Visit&& visit) {
    decideRest(std::ref(visit));
  }

  /// Starts anew and decides on whole columns, as an organized cloud holds them. The result is that of addColumn and
  /// finish, to the bit. To add columns afterwards, begin () again.
  /// \param cells callable as Return (std::size_t laser, std::size_t column), or block by block as CellSource has it
  /// \param ground receives columns * lasers bytes, laser by laser: ground[laser * columns + column] is 1 on the
  ///        ground, else 0
  /// \throws as begin ()
  template <typename Cells>
  void filter(const GroundParameters& parameters, std::size_t columns, std::size_t lasers, Cells&& cells,
              std::uint8_t* ground) {
    filterAll(parameters, columns, lasers, CellSource(cells), ground);
  }

  /// Estimates the plane of the ground around the sensor from columns spread over the scan, then filters as filter ()
  /// does. Without a clear plane, nothing is ground. To add columns afterwards, begin () again.
  /// \param parameters as estimateGroundPlane takes them: the sensor's, and its height if it is known
  /// \param ground as filter ()
  /// \throws std::invalid_argument as begin ()
  /// \return the parameters with the estimates; the height is NaN where nothing is ground
  template <typename Cells>
  GroundParameters filterScan(const GroundParameters& parameters, std::size_t columns, std::size_t lasers,
                              Cells&& cells, std::uint8_t* ground) {
    return estimateAndFilter(parameters, columns, lasers, CellSource(cells), ground);
  }

 private:
  using Visitor = std::function<void(std::size_t column, const std::uint8_t* ground, std::size_t lasers)>;

  void receive(const Return* cells, std::size_t lasers, const Visitor& visit);
  void decideRest(const Visitor& visit);
  void filterAll(const GroundParameters& parameters, std::size_t columns, std::size_t lasers, const CellSource& cells,
                 std::uint8_t* ground);
  GroundParameters estimateAndFilter(const GroundParameters& parameters, std::size_t columns, std::size_t lasers,
                                     const CellSource& cells, std::uint8_t* ground);

  class LISCO_HIDDEN State;
  std::unique_ptr<State> state_;
};

/// Estimates the sensor and its height above the ground from a sample of an organized cloud's cells, or of a rotation
/// before. The height stays NaN where no ground is clearly seen.
/// \param declared_origin position that the cloud states for its sensor, metres; without effect if not finite
/// \param cells lasers in any order, columns in that of the rotation
LISCO_EXPORT GroundParameters estimateGround(std::size_t columns, std::size_t lasers,
                                             const std::array<float, 3>& declared_origin, const CellSource& cells);

/// Estimates the height, if it is NaN, and the slope of the ground around a known sensor.
/// \param parameters the sensor, and its height if it is known
/// \return the parameters with the estimates; unchanged where no ground is clearly seen
/// \throws std::invalid_argument as GroundFilter::begin ()
LISCO_EXPORT GroundParameters estimateGroundPlane(std::size_t columns, std::size_t lasers, GroundParameters parameters,
                                                  const CellSource& cells);

}  // namespace lisco
