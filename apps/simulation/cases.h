// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "simulation/scanner.h"
#include "simulation/sensor.h"

namespace lisco_simulation {

/// The names that scanCase () accepts.
std::vector<std::string> caseNames();

/// A few words on a case. \throws std::invalid_argument if the name is unknown
std::string describeCase(const std::string& name);

/// Whether a case uses the gap.
bool caseHasGap(const std::string& name);

/// A scan that is a worst case in one way, without ground:
/// - room: a closed, empty room of 8 m x 6 m x 3 m, one cluster
/// - wall: a round wall 1 m away on all sides
/// - random: each return at a random range between 1 and 60 m
/// - sheets: two spheres around the sensor, 5 m and 5 m + gap away, hit alternately by neighbouring cells. Noise moves
///   them apart, so that returns of different spheres are at least the gap apart.
/// - singletons: each return farther than the gap from every other one; cells where none fits have no return
/// - blocked: an obstacle on the sensor's cover, every return nearer than 0.3 m
/// - poles: rings of thin vertical poles between 3 and 15 m away, at least 0.5 m apart
///
/// Objects are numbered: room and walls 1, sheets 1 and 2, poles from 1 on; in random and singletons each cell is an
/// object.
/// \param disturbance noise does not apply to random and singletons
/// \param gap metres, > 0
/// \throws std::invalid_argument if the name is unknown
SimulatedScan scanCase(const std::string& name, const Sensor& sensor, const Disturbance& disturbance, double gap);

}  // namespace lisco_simulation
