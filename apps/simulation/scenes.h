// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>

#include "scanner.h"

namespace lisco_simulation {

/// How many scenes there are; their numbers start at 1.
constexpr int kScenes = 5;

/// How many returns each scene gave the paper's authors, without the ground's.
constexpr std::size_t kReturnsInPaper[kScenes] = {26891, 16218, 39028, 18229, 64518};

/// One of the five scenes on which Lisco's paper was evaluated (its subsection "Data"), rebuilt from its words:
/// 1 a few objects near the sensor, 2 the same objects far away, 3 many objects near, 4 the same many far away,
/// 5 a closed, crowded room.
///
/// The sensor stands 1.8 m above the ground, on a black car (in the room: on a column). In scenes 3 and 4 a row of cars
/// is parked on each side, with gaps of 0.5 to 0.85 m between them. No two objects are nearer to each other than 0.4 m,
/// but for the shelves of the room, which stand against its walls.
///
/// What stands where is drawn from the seed. Only one thing is fitted to the paper: how far away the objects ahead,
/// behind, to the left and to the right are, all by the same distance (in the room: how large it is). It is chosen so
/// that a default HDL-64E's default scan with this seed has as many returns with z >= ground_z as the paper names, to
/// one in a thousand. So a scene depends on its number and the seed, and on nothing else.
/// \param number 1 to 5
/// \throws std::invalid_argument if there is no such scene
Scene makeScene(int number, unsigned seed);

/// The same with the distance given instead of fitted. \param distance metres, >= 0
Scene layOutScene(int number, unsigned seed, double distance);

/// What is nearer to the sensor than this is its own vehicle, metres.
constexpr double kVehicleRange = 1.5;
/// The part of all returns, the ground's included, that lie on the sensor's own vehicle.
constexpr double kVehicleShare = 0.25;

/// Adds the vehicle that carries the sensor as the last object, all of it nearer than kVehicleRange: on many vehicles the
/// sensor stands so low that it sees the roof, a rack, a mast. Only how high the sensor stands above the roof is fitted,
/// so that kVehicleShare of the returns of a default HDL-64E's default scan with this seed are nearer than kVehicleRange.
void addVehicle(Scene& scene, unsigned seed);

}  // namespace lisco_simulation
