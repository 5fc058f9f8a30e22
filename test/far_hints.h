// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/sensor_hints.h"

namespace lisco_test {

/// The range from which on returns are far, in units of the tolerance; infinite if the hints are of no help.
double minRangeOf(const lisco::SensorHints& hints);

/// The elevation step with which returns are far from about a range on, as near to it as the steps allow.
float elevationStepFor(lisco::SensorHints hints, double min_range);

}  // namespace lisco_test
