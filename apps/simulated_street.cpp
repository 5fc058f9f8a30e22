// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulated_street.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace lisco_apps {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMiss = std::numeric_limits<double>::infinity();

/// A ray from the sensor, which stands at (0, 0, 0), with a direction of length 1.
struct Ray {
  double x, y, z;
};

/// A box turned about the vertical axis.
struct Block {
  double x, y, z;                ///< centre, metres
  double length, width, height;  ///< metres
  double heading;                ///< radians

  double distanceAlong(const Ray& ray) const {
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    const double origin[3] = {-(c * x + s * y), s * x - c * y, -z};
    const double direction[3] = {c * ray.x + s * ray.y, c * ray.y - s * ray.x, ray.z};
    const double half[3] = {length / 2, width / 2, height / 2};
    double enter = 0;
    double leave = kMiss;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) {
        if (std::fabs(origin[axis]) > half[axis]) return kMiss;
        continue;
      }
      const double a = (-half[axis] - origin[axis]) / direction[axis];
      const double b = (half[axis] - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter > 0 && enter <= leave ? enter : kMiss;
  }
};

/// An upright cylinder without its caps: poles, trunks, legs and bodies.
struct Post {
  double x, y, radius, bottom, top;

  double distanceAlong(const Ray& ray) const {
    const double a = ray.x * ray.x + ray.y * ray.y;
    const double b = ray.x * x + ray.y * y;
    const double discriminant = b * b - a * (x * x + y * y - radius * radius);
    if (discriminant < 0) return kMiss;
    const double distance = (b - std::sqrt(discriminant)) / a;
    const double height = distance * ray.z;
    return distance > 0 && height >= bottom && height <= top ? distance : kMiss;
  }
};

/// A ball: crowns and heads.
struct Ball {
  double x, y, z, radius;

  double distanceAlong(const Ray& ray) const {
    const double b = ray.x * x + ray.y * y + ray.z * z;
    const double discriminant = b * b - (x * x + y * y + z * z - radius * radius);
    return discriminant >= 0 && b > std::sqrt(discriminant) ? b - std::sqrt(discriminant) : kMiss;
  }
};

class Street {
 public:
  explicit Street(std::mt19937& random) {
    const auto between = [&random](double lo, double hi) { return std::uniform_real_distribution<>(lo, hi)(random); };
    for (const double side : {-1.0, 1.0}) {
      // Houses with gaps between them, then parked cars, trees and lamps along the kerb.
      for (double x = -70; x < 70;) {
        const double front = between(9, 16);
        const double set_back = between(11, 14);
        addBlock(x + front / 2, side * (set_back + 4), front, 8, between(5, 12), 0);
        x += front + between(1.5, 6);
      }
      for (double x = -48; x < 48; x += between(6.2, 11)) addCar(x, side * between(4.4, 4.8), between(-0.04, 0.04));
      for (double x = -55; x < 55; x += between(9, 15)) addTree(x, side * between(7.0, 7.6), between(1.0, 1.8));
      for (double x = -60; x < 60; x += 24) posts_.push_back({x + 3, side * 6.3, 0.08, kGround, kGround + 6});
      for (int i = 0; i < 7; ++i) addPerson(between(-30, 30), side * between(8.3, 10.0));
    }
    addCar(14, -1.6, 0);
    addCar(-19, 1.7, kPi);
  }

  /// Range of the first thing a ray meets, metres.
  double rangeAlong(const Ray& ray) const {
    double nearest = ray.z < 0 ? kGround / ray.z : kMiss;
    for (const auto& block : blocks_) nearest = std::min(nearest, block.distanceAlong(ray));
    for (const auto& post : posts_) nearest = std::min(nearest, post.distanceAlong(ray));
    for (const auto& ball : balls_) nearest = std::min(nearest, ball.distanceAlong(ray));
    return nearest;
  }

 private:
  static constexpr double kGround = static_cast<double>(kStreetZ);

  void addBlock(double x, double y, double length, double width, double height, double heading, double lift = 0) {
    blocks_.push_back({x, y, kGround + lift + height / 2, length, width, height, heading});
  }
  void addCar(double x, double y, double heading) {
    addBlock(x, y, 4.3, 1.75, 0.65, heading, 0.3);
    addBlock(x - 0.2 * std::cos(heading), y - 0.2 * std::sin(heading), 2.3, 1.55, 0.55, heading, 0.95);
    for (const double along : {-1.35, 1.35})
      for (const double across : {-0.75, 0.75})
        posts_.push_back({x + along * std::cos(heading) - across * std::sin(heading),
                          y + along * std::sin(heading) + across * std::cos(heading), 0.22, kGround, kGround + 0.5});
  }
  void addTree(double x, double y, double crown) {
    posts_.push_back({x, y, 0.16, kGround, kGround + 3});
    balls_.push_back({x, y, kGround + 2.2 + crown, crown});
  }
  void addPerson(double x, double y) {
    posts_.push_back({x, y, 0.22, kGround, kGround + 1.5});
    balls_.push_back({x, y, kGround + 1.62, 0.13});
  }

  std::vector<Block> blocks_;
  std::vector<Post> posts_;
  std::vector<Ball> balls_;
};

}  // namespace

Cloud::Ptr simulateStreet(unsigned seed) {
  constexpr int kLasers = 64;
  constexpr int kColumns = 1800;
  constexpr double kFarthest = 80;
  constexpr double kRangeNoise = 0.02;
  constexpr double kTopElevation = 2.0 * kPi / 180;
  constexpr double kBottomElevation = -24.8 * kPi / 180;

  std::mt19937 random(seed);
  const Street street(random);
  std::normal_distribution<> noise(0, kRangeNoise);

  auto cloud = std::make_shared<Cloud>(kColumns, kLasers);
  cloud->is_dense = false;
  for (int column = 0; column < kColumns; ++column)
    for (int laser = 0; laser < kLasers; ++laser) {
      const double azimuth = kPi - 2 * kPi * column / kColumns;
      const double elevation = kTopElevation + (kBottomElevation - kTopElevation) * laser / (kLasers - 1);
      const Ray ray{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                    std::sin(elevation)};
      double range = street.rangeAlong(ray);
      range = range <= kFarthest ? range + noise(random) : std::numeric_limits<double>::quiet_NaN();
      cloud->at(column, laser) = {static_cast<float>(range * ray.x), static_cast<float>(range * ray.y),
                                  static_cast<float>(range * ray.z)};
    }
  return cloud;
}

}  // namespace lisco_apps
