// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>

#include "simulation/scanner.h"

namespace lisco_simulation {

/// Scenes are numbered from 1 to this.
constexpr int kScenes = 5;

/// Returns of each scene in the paper, without the ground.
constexpr std::size_t kReturnsInPaper[kScenes] = {26891, 16218, 39028, 18229, 64518};

/// One of the five scenes of the paper's evaluation (subsection "Data"), rebuilt from their description:
/// 1 a few objects near the sensor, 2 the same objects far away, 3 many objects near, 4 the same many far away,
/// 5 a closed, crowded room.
///
/// The sensor is 1.8 m above the ground, on a car (in the room: on a column). In scenes 3 and 4 a row of cars is
/// parked on each side, with gaps of 0.5 to 0.85 m. Objects are at least 0.4 m apart, except the shelves of the room,
/// which stand against its walls.
///
/// The layout is drawn from the seed. One value is fitted to the paper: the distance of the objects ahead, behind, to
/// the left and to the right (in the room: its size), so that the default scan of a default HDL-64E with this seed has
/// the paper's number of returns with z >= ground_z, to one in a thousand. A scene depends on its number and the seed
/// only.
/// \param number 1 to 5
/// \throws std::invalid_argument if the number is unknown
Scene makeScene(int number, unsigned seed);

/// A scene with a given distance. \param distance metres, >= 0
Scene layOutScene(int number, unsigned seed, double distance);

/// Returns nearer to the sensor than this lie on its own vehicle, metres.
constexpr double kVehicleRange = 1.5;
/// The part of all returns, the ground's included, that lie on the sensor's own vehicle.
constexpr double kVehicleShare = 0.25;

/// Adds the vehicle that carries the sensor as the last object, all of it nearer than kVehicleRange. The height of the
/// sensor above the roof is fitted so that kVehicleShare of the returns of the default scan of a default HDL-64E with
/// this seed are nearer than kVehicleRange.
void addVehicle(Scene& scene, unsigned seed);

}  // namespace lisco_simulation
