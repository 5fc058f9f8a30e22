// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/far/constants.h"
#include "core/neighbour.h"
#include "core/pi.h"
#include "core/ring_block.h"
#include "lisco/sensor_hints.h"

namespace lisco {

/// Tolerance::reach () in float, rounded up.
inline float paddedReach(const Tolerance& tolerance) {
  return static_cast<float>(tolerance.reach()) * 1.00001F;
}

/// RangeImage::deviation for a sensor.
inline float deviationFor(const SensorHints& hints) {
  constexpr float kRounding = 0.6F;  // of an azimuth to the nearest bin, and some more
  return hints.jitter > kWorthDeviation ? std::min(hints.jitter + kRounding, kMaxDeviation) : kMinDeviation;
}

/// Which returns are far: those for which the tolerance spans few bins and lasers. None (min_range infinite) if the
/// hints are out of range or unknown.
inline FarRange farRangeFor(const Tolerance& tolerance, const SensorHints& hints) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  FarRange range;
  range.origin = hints.origin;
  range.tilt = hints.tilt;
  range.min_range = range.interior_min = kNone;

  const double steps = std::max(hints.steps_per_turn, 1);
  const double step = 2 * kPi / steps;
  const bool is_rough = static_cast<double>(hints.roughness) > tolerance.reach();
  const double spacing = std::sqrt((is_rough ? kRoughReturnsPerSquare : kReturnsPerSquare) * step *
                                   static_cast<double>(hints.elevation_step));
  // In map coordinates, azimuths are as coarse as the coordinates.
  const float from_zero = std::max(std::fabs(hints.origin[0]), std::fabs(hints.origin[1]));
  const double coarseness = static_cast<double>(std::nextafter(from_zero, kNone)) - static_cast<double>(from_zero);
  // As near as that, unless a mask would reach over more than kMaxReach bins.
  const double max_bins = static_cast<double>(kMaxReach) - 2 * static_cast<double>(deviationFor(hints)) - 1.5;
  const double min_range =
      std::max(tolerance.reach() * std::max({1 / spacing, kMinRangeInTolerances, 1 / std::sin(max_bins * step)}),
               kMinBinInCoarseness * coarseness / step);
  const bool is_origin_valid = std::all_of(hints.origin.begin(), hints.origin.end(),
                                           [](float coordinate) { return std::fabs(coordinate) <= kMaxRange; });
  const bool is_tilt_valid =
      std::all_of(hints.tilt.begin(), hints.tilt.end(), [](float slope) { return std::fabs(slope) <= kMaxTilt; });
  const bool is_useful = is_origin_valid && is_tilt_valid && steps >= kMinSteps && steps <= kMaxSteps &&
                         tolerance.joinsAnything() && spacing > 1e-5 && spacing < 10 && min_range > 1e-18 &&
                         min_range < static_cast<double>(kMaxRange) &&
                         min_range < static_cast<double>(hints.far_distance);
  if (!is_useful) return range;
  const float reach = paddedReach(tolerance);
  range.min_range = static_cast<float>(min_range);
  range.max_range = kMaxRange;
  // Distances are rounded, and so are these sums.
  range.interior_min = range.min_range * 1.00001F + reach;
  range.interior_max = kMaxRange * 0.9999F - reach;
  return range;
}

}  // namespace lisco
