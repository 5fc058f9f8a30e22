// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "simulation/random.h"
#include "simulation/scanner.h"

namespace lisco_simulation {

// The objects of scenes, each on a floor of height 0 around (0, 0), facing x. Sizes vary within usual limits by the
// random numbers; all lengths in metres.

struct Thing {
  Object object;
  double length;  ///< along x on the floor
  // The extents of those that are boxes but for details, 0: of others.
  double width = 0;   ///< along y
  double height = 0;  ///< above the floor
};

/// A saloon or an estate car with bonnet, boot, slanted windows and wheels.
Thing car(Random& random);
/// The short car that carries the sensor, all of it below the view of an HDL-64E 1.8 m up.
Thing sensorCar();
/// The parts of a vehicle in view of a sensor on its rack: the roof, two bars of the rack, a mast, and two mirrors.
/// Relative to the sensor at (0, 0, 0). \param drop height of the sensor above the roof, > 0
Thing vehicleTop(double drop);
/// A standing or walking person: legs, torso, arms, head.
Thing person(Random& random);
/// A lamp post with an arm along y.
Thing lampPost(Random& random);
/// A post with a round sign.
Thing signPost(Random& random);
/// A trunk and a crown of leaves.
Thing tree(Random& random);
/// A house with its front at x = 0 towards -x, a door, windows and a pitched roof. \param width of the front
Thing house(Random& random, double width);

/// A tree of an avenue, whose crown begins above head height and reaches over the road.
Thing broadTree(Random& random);
/// A free-standing wall along y. \param length metres
Thing wall(Random& random, double length);
/// A lorry whose box stands 1.1 m above the ground on its wheels.
Thing lorry(Random& random);
/// A bridge along y across a street along x: a level deck 4.7 m above the middle, on four piers. \param span metres
/// between the inner piers
Thing bridge(double span);

Thing table(Random& random);
Thing chair(Random& random);
/// A bookcase with its back at x = 0, open towards -x, with objects on its boards.
Thing shelf(Random& random, double width);
/// A pile of cardboard boxes.
Thing boxes(Random& random);
/// A round column from floor to ceiling.
Thing column(Random& random, double height);

}  // namespace lisco_simulation
