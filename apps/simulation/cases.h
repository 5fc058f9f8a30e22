// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "scanner.h"
#include "sensor.h"

namespace lisco_simulation {

/// The names scanCase() knows.
std::vector<std::string> caseNames();

/// What a case is, in a few words. \throws std::invalid_argument if there is no such case
std::string describeCase(const std::string& name);

/// Whether a case makes use of the gap.
bool caseHasGap(const std::string& name);

/// A scan that is as hard as a scan can be in one way, with no ground in it:
/// - room: a closed, empty room of 8 m x 6 m x 3 m, one cluster
/// - wall: a round wall 1 m away on all sides
/// - random: each return at a range of its own between 1 and 60 m
/// - sheets: two balls around the sensor, 5 m and 5 m + gap away, of which neighbouring cells see one and the other in
///   turn. Noise only moves them apart: no return of one is nearer than the gap to one of the other.
/// - singletons: each return farther than the gap from every other one; a cell where no such place is found has none
/// - blocked: something on the sensor's cover, so that every return is nearer than 0.3 m
/// - poles: rings of thin vertical poles between 3 and 15 m away, at least 0.5 m apart
/// The returns bear the number of what they lie on: room and walls 1, sheets 1 and 2, poles from 1 on. Where each lies on
/// something else (random, singletons), the numbers count the cells from 1 on.
/// \param disturbance drop-outs; noise too, but where the case says otherwise or ranges are random as they are
/// \param gap metres, > 0
/// \throws std::invalid_argument if there is no such case
Scan scanCase(const std::string& name, const Sensor& sensor, const Disturbance& disturbance, double gap);

}  // namespace lisco_simulation
