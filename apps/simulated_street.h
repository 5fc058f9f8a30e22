// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "cloud_file.h"

namespace lisco_apps {

/// Height of the street below the simulated sensor, metres: clusters lie above a little more than this.
inline constexpr float kStreetZ = -1.73F;

/// One rotation of a 64-laser sensor on a car in a street of houses, parked cars, trees, poles and people; 64
/// rows (lasers, from +2 down to -24.8 degrees) x 1800 columns, clockwise, NaN for no return, with 2 cm of
/// range noise. The same seed gives the same scan.
Cloud::Ptr simulateStreet(unsigned seed);

}  // namespace lisco_apps
