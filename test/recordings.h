// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/sensor_hints.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {

/// A cloud as drivers and filters deliver it, its tolerance and what is known of its sensor.
struct Recording {
  Scan scan{0, 0};
  lisco::SensorHints hints;
  float tolerance = 1.0F;
};

/// At least 256 columns and up to some hundred returns: a rotation, a part of one or several; organized, or of one
/// laser in the order of firings, of rings, or shuffled; often with two returns of each firing, of a moving sensor, in
/// map coordinates. Several returns may have one azimuth. The hints mostly fit.
Recording randomRecording(Random& random);

}  // namespace lisco_test
