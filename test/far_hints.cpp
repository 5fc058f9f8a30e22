// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "far_hints.h"

#include <map>

#include "core/far/range_image.h"

namespace lisco_test {

double minRangeOf(const lisco::SensorHints& hints) {
  static std::map<int, lisco::RangeImage> images;  // preparing one for other steps takes long
  lisco::RangeImage& image = images[hints.steps_per_turn];
  image.prepare(lisco::Tolerance(1.0F), hints, ~std::size_t{0});
  return static_cast<double>(image.range.min_range);
}

float elevationStepFor(lisco::SensorHints hints, double min_range) {
  // Unless the steps limit it, the range goes with the square root of the density.
  hints.elevation_step = 1e-6F;
  const double ratio = minRangeOf(hints) / min_range;
  return static_cast<float>(1e-6 * ratio * ratio);
}

}  // namespace lisco_test
