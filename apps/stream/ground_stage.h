// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/scan_options.h"
#include "lisco/ground_filter.h"
#include "lisco/return.h"
#include "sensors/decoder.h"
#include "stream/latency.h"

namespace lisco_apps {

/// Where a column came from.
struct Origin {
  std::int64_t time_us = 0;    ///< of its packet, microseconds since 1970
  Clock::time_point received;  ///< when the packet was at hand
};

/// What becomes of a cell.
enum class CellUse : std::uint8_t { kNothing, kClustered, kGround };

/// A cell for a clusterer: no return unless it is clustered.
inline lisco::Return returnOf(const Cell& cell, CellUse use, std::uint32_t source_index) {
  return use == CellUse::kClustered ? lisco::Return{cell.x, cell.y, cell.z, source_index} : lisco::kNoReturn;
}

/// A column on its way to the clusterer.
struct PreparedColumn {
  std::vector<Cell> cells;
  std::vector<CellUse> uses;  ///< of the cells; kNothing: no return, or left out by range or place
  double azimuth = 0;         ///< see Column
  double position = 0;        ///< turns, in endless streams
  bool starts_turn = false;
  Origin origin;

  /// \param first_index source index of the first cell; the others follow
  /// \param returns receives the cells for a clusterer
  void fill(std::uint32_t first_index, std::vector<lisco::Return>& returns) const {
    returns.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) returns[i] = returnOf(cells[i], uses[i], first_index++);
  }
};

/// Tells the ground from the other returns, column by column. By slope, a column comes out once its decisions are
/// final, up to lisco::GroundFilter::kMaxDelay columns later; otherwise at once.
class GroundStage {
 public:
  GroundStage(const GroundChoice& ground, const Region& region) : ground_(ground), region_(region) {}

  /// The place of the next column, to be filled before add (). All but the uses.
  PreparedColumn& next() { return waiting_[(first_ + count_) % kPlaces]; }

  /// Sets the sensor of the columns that follow; if it is elsewhere than before, the ground is searched anew.
  /// \param take as in add ()
  template <typename Take>
  void setSensor(const SensorPlace& sensor, Take&& take) {
    if (sensor.isAbout(sensor_)) {
      sensor_.stated = sensor.stated;
      return;
    }
    finish(take);
    sensor_ = sensor;
    lasers_ = 0;
  }

  /// Adds the column at next (). \param take called as void (const PreparedColumn&) with columns that are decided
  template <typename Take>
  void add(Take&& take) {
    decideByPlace(next());
    ++count_;
    if (ground_.method != GroundChoice::Method::kSlope) {
      takeFirst(take);
      return;
    }
    const PreparedColumn& column = waiting_[(first_ + count_ - 1) % kPlaces];
    if (column.cells.size() > lasers_) {
      finish(take, 1);
      lasers_ = column.cells.size();
      lisco::GroundParameters parameters;
      parameters.sensor.origin = sensor_.origin;
      parameters.sensor.tilt = sensor_.tilt;
      filter_.begin(parameters, lasers_);
    }
    fillReturns(column);
    filter_.addColumn(returns_.data(), returns_.size(), [&](std::size_t, const std::uint8_t* ground, std::size_t) {
      decideBySlope(ground);
      takeFirst(take);
    });
  }

  /// Decides on the columns that wait by what is known. More columns may follow.
  /// \param spared so many of the latest columns, which the filter has not seen, wait on
  template <typename Take>
  void finish(Take&& take, std::size_t spared = 0) {
    if (count_ <= spared) return;
    filter_.finish([&](std::size_t, const std::uint8_t* ground, std::size_t) {
      decideBySlope(ground);
      takeFirst(take);
    });
  }

 private:
  static constexpr std::size_t kPlaces = lisco::GroundFilter::kMaxDelay + 2;

  template <typename Take>
  void takeFirst(Take& take) {
    const PreparedColumn& column = waiting_[first_];
    first_ = (first_ + 1) % kPlaces;
    --count_;
    take(column);
  }
  void decideByPlace(PreparedColumn& column) const;
  void decideBySlope(const std::uint8_t* ground);
  void fillReturns(const PreparedColumn& column);

  GroundChoice ground_;
  Region region_;
  lisco::GroundFilter filter_;
  SensorPlace sensor_;
  std::size_t lasers_ = 0;                       ///< of the filter; 0: not begun
  std::array<PreparedColumn, kPlaces> waiting_;  ///< a ring: keeps the memory of its columns
  std::size_t first_ = 0, count_ = 0;
  std::vector<lisco::Return> returns_;  ///< for the filter
};

}  // namespace lisco_apps
