// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/objects.h"

#include <algorithm>
#include <cmath>

namespace lisco_simulation {
namespace {

constexpr double kWheelProtrudes = 0.02;  // metres

/// Adds the four wheels of a car, on the floor, slightly protruding.
void addWheels(std::vector<Solid>& solids, double front_axle, double rear_axle, double half_width,
               double radius = 0.32) {
  for (const double axle : {front_axle, rear_axle})
    for (const double side : {-1.0, 1.0})
      solids.push_back(Solid::cylinder({axle, side * (half_width - 0.2), radius},
                                       {axle, side * (half_width + kWheelProtrudes), radius}, radius));
}

}  // namespace

Thing car(Random& random) {
  const double half = random.between(4.0, 4.7) / 2;
  const double side = random.between(1.70, 1.84) / 2;
  const double top = random.between(1.42, 1.54);
  const double waist = 0.92;
  const bool estate = random.chance(0.4);
  const double cabin_back = -half + (estate ? 0.08 : 0.75);
  std::vector<Solid> solids = {
      Solid::block({-half, half, -side, side, 0.24}, {-half, half, -side, side, 0.62}),
      // The bonnet falls towards the front, the boot a little towards the back.
      Solid::block({-half, half, -side, side, 0.62},
                   {-half + (estate ? 0.05 : 0.12), half - 0.85, -side + 0.05, side - 0.05, waist}),
      // Windscreen, rear window and side windows are slanted.
      Solid::block({cabin_back, half - 1.0, -side + 0.06, side - 0.06, waist},
                   {cabin_back + (estate ? 0.25 : 0.6), half - 1.75, -side + 0.22, side - 0.22, top})};
  addWheels(solids, half - 0.8, -half + 0.8, side);
  return {{"car", solids}, 2 * half, 2 * (side + kWheelProtrudes), top};
}

Thing sensorCar() {
  constexpr double kHalf = 1.75;
  constexpr double kSide = 0.8;
  std::vector<Solid> solids = {
      Solid::block({-kHalf, kHalf, -kSide, kSide, 0.24}, {-kHalf, kHalf, -kSide, kSide, 0.6}),
      Solid::block({-kHalf, kHalf, -kSide, kSide, 0.6}, {-kHalf + 0.1, kHalf - 0.4, -kSide + 0.05, kSide - 0.05, 0.85}),
      Solid::block({-kHalf + 0.1, kHalf - 0.5, -kSide + 0.05, kSide - 0.05, 0.85}, {-0.7, 0.7, -0.55, 0.55, 1.35}),
      Solid::cylinder({0, 0, 1.35}, {0, 0, 1.65}, 0.05)};  // the sensor's mount
  addWheels(solids, kHalf - 0.6, -kHalf + 0.6, kSide);
  return {{"sensor car", solids}, 2 * kHalf};
}

Thing vehicleTop(double drop) {
  constexpr double kFront = 0.9;
  constexpr double kBack = -1.1;
  constexpr double kSide = 0.7;
  std::vector<Solid> solids = {Solid::box({kBack, -kSide, -drop - 0.05}, {kFront, kSide, -drop})};
  // Each bar has a post on the roof at both ends.
  constexpr double kBar = 0.02;
  constexpr double kBarSide = 0.6;
  for (const double x : {-0.55, 0.5}) {
    const double z = -0.5 * drop;
    solids.push_back(Solid::cylinder({x, -kBarSide, z}, {x, kBarSide, z}, kBar));
    for (const double y : {-kBarSide, kBarSide}) solids.push_back(Solid::cylinder({x, y, -drop}, {x, y, z}, kBar));
  }
  solids.push_back(Solid::cylinder({-0.2, 0.12, -drop}, {-0.2, 0.12, 0.4}, 0.025));  // an aerial's mast
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * 0.84;
    const double outer = side * 1.0;
    solids.push_back(
        Solid::box({0.6, std::min(inner, outer), -drop - 0.3}, {0.68, std::max(inner, outer), -drop - 0.05}));
  }
  return {{"vehicle", solids}, kFront - kBack};
}

Thing person(Random& random) {
  const double scale = random.between(1.58, 1.90) / 1.8;
  const double stride = random.between(0, 0.22);
  const double swing = random.between(0, 0.2);
  std::vector<Solid> solids;
  const auto limb = [&](const Vector& from, const Vector& to, double radius) {
    solids.push_back(Solid::cylinder(scale * from, scale * to, scale * radius));
  };
  limb({0, 0.09, 0.9}, {stride, 0.1, 0}, 0.075);
  limb({0, -0.09, 0.9}, {-stride, -0.1, 0}, 0.075);
  limb({0, 0.21, 1.45}, {-swing, 0.27, 0.85}, 0.048);
  limb({0, -0.21, 1.45}, {swing, -0.27, 0.85}, 0.048);
  limb({0, 0, 1.4}, {0, 0, 1.6}, 0.055);
  solids.push_back(Solid::ellipsoid(scale * Vector{0, 0, 1.2}, scale * Vector{0.13, 0.21, 0.38}));
  solids.push_back(Solid::ellipsoid(scale * Vector{0, 0, 1.68}, scale * Vector{0.1, 0.085, 0.12}));
  return {{"person", solids}, 0.7};
}

Thing lampPost(Random& random) {
  const double height = random.between(5.5, 7);
  return {{"lamp post",
           {Solid::cylinder({0, 0, 0}, {0, 0, 0.9}, 0.11), Solid::cylinder({0, 0, 0.9}, {0, 0, height}, 0.07),
            Solid::cylinder({0, 0, height}, {0, 1.3, height + 0.2}, 0.05),
            Solid::box({-0.12, 1.2, height + 0.1}, {0.12, 1.8, height + 0.25})}},
          0.3};
}

Thing signPost(Random& random) {
  const double height = random.between(2.1, 2.5);
  return {{"sign post",
           {Solid::cylinder({0, 0, 0}, {0, 0, height}, 0.045),
            Solid::cylinder({-0.07, 0, height - 0.3}, {-0.04, 0, height - 0.3}, 0.32)}},
          0.65};
}

Thing tree(Random& random) {
  const double trunk = random.between(0.12, 0.2);
  const double clear = random.between(1.3, 1.7);  // height of the lowest leaves
  const double radius = random.between(1.15, 1.5);
  const double height = random.between(1.5, 2.2);  // half of the crown's
  const double middle = clear + height;
  constexpr double kMeanDepth = 0.35;
  std::vector<Solid> solids = {Solid::cylinder({0, 0, 0}, {0, 0, middle}, trunk)};
  solids.push_back(Solid::ellipsoid({0, 0, middle}, {0.75 * radius, 0.75 * radius, height}).ofLeaves(kMeanDepth));
  const double turn = random.between(0, 2 * kPi);
  for (int bough = 0; bough < 5; ++bough) {
    const double angle = turn + 2 * kPi * bough / 5 + random.between(-0.3, 0.3);
    const double reach = random.between(0.5, 0.6) * radius;
    const double extent = radius - reach;
    const double z = random.between(clear + 1.3 * extent, clear + 1.3 * height);
    solids.push_back(
        Solid::ellipsoid({reach * std::cos(angle), reach * std::sin(angle), z}, {extent, extent, 1.2 * extent})
            .ofLeaves(kMeanDepth));
  }
  return {{"tree", solids}, 2 * radius};
}

Thing broadTree(Random& random) {
  const double trunk = random.between(0.15, 0.28);
  const double clear = random.between(2.4, 3.2);
  const double radius = random.between(2.2, 3.2);
  const double height = random.between(1.8, 2.6);  // half of the crown's
  const double middle = clear + height;
  return {{"tree",
           {Solid::cylinder({0, 0, 0}, {0, 0, middle}, trunk),
            Solid::ellipsoid({0, 0, middle}, {radius, radius, height}).ofLeaves(0.6)}},
          2 * trunk};
}

Thing wall(Random& random, double length) {
  const double half = random.between(0.1, 0.15);
  const double height = random.between(0.9, 2.2);
  return {{"wall", {Solid::box({-half, -length / 2, 0}, {half, length / 2, height})}}, 2 * half, length, height};
}

Thing lorry(Random& random) {
  const double half = random.between(7, 9) / 2;
  const double top = random.between(3.1, 3.7);
  constexpr double kSide = 1.2;
  constexpr double kCab = 1.9;
  std::vector<Solid> solids = {Solid::box({-half, -kSide, 1.1}, {half - kCab - 0.3, kSide, top}),
                               Solid::box({-half + 0.3, -0.5, 0.8}, {half - kCab, 0.5, 1.1}),
                               Solid::box({half - kCab, -kSide, 0.5}, {half, kSide, 2.7})};
  addWheels(solids, half - 1, -half + 1.6, kSide - 0.1, 0.48);
  return {{"lorry", solids}, 2 * half, 2 * kSide, top};
}

Thing bridge(double span) {
  constexpr double kClear = 4.7;
  constexpr double kDeck = 0.9;
  constexpr double kHalf = 3.5;  // of its width
  constexpr double kDepth = 12;  // of the piers' feet, in the ground on any terrain
  const double inner = span / 2;
  const double outer = inner + 9;
  std::vector<Solid> solids = {Solid::box({-kHalf, -outer - 1, kClear}, {kHalf, outer + 1, kClear + kDeck})};
  for (const double side : {-1.0, 1.0}) {
    solids.push_back(Solid::box({side * kHalf - 0.1, -outer - 1, kClear + kDeck},
                                {side * kHalf + 0.1, outer + 1, kClear + kDeck + 1}));  // parapets
    for (const double y : {inner + 0.5, outer})
      solids.push_back(Solid::box({-kHalf + 0.5, side * y - 0.5, -kDepth}, {kHalf - 0.5, side * y + 0.5, kClear}));
  }
  return {{"bridge", solids}, 2 * kHalf};
}

Thing house(Random& random, double width) {
  const int storeys = random.chance(0.5) ? 2 : 3;
  const double storey = random.between(2.7, 3.1);
  const double height = storeys * storey;
  const double depth = random.between(6, 8);
  constexpr double kRecess = 0.18;  // of windows and door behind the front
  const double half = width / 2;
  std::vector<Solid> solids = {Solid::box({kRecess, -half, 0}, {depth, half, height}),
                               Solid::block({-0.2, depth + 0.2, -half, half, height},
                                            {depth / 2, depth / 2, -half, half, height + depth / 2.5})};
  const auto front = [&](double right, double left, double low, double high) {
    if (left > right) solids.push_back(Solid::box({0, right, low}, {kRecess, left, high}));
  };
  // The front is bands of wall below and above the windows, and piers between them.
  const int windows = std::max(2, static_cast<int>(width / random.between(2.2, 2.8)));
  const double axis = width / windows;  // from window to window
  const double pane = std::min(1.3, 0.55 * axis);
  const int door = static_cast<int>(random.between(0, windows));
  for (int floor = 0; floor < storeys; ++floor) {
    const double base = floor * storey;
    const double sill = base + 0.9;
    const double lintel = base + 2.2;
    front(-half, half, lintel, base + storey);
    for (int pier = 0; pier <= windows; ++pier)
      front(std::max(-half, -half + (pier - 1) * axis + (axis + pane) / 2),
            std::min(half, -half + pier * axis + (axis - pane) / 2), sill, lintel);
    if (floor > 0) {
      front(-half, half, base, sill);
      continue;
    }
    const double door_right = -half + door * axis + (axis - pane) / 2;
    front(-half, door_right, base, sill);
    front(door_right + pane, half, base, sill);
  }
  return {{"house", solids}, depth + 0.4};
}

Thing table(Random& random) {
  const double length = random.between(1.1, 1.35) / 2;
  const double width = random.between(0.7, 0.9) / 2;
  constexpr double kHeight = 0.74;
  std::vector<Solid> solids = {Solid::box({-length, -width, kHeight - 0.04}, {length, width, kHeight})};
  for (const double x : {-length + 0.06, length - 0.06})
    for (const double y : {-width + 0.06, width - 0.06})
      solids.push_back(Solid::box({x - 0.03, y - 0.03, 0}, {x + 0.03, y + 0.03, kHeight - 0.04}));
  // Often a screen or a pile of books.
  if (random.chance(0.7)) {
    const double x = random.between(-0.5, 0.5) * length;
    solids.push_back(random.chance(0.5) ? Solid::box({x - 0.25, 0, kHeight}, {x + 0.25, 0.05, kHeight + 0.42})
                                        : Solid::box({x - 0.15, -0.1, kHeight}, {x + 0.15, 0.1, kHeight + 0.25}));
  }
  return {{"table", solids}, 2 * length};
}

Thing chair(Random& random) {
  const double half = random.between(0.42, 0.48) / 2;
  const double back = random.between(0.85, 0.98);
  std::vector<Solid> solids = {
      Solid::box({-half, -half, 0.42}, {half, half, 0.46}),
      Solid::block({-half, -half + 0.04, -half, half, 0.6}, {-half - 0.05, -half, -half + 0.03, half - 0.03, back})};
  for (const double y : {-half + 0.03, half - 0.03}) {
    solids.push_back(Solid::cylinder({half - 0.03, y, 0}, {half - 0.03, y, 0.44}, 0.025));
    solids.push_back(Solid::cylinder({-half + 0.02, y, 0}, {-half + 0.02, y, 0.7}, 0.025));
  }
  return {{"chair", solids}, 0.7};
}

Thing shelf(Random& random, double width) {
  const double height = random.between(1.8, 2.2);
  constexpr double kDepth = 0.35;
  constexpr double kBoard = 0.03;
  const double half = width / 2;
  std::vector<Solid> solids = {Solid::box({-kBoard, -half, 0}, {0, half, height}),
                               Solid::box({-kDepth, -half, 0}, {0, -half + kBoard, height}),
                               Solid::box({-kDepth, half - kBoard, 0}, {0, half, height})};
  constexpr int kBoards = 6;
  for (int board = 0; board < kBoards; ++board) {
    const double z = 0.05 + (height - 0.05 - kBoard) * board / (kBoards - 1);
    solids.push_back(Solid::box({-kDepth, -half, z}, {0, half, z + kBoard}));
    if (board + 1 == kBoards) break;
    for (double y = -half + kBoard; y < half - 0.3; y += random.between(0.25, 0.6)) {
      if (!random.chance(0.6)) continue;
      const double depth = random.between(0.18, 0.32);
      const double width_here = random.between(0.1, 0.25);
      const double height_here = random.between(0.12, 0.27);
      solids.push_back(Solid::box({-depth, y, z + kBoard}, {0, y + width_here, z + kBoard + height_here}));
    }
  }
  return {{"shelf", solids}, kDepth};
}

Thing boxes(Random& random) {
  std::vector<Solid> solids;
  double z = 0;
  const int count = 1 + static_cast<int>(random.between(0, 4));
  for (int box = 0; box < count; ++box) {
    const double length = random.between(0.2, 0.32);
    const double width = random.between(0.2, 0.32);
    const double height = random.between(0.28, 0.5);
    solids.push_back(
        Solid::box({-length, -width, 0}, {length, width, height}).rotated(random.between(-0.3, 0.3)).moved({0, 0, z}));
    z += height;
  }
  return {{"boxes", solids}, 0.85};
}

Thing column(Random& random, double height) {
  const double radius = random.between(0.15, 0.25);
  return {{"column", {Solid::cylinder({0, 0, 0}, {0, 0, height}, radius)}}, 2 * radius};
}

}  // namespace lisco_simulation
