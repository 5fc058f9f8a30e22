// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cmath>

#include "core/pi.h"
#include "lisco/return.h"

namespace lisco_apps {

using lisco::kPi;

template <typename Point>
bool isReturn(const Point& p) {
  return lisco::isReturn(p.x, p.y, p.z);
}

/// Where a cloud says that its sensor is, metres; (0, 0, 0) if that is not finite.
template <typename Cloud>
std::array<float, 3> declaredOriginOf(const Cloud& cloud) {
  const auto& origin = cloud.sensor_origin_;
  if (!origin.allFinite()) return {};
  return {origin[0], origin[1], origin[2]};
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

}  // namespace lisco_apps
