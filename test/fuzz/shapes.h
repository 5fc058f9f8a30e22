// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Small scans and streams, made of bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "endless_streams.h"
#include "input.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"
#include "oracle.h"

namespace lisco_test {

/// A scan of few returns in a grid of cells. Many distances are at or near the tolerance.
class Shape {
 public:
  static constexpr std::size_t kMaxLasers = 8;
  static constexpr std::size_t kMaxColumns = 1280;
  static constexpr std::size_t kMaxPoints = 64;

  /// \param unit the tolerance, or nearly
  /// \param max_columns up to kMaxColumns
  /// \param steps of a turn
  void read(Input& input, float unit, std::size_t lasers, std::size_t max_columns, std::size_t steps,
            const lisco::SensorHints& hints);

  /// What a recording may hold: two returns of a firing, several turns, other orders than columns, coordinates of maps.
  /// Returns often lie in the same direction as others.
  /// \param lasers of the sensor; unorganized clouds have one
  void readRecording(Input& input, float unit, std::size_t lasers, std::size_t steps, const lisco::SensorHints& hints);

  /// Adds empty columns up to some.
  void widen(std::size_t columns) { columns_ = std::clamp(columns, columns_, stride_); }

  std::size_t lasers() const { return lasers_; }
  std::size_t columns() const { return columns_; }
  /// The return's source index is its number among the points.
  lisco::Return at(std::size_t laser, std::size_t column) const {
    const std::uint8_t number = cells_[laser * stride_ + column];
    if (number == kEmpty) return lisco::kNoReturn;
    const Point& point = points_[number];
    return {point.x, point.y, point.z, number};
  }
  /// The points of columns first..end-1; the others are no returns.
  const std::vector<Point>& pointsIn(std::size_t first, std::size_t end);
  std::size_t pointCount() const { return points_.size(); }
  std::size_t laserOf(std::size_t point) const { return places_[point].laser; }
  std::size_t columnOf(std::size_t point) const { return places_[point].column; }

 private:
  static constexpr std::uint8_t kEmpty = 255;
  struct Place {
    std::size_t laser, column;
  };

  void resize(std::size_t lasers, std::size_t columns);
  /// False if the cell is taken.
  bool put(const Point& point, std::size_t laser, std::size_t column);

  std::size_t lasers_ = 0, columns_ = 0;
  std::size_t stride_ = 0;  ///< columns there may be
  std::vector<std::uint8_t> cells_;
  std::vector<Point> points_, some_;
  std::vector<Place> places_;
};

/// Any tolerance; most often one near the distances.
float toleranceFrom(Input& input, float unit);

/// A stream whose returns are either at the azimuth of their columns, or clearly outliers.
EndlessStream endlessStreamFrom(Input& input);

/// Whether these are the clusters of the points, in any order.
/// \param subcluster_of of each point
/// \param size_of callable as std::size_t (std::uint32_t subcluster)
template <typename SizeOf>
bool areTrueClusters(const std::vector<Point>& points, float tolerance, const std::vector<std::uint32_t>& subcluster_of,
                     std::size_t count, SizeOf&& size_of) {
  const Clustering right = trueClusters(points, tolerance);
  if (right.size() != count) return false;
  for (const Cluster& cluster : right) {
    const std::uint32_t subcluster = subcluster_of[cluster.members.front()];
    if (subcluster >= count || size_of(subcluster) != cluster.members.size()) return false;
    for (const std::uint32_t member : cluster.members)
      if (subcluster_of[member] != subcluster) return false;
  }
  return true;
}

}  // namespace lisco_test
