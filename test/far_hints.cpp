// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "far_hints.h"

#include "core/far/far_range.h"

namespace lisco_test {

double minRangeOf(const lisco::SensorHints& hints) {
  return static_cast<double>(lisco::farRangeFor(lisco::Tolerance(1.0F), hints).min_range);
}

float elevationStepFor(lisco::SensorHints hints, double min_range) {
  // Unless the steps limit it, the range is proportional to the square root of the density.
  hints.elevation_step = 1e-6F;
  const double ratio = minRangeOf(hints) / min_range;
  return static_cast<float>(1e-6 * ratio * ratio);
}

}  // namespace lisco_test
