// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "random.h"
#include "scanner.h"

namespace lisco_simulation {

// The things that scenes are made of, each on a floor of height 0 around (0, 0), facing x. Sizes vary with the random
// numbers, within what is usual; all lengths in metres.

struct Thing {
  Object object;
  double length;  ///< of what it covers on the floor, along x
};

/// A saloon or an estate car: body with bonnet and boot, a cabin with slanted windows, four wheels.
Thing car(Random& random);
/// The short black car that carries the sensor: nothing of it rises into the view of an HDL-64E 1.8 m up.
Thing sensorCar();
/// What a sensor on a rack sees of the vehicle below: the roof, two bars of the rack, a mast, and a mirror on each side.
/// The sensor is at (0, 0, 0), not the floor. \param drop height of the sensor above the roof, > 0
Thing vehicleTop(double drop);
/// Somebody who stands or walks: legs, torso, arms, head.
Thing person(Random& random);
/// A lamp post with an arm along y, high above all heads.
Thing lampPost(Random& random);
/// A post with a round sign.
Thing signPost(Random& random);
/// A trunk and a crown of leaves.
Thing tree(Random& random);
/// A house with its front at x = 0 towards -x, a door, windows and a pitched roof. \param width of the front
Thing house(Random& random, double width);

Thing table(Random& random);
Thing chair(Random& random);
/// An open bookcase with its back at x = 0, open towards -x, with things on its boards.
Thing shelf(Random& random, double width);
/// Cardboard boxes piled up.
Thing boxes(Random& random);
/// A round column from floor to ceiling.
Thing column(Random& random, double height);

}  // namespace lisco_simulation
