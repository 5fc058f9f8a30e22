// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "simulation/vector.h"

namespace lisco_simulation {

/// The ground: one height at each position, of unlimited extent. A height along one axis that is linear between knots,
/// or a sum of plane waves.
class Terrain {
 public:
  struct Knot {
    double at, z;  ///< position on the axis and height, metres
  };
  /// amplitude * sin (kx x + ky y + phase)
  struct Wave {
    double amplitude, kx, ky, phase;  ///< metres, radians per metre, radians
  };

  /// Flat ground of height z.
  explicit Terrain(double z = 0);
  /// \param knots at ascending positions; beyond the ends the height goes on as between the last two
  static Terrain along(const Vector& axis, std::vector<Knot> knots);
  static Terrain ofWaves(std::vector<Wave> waves);

  double height(double x, double y) const;

  /// Where a ray meets the ground from above, metres; infinity: nowhere within max_range. Waves are sampled at least
  /// every centimetre where the ray is near the ground, and the crossing is exact to a micrometre.
  /// \param from above the ground \param direction of length 1
  double rangeAlong(const Vector& from, const Vector& direction, double max_range) const;

 private:
  double alongKnots(const Vector& from, const Vector& direction) const;
  double alongWaves(const Vector& from, const Vector& direction, double max_range) const;

  Vector axis_;  ///< of the knots, horizontal, of length 1
  std::vector<Knot> knots_;
  std::vector<Wave> waves_;
  double steepest_ = 0;  ///< of the waves: bounds the rise per metre
  double highest_ = 0;   ///< of the waves: bounds the height
};

/// The names that makeTerrain () accepts.
std::vector<std::string> terrainNames();
/// A few words on a terrain. \throws std::invalid_argument if the name is unknown
std::string describeTerrain(const std::string& name);
/// Whether the slope given to makeTerrain () matters.
bool terrainHasSlope(const std::string& name);

/// Metres from the middle of the right lane, where the sensor drives along x, to the middle of the road on its left.
constexpr double kRoadMiddle = 1.75;
/// Half of the width of the road between its kerbs, metres.
constexpr double kRoadHalfWidth = 5.5;

/// A terrain around a street along x:
/// - plane: flat
/// - slope: rises ahead by the slope everywhere
/// - hill: hills and valleys of 60 m and 90 m from crest to crest, nowhere steeper than the slope
/// - road: a crowned road that falls by 2.5 % from its middle, kerbs of 12 cm, pavements, a bank on either side
/// - ramp: flat around the sensor; 12 m ahead a ramp up by 3 m, 12 m behind one down by 2 m, both of the slope
/// - field: uneven ground, waves of 2 m to 30 m that add up to slopes of up to about 15 degrees
/// \param slope radians, 0 to below a right angle \param seed of the phases of hill and field
/// \throws std::invalid_argument if the name is unknown
Terrain makeTerrain(const std::string& name, double slope, unsigned seed);

}  // namespace lisco_simulation
