// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>

namespace lisco {

/// An upright box, turned about the z axis.
struct OrientedBox {
  std::array<double, 3> center{};  ///< metres
  double yaw = 0;     ///< of its length, radians counterclockwise from the x axis, -pi/2 <= yaw < pi/2: front and back
                      ///< are not told apart
  double length = 0;  ///< the longer horizontal side, metres
  double width = 0;   ///< the shorter one, metres
  double height = 0;  ///< along z, metres
};

/// Size, boxes, range and density of a cluster.
struct ClusterFeatures {
  std::size_t size = 0;              ///< number of returns
  std::array<double, 3> centroid{};  ///< mean of the returns, metres
  std::array<float, 3> min{};        ///< corner of the axis-aligned box, metres: exact
  std::array<float, 3> max{};        ///< the opposite corner
  OrientedBox box;                   ///< holds all returns
  double nearest_range = 0;          ///< metres from the sensor to the nearest return
  /// Returns per square metre of three adjacent sides of the oriented box, which are all that a sensor sees of it at
  /// once: size / (length * width + length * height + width * height). 0 if they have no area.
  double density = 0;
};

/// The features of a cluster:
///
///   std::vector<float> points = ...;  // x, y, z, x, y, z, ... of one cluster
///   lisco::ClusterFeatures car = lisco::clusterFeatures(points.data(), points.size() / 3, 3 * sizeof(float));
///   car.box.yaw, car.box.length, car.box.width ...
///
/// The oriented box is an L-shape fit (Zhang et al. 2017, closeness criterion): a LiDAR sees two sides of a vehicle,
/// and of the boxes around its returns, the one is taken whose sides the returns are nearest to. The headings tried are
/// the longest edges of the convex hull, then steps around the best one, so that the box turns with the cluster. (The
/// box of the least area is up to 25 degrees wrong where two sides are visible: doc/objects.md.)
///
/// Sums and differences are taken in double precision, relative to the first point: map coordinates lose nothing.
/// Degenerate clusters: without extent along x and y, length, width and yaw are 0; with all points on one vertical
/// plane, the width is 0; no points at all give features of 0.
///
/// \param points the first point: x, y and z as floats, metres; finite
/// \param count number of points
/// \param stride bytes from one point to the next, at least 12; points need not be aligned
/// \param origin position of the sensor, metres, finite
/// \throws std::invalid_argument if the stride is below 12, or `points` is null while count is not 0
LISCO_EXPORT ClusterFeatures clusterFeatures(const void* points, std::size_t count, std::size_t stride,
                                             const std::array<float, 3>& origin = {});

}  // namespace lisco
