// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <vector>

#include "io/text.h"
#include "sensors/laser.h"

namespace lisco_apps {

/// A Velodyne sensor's lasers in the order of their numbers, without delays. Reads the XML file that Velodyne delivers
/// with each HDL-64E (db.xml) and that PCL's HDLGrabber reads: angles in degrees, lengths in centimetres; and the YAML
/// file that ROS makes of it: radians and metres.
/// \throws std::runtime_error with one line if it is missing, malformed, or does not describe each of the lasers
std::vector<Laser> readCalibration(const fs::path& file, std::size_t lasers);

}  // namespace lisco_apps
