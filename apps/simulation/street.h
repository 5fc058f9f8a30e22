// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "simulation/drive.h"
#include "simulation/motion.h"
#include "simulation/terrain.h"

namespace lisco_simulation {

/// The least height at which the sensor has its vehicle below it, metres; a lower one is carried by nothing in view.
constexpr double kCarrierHeight = 1.65;

/// A street along x on a terrain, from 75 m behind the start to 75 m beyond the end of the drive: moving cars and a
/// lorry, parked cars, people who walk, lamp posts, sign posts, an avenue of trees whose crowns reach over the road,
/// walls, houses, a bridge. Objects whose middle is within 2.5 m of the sensor's way are left out, but for traffic.
/// \param seconds of the drive \param height of the sensor, metres
World makeStreet(const Terrain& ground, const Motion& motion, double seconds, double height, unsigned seed);

}  // namespace lisco_simulation
