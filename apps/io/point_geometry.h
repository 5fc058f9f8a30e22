// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "lisco/return.h"

namespace lisco_apps {

constexpr double kPi = 3.14159265358979323846;

template <typename Point>
bool isReturn(const Point& p) {
  return lisco::isReturn(p.x, p.y, p.z);
}

/// Distance from (0, 0, 0), metres.
template <typename Point>
double rangeOf(const Point& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

/// Radians counterclockwise from +x.
template <typename Point>
double azimuthOf(const Point& p) {
  return std::atan2(static_cast<double>(p.y), static_cast<double>(p.x));
}

/// Radians above the horizon.
template <typename Point>
double elevationOf(const Point& p) {
  return std::atan2(static_cast<double>(p.z), std::hypot(static_cast<double>(p.x), static_cast<double>(p.y)));
}

/// Size, centroid, bounding box and nearest range of a cluster, point by point. Metres.
class ClusterShape {
 public:
  /// \param p has finite x, y, z of type float
  template <typename Point>
  void add(const Point& p) {
    const std::array<float, 3> point{p.x, p.y, p.z};
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(point[axis]);
      sum_[axis] += value;
      squared += value * value;
      lo_[axis] = std::min(lo_[axis], point[axis]);
      hi_[axis] = std::max(hi_[axis], point[axis]);
    }
    nearest_squared_ = std::min(nearest_squared_, squared);
    ++size_;
  }

  std::size_t size() const { return size_; }
  std::array<double, 3> centroid() const {
    const auto size = static_cast<double>(size_);
    return {sum_[0] / size, sum_[1] / size, sum_[2] / size};
  }
  const std::array<float, 3>& lo() const { return lo_; }  ///< of the bounding box
  const std::array<float, 3>& hi() const { return hi_; }
  double nearestRange() const { return std::sqrt(nearest_squared_); }  ///< from (0, 0, 0)

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::size_t size_ = 0;
  std::array<double, 3> sum_{};
  std::array<float, 3> lo_{kInfinity, kInfinity, kInfinity}, hi_{-kInfinity, -kInfinity, -kInfinity};
  double nearest_squared_ = std::numeric_limits<double>::infinity();
};

}  // namespace lisco_apps
