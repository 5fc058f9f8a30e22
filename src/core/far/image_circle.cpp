// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/far/image_circle.h"

#include <cmath>

#include "core/far/constants.h"
#include "core/pi.h"

namespace lisco {

namespace {

/// An azimuth as part of a turn, 0 to 1.
double turnsOf(double radians) {
  const double turns = radians / (2 * kPi);
  return turns - std::floor(turns);
}

}  // namespace

void ImageCircle::add(const RangeImage& image, std::size_t number) {
  constexpr double kRounding = 4;  // bins, of azimuths and of masks
  const auto steps = static_cast<double>(image.steps);
  margin_ = (kMaxReach + kRounding) / steps;
  direction_ = static_cast<double>(image.direction);
  east_ = image.range.origin[0];
  north_ = image.range.origin[1];
  arcs_.push_back(
      {turnsOf(direction_ * image.start_azimuth), static_cast<double>(image.end) / steps + margin_, number});
}

void ImageCircle::sort() {
  std::sort(arcs_.begin(), arcs_.end());
  farthest_ = 0;
  for (const Arc& arc : arcs_) farthest_ = std::max(farthest_, arc.reach);
}

/// The end of what the mask of a return covers.
double ImageCircle::positionOf(const RangeImage::Unplaced& point) const {
  const double azimuth = std::atan2(static_cast<double>(point.y - north_), static_cast<double>(point.x - east_));
  return turnsOf(direction_ * azimuth + margin_ * 2 * kPi);
}

}  // namespace lisco
