// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/street.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/objects.h"
#include "simulation/random.h"

namespace lisco_simulation {
namespace {

constexpr double kEnds = 75;      // metres of street behind the start and beyond the end
constexpr double kFreeWay = 2.5;  // metres
constexpr double kWalking = 1.3;  // metres per second

/// \param width of the footprint of what is no box, metres
Body bodyOf(Thing thing, double width, Footing footing, const Vector& at, double heading) {
  Body body;
  body.kind = thing.object.kind;
  body.solids = std::move(thing.object.solids);
  body.length = thing.length;
  body.width = thing.height > 0 ? thing.width : width;
  body.height = thing.height;
  body.footing = footing;
  body.at = at;
  body.heading = heading;
  return body;
}

/// One side of the street. At most one argument of a call draws random numbers: the order of arguments would depend on
/// the compiler.
class Side {
 public:
  /// \param side 1: left, -1: right
  Side(World& world, Random& random, double side, double begin, double end)
      : world_(world), random_(random), side_(side), begin_(begin), end_(end) {}

  void add() {
    const double along = side_ < 0 ? 0 : kPi;  // cars face as the traffic does
    repeat(0, 5.2, 12, [&](double x) {
      const double heading = along + random_.between(-0.02, 0.02);
      add(car(random_), 0, Footing::kWheels, x, 4.3, heading);
    });
    repeat(20, 22, 28,
           [&](double x) { add(lampPost(random_), 0.3, Footing::kFounded, x, 6, -side_ * kPi / 2 - kPi / 2); });
    repeat(40, 30, 50, [&](double x) { add(signPost(random_), 0.3, Footing::kFounded, x, 6.3, along); });
    repeat(10, 6, 16, [&](double x) {
      const bool ahead = random_.chance(0.5);
      const double away = random_.between(6.8, 7.6);
      add(person(random_), 0.5, Footing::kFounded, x, away, ahead ? 0 : kPi).velocity = {(ahead ? 1 : -1) * kWalking, 0,
                                                                                         0};
    });
    repeat(10, 9, 15, [&](double x) { add(broadTree(random_), 0.5, Footing::kFounded, x, 8.2, 0); });
    for (Lane walls(begin_, end_); walls.isFree();) {
      const double length = random_.between(6, 14);
      const double middle = walls.take(length);
      add(wall(random_, length), 0, Footing::kFounded, middle, 9.3, kPi / 2);
      walls.take(random_.between(3, 15));
    }
    for (Lane houses(begin_, end_); houses.isFree();) {
      const double width = random_.between(8, 14);
      const double middle = houses.take(width);
      add(house(random_, width), width, Footing::kFounded, middle, 16, side_ * kPi / 2);
      houses.take(random_.between(2, 10));
    }
  }

 private:
  /// A way that is taken from one end to the other.
  class Lane {
   public:
    Lane(double begin, double end) : next_(begin), end_(end) {}
    bool isFree() const { return next_ < end_; }
    /// The middle of the next part of this length.
    double take(double length) {
      next_ += length;
      return next_ - length / 2;
    }

   private:
    double next_, end_;
  };

  /// Calls add (x) from the beginning to the end, at random distances, all in metres.
  /// \param latest of the first from the beginning \param least, most distances
  template <typename Add>
  void repeat(double latest, double least, double most, const Add& add) {
    double x = begin_ + (latest > 0 ? random_.between(0, latest) : 0);
    while (x < end_) {
      add(x);
      x += random_.between(least, most);
    }
  }

  /// \param away from the middle of the road, metres
  Body& add(Thing thing, double width, Footing footing, double x, double away, double heading) {
    const double y = kRoadMiddle + side_ * away;
    world_.bodies.push_back(bodyOf(std::move(thing), width, footing, {x, y, 0}, heading));
    return world_.bodies.back();
  }

  World& world_;
  Random& random_;
  double side_, begin_, end_;
};

void addTraffic(World& world, Random& random, double speed) {
  const auto add = [&](Thing thing, double x, double y, double velocity) {
    Body body = bodyOf(std::move(thing), 0, Footing::kWheels, {x, y, 0}, velocity < 0 ? kPi : 0);
    body.velocity = {velocity, 0, 0};
    world.bodies.push_back(std::move(body));
  };
  const double oncoming = 2 * kRoadMiddle;
  const double ahead = random.between(13, 18);
  add(car(random), ahead, 0, speed + 2);
  const double behind = random.between(-18, -13);
  add(car(random), behind, 0, speed < 0 ? speed : std::max(speed - 2, 0.0));  // never run into
  const double near = random.between(8, 20);
  add(car(random), near, oncoming, -9);
  const double far = random.between(38, 45);
  add(lorry(random), far, oncoming, -8);
  const double past = random.between(-30, -20);
  add(car(random), past, oncoming, -9);
}

}  // namespace

World makeStreet(const Terrain& ground, const Motion& motion, double seconds, double height, unsigned seed) {
  Random random(seed);
  World world{ground, {}, {}};
  double begin = 0;
  double end = 0;
  const double turns = seconds / motion.turn_seconds;
  std::vector<Vector> way;
  const auto samples = static_cast<std::size_t>(std::fabs(motion.speed) * seconds) + 1;
  for (std::size_t i = 0; i <= samples; ++i) {
    way.push_back(motion.placeAfter(turns * static_cast<double>(i) / static_cast<double>(samples)));
    begin = std::min(begin, way.back().x);
    end = std::max(end, way.back().x);
  }
  for (const double side : {1.0, -1.0}) Side(world, random, side, begin - kEnds, end + kEnds).add();
  world.bodies.push_back(bodyOf(bridge(14), 0, Footing::kLevel, {random.between(35, 50), kRoadMiddle, 0}, 0));
  const auto isInTheWay = [&](const Body& body) {
    if (body.footing == Footing::kLevel) return false;
    return std::any_of(way.begin(), way.end(), [&](const Vector& place) {
      return std::hypot(place.x - body.at.x, place.y - body.at.y) < kFreeWay;
    });
  };
  world.bodies.erase(std::remove_if(world.bodies.begin(), world.bodies.end(), isInTheWay), world.bodies.end());
  addTraffic(world, random, motion.speed);
  if (height >= kCarrierHeight)
    for (const Solid& solid : sensorCar().object.solids) world.carrier.push_back(solid.moved({0, 0, -height}));
  return world;
}

}  // namespace lisco_simulation
