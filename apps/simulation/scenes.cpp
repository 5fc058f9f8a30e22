// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/scenes.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "simulation/objects.h"
#include "simulation/random.h"

namespace lisco_simulation {
namespace {

/// A thing and its place in a group. Brace initialization draws the random numbers from left to right; the order of
/// function arguments would depend on the compiler.
struct Placed {
  Thing thing;
  double away;     ///< from the beginning of the group, away from the sensor, metres
  double across;   ///< to the left as seen from the sensor, metres
  double heading;  ///< of the thing's x axis, radians, 0: away from the sensor
};

/// Things in one direction from the sensor, at a common distance.
class Group {
 public:
  Group(Scene& scene, double direction, double distance) : scene_(scene), direction_(direction), distance_(distance) {}

  void add(const Placed& placed) {
    Object object{placed.thing.object.kind, {}};
    const Vector place = rotated({distance_ + placed.away, placed.across, scene_.floor_z}, direction_);
    for (const Solid& solid : placed.thing.object.solids)
      object.solids.push_back(solid.rotated(placed.heading + direction_).moved(place));
    scene_.objects.push_back(std::move(object));
  }

 private:
  Scene& scene_;
  double direction_, distance_;
};

constexpr double kRoomHeight = 3;  // metres

/// Metres; with less, things of two groups would touch each other in the room.
constexpr double kMinRoomDistance = 1.5;

constexpr double kAhead = 0;
constexpr double kLeft = kPi / 2;
constexpr double kBehind = kPi;
constexpr double kRight = -kPi / 2;

/// A heading along the street, either way, for a group beside it.
double alongStreet(Random& random) {
  const double heading = random.chance(0.5) ? kPi / 2 : -kPi / 2;
  return heading + random.between(-0.02, 0.02);
}

/// A lane of limited length along which things are placed one after the other.
class Lane {
 public:
  Lane(double first, double last) : next_(first), last_(last) {}

  /// \param width of the next thing \param gap to the one after it \param middle receives its position
  /// \return whether it fits
  bool take(double width, double gap, double& middle) {
    if (next_ + width > last_) return false;
    middle = next_ + width / 2;
    next_ += width + gap;
    return true;
  }

 private:
  double next_, last_;
};

void addFewObjects(Scene& scene, Random& random, double distance) {
  for (const double direction : {kLeft, kRight}) {
    Group group(scene, direction, distance);
    group.add({car(random), 3.2, random.between(-2.5, 2.5), alongStreet(random)});
    group.add({person(random), 5.4, random.between(-6, 6), random.between(-kPi, kPi)});
    group.add({tree(random), 7.8, random.between(-9, -3), 0});
    group.add({lampPost(random), 5.8, random.between(7, 9), kPi / 2});
    group.add({house(random, random.between(19, 23)), 10.5, random.between(-2, 2), 0});
  }
  for (const double direction : {kAhead, kBehind}) {
    Group group(scene, direction, distance);
    group.add({car(random), 8, random.between(-1, 1), random.chance(0.5) ? 0 : kPi});
    group.add({person(random), 13, random.between(-1.5, 1.5), kPi / 2});
    group.add({house(random, random.between(14, 17)), 18, random.between(-1, 1), 0});
  }
}

void addManyObjects(Scene& scene, Random& random, double distance) {
  for (const double direction : {kLeft, kRight}) {
    Group group(scene, direction, distance);
    const double facing = random.chance(0.5) ? kPi / 2 : -kPi / 2;  // all cars of a side alike
    double middle = 0;
    for (Lane row(random.between(-13, -12), 13.5);;) {
      const Thing parked = car(random);
      if (!row.take(parked.length, random.between(0.5, 0.85), middle)) break;
      group.add({parked, 3.2, middle, facing});
    }
    for (Lane pavement(random.between(-15, -13), 15); pavement.take(0.7, random.between(2.5, 6), middle);)
      group.add({person(random), random.between(5.4, 5.7), middle, random.between(-kPi, kPi)});
    for (Lane trees(random.between(-17, -15), 16); trees.take(3, random.between(1.2, 4), middle);)
      group.add({random.chance(0.65) ? tree(random) : lampPost(random), 8.2, middle, kPi / 2});
    for (Lane houses(random.between(-20, -18), 21); houses.take(9, random.between(1, 3), middle);)
      group.add({house(random, random.between(7.5, 9)), 11, middle, 0});
  }
  for (const double direction : {kAhead, kBehind}) {
    Group group(scene, direction, distance);
    group.add({car(random), 8, random.between(0.6, 1), 0});
    group.add({person(random), 7, -1.5, kPi / 2});
    group.add({person(random), 12.2, random.between(-1.8, -0.5), kPi / 2});
    group.add({person(random), 12.2, random.between(0.5, 1.8), -kPi / 2});
    group.add({car(random), 15.5, random.between(-1, -0.6), kPi});
    group.add({signPost(random), 19.5, random.between(2, 3), 0});
    group.add({tree(random), 22, random.between(-5, -1), 0});
    group.add({house(random, random.between(15, 18)), 26, random.between(-1, 1), 0});
  }
}

void addRoom(Scene& scene, Random& random, double distance) {
  constexpr double kDepth = 2.6;  // from the nearest things to the walls
  const double half = distance + kDepth;
  // Walls and ceiling are one object.
  const double floor = scene.floor_z;
  const double top = floor + kRoomHeight;
  Object shell{"walls and ceiling", {}};
  constexpr double kThick = 0.3;
  shell.solids.push_back(
      Solid::box({-half - kThick, -half - kThick, top}, {half + kThick, half + kThick, top + kThick}));
  for (const double direction : {kAhead, kLeft, kBehind, kRight})
    shell.solids.push_back(
        Solid::box({half, -half - kThick, floor}, {half + kThick, half + kThick, top}).rotated(direction));
  scene.objects.push_back(std::move(shell));

  for (const double direction : {kAhead, kLeft, kBehind, kRight}) {
    Group group(scene, direction, distance);
    double middle = 0;
    // From the sensor to the wall: people; tables and chairs in turn; shelves.
    for (Lane people(-1.1, 1.1); people.take(0.75, random.between(0.5, 0.6), middle);)
      group.add({person(random), 0, middle, random.between(-kPi, kPi)});
    bool seat = random.chance(0.3);
    for (Lane tables(-2.2, 2.2);; seat = !seat) {
      const Thing thing = seat ? chair(random) : table(random);
      if (!tables.take(thing.length, random.between(0.5, 0.6), middle)) break;
      group.add({thing, 1.25, middle, seat ? random.between(-kPi, kPi) : kPi / 2});
    }
    for (Lane shelves(random.between(-3.4, -3.3), 3.4); shelves.take(1.6, random.between(0.5, 0.6), middle);)
      group.add({shelf(random, 1.6), kDepth, middle, 0});
    // Between this group and the next, at the distance of both.
    Group corner(scene, direction + kPi / 4, std::sqrt(2.0) * distance);
    const bool sideways = direction == kLeft || direction == kRight;
    corner.add({sideways ? column(random, kRoomHeight) : boxes(random), std::sqrt(2.0) * 1.4,
                random.between(-0.15, 0.15), random.between(-kPi, kPi)});
  }
}

/// Adds the mount of the sensor, out of view of the paper's sensor.
void addMount(Scene& scene, int number) {
  Thing mount = number < 5 ? sensorCar() : Thing{{"sensor column", {Solid::cylinder({}, {0, 0, 1.65}, 0.12)}}, 0.24};
  Object object{mount.object.kind, {}};
  for (const Solid& solid : mount.object.solids) object.solids.push_back(solid.moved({0, 0, scene.floor_z}));
  scene.objects.push_back(std::move(object));
}

}  // namespace

Scene layOutScene(int number, unsigned seed, double distance) {
  if (number < 1 || number > kScenes)
    throw std::invalid_argument("there are scenes 1 to 5, but no scene " + std::to_string(number));
  // Scenes 1 and 2 draw the same numbers, as do 3 and 4.
  Random random(seed);
  Scene scene;
  addMount(scene, number);
  if (number <= 2)
    addFewObjects(scene, random, distance);
  else if (number <= 4)
    addManyObjects(scene, random, distance);
  else
    addRoom(scene, random, distance);
  return scene;
}

Scene makeScene(int number, unsigned seed) {
  const Sensor sensor = makeSensor(simulatedSensors().front());
  Disturbance disturbance;
  disturbance.seed = seed;
  // Bisection: returns decrease with the distance, except for small fluctuations, so the best scene is kept.
  Scene best;
  std::size_t least_error = std::numeric_limits<std::size_t>::max();
  constexpr int kMaxHalvings = 24;
  constexpr double kMaxDistance = 40;      // metres
  constexpr std::size_t kAccuracy = 1000;  // one return in so many
  double near = number == 5 ? kMinRoomDistance : 0;
  double far = kMaxDistance;
  for (int halving = 0; halving < kMaxHalvings; ++halving) {
    const double distance = (near + far) / 2;
    Scene scene = layOutScene(number, seed, distance);
    const std::size_t wanted = kReturnsInPaper[number - 1];
    const std::size_t returns = scan(scene, sensor, disturbance).returnsAbove(scene.ground_z);
    (returns > wanted ? near : far) = distance;
    const std::size_t error = returns > wanted ? returns - wanted : wanted - returns;
    if (error >= least_error) continue;
    least_error = error;
    best = std::move(scene);
    if (error <= wanted / kAccuracy) break;
  }
  return best;
}

void addVehicle(Scene& scene, unsigned seed) {
  const Sensor sensor = makeSensor(simulatedSensors().front());
  Disturbance disturbance;
  disturbance.seed = seed;
  scene.objects.emplace_back();
  // Bisection: returns of the roof decrease with the height of the sensor above it.
  double low = 0.1;
  double high = 0.5;
  for (int halving = 0; halving < 16; ++halving) {
    const double drop = (low + high) / 2;
    scene.objects.back() = vehicleTop(drop).object;
    const SimulatedScan rotation = scan(scene, sensor, disturbance);
    const double share =
        static_cast<double>(rotation.returnsWithin(kVehicleRange)) / static_cast<double>(rotation.returns());
    if (std::fabs(share - kVehicleShare) < 0.001) break;
    (share > kVehicleShare ? low : high) = drop;
  }
}

}  // namespace lisco_simulation
