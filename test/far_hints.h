// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/sensor_hints.h"

namespace lisco_test {

/// The least far range in units of the tolerance; infinite if the hints are not usable.
double minRangeOf(const lisco::SensorHints& hints);

/// The elevation step that makes returns far from about a range on, as near to it as the steps allow.
float elevationStepFor(lisco::SensorHints hints, double min_range);

}  // namespace lisco_test
