// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/sensor_hints.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {

/// Pairs in a scan, their tolerance, and the hints of the sensor.
struct PairScan {
  Scan scan{0, 0};
  lisco::SensorHints hints;
  float tolerance = 1.0F;
};

/// Many pairs in one scan of up to three turns, each just within the tolerance or just beyond it, where masks and
/// segments end. The hints fit four scans in five.
PairScan randomPairs(Random& random);

}  // namespace lisco_test
