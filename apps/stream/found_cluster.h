// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "sensors/decoder.h"

namespace lisco_apps {

/// What is told of a cluster.
class FoundCluster {
 public:
  std::uint32_t id = 0;  ///< from 1

  void add(const Cell& cell) {
    const std::array<float, 3> point{cell.x, cell.y, cell.z};
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(point[axis]);
      sum_[axis] += value;
      squared += value * value;
      lo_[axis] = std::min(lo_[axis], point[axis]);
      hi_[axis] = std::max(hi_[axis], point[axis]);
    }
    nearest_ = std::min(nearest_, squared);
    ++size_;
  }

  std::size_t size() const { return size_; }
  std::array<double, 3> centroid() const {
    const auto size = static_cast<double>(size_);
    return {sum_[0] / size, sum_[1] / size, sum_[2] / size};
  }
  const std::array<float, 3>& lo() const { return lo_; }  ///< of its box, metres
  const std::array<float, 3>& hi() const { return hi_; }
  double nearestRange() const { return std::sqrt(nearest_); }  ///< from the sensor, metres

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::size_t size_ = 0;
  std::array<double, 3> sum_{};
  std::array<float, 3> lo_{kInfinity, kInfinity, kInfinity}, hi_{-kInfinity, -kInfinity, -kInfinity};
  double nearest_ = std::numeric_limits<double>::infinity();  ///< squared
};

}  // namespace lisco_apps
