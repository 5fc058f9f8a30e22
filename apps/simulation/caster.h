// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "simulation/scanner.h"
#include "simulation/solid.h"
#include "simulation/terrain.h"
#include "simulation/vector.h"

namespace lisco_simulation {

struct Hit {
  double range = std::numeric_limits<double>::infinity();
  std::uint32_t object = 0;
};

/// Finds the first solid on a ray that begins at or near (0, 0, 0). Solids are sorted into sectors of azimuth and in
/// each by nearest range, so that few are tested per ray.
class Caster {
 public:
  /// Per object, by its number less 1: how far it has moved since it was added.
  using Shifts = std::vector<Vector>;

  /// \param slack rays begin at most this far from (0, 0, 0) as seen from an object, metres
  explicit Caster(double slack = 0) : slack_(slack), sectors_(kSectors) {}

  /// \param solid must live as long as the caster
  void add(const Solid& solid, std::uint32_t object);
  /// To be called after the last add ().
  void sort();

  /// The nearest hit, or `hit` if that is nearer.
  /// \param direction of length 1 \param azimuth of the direction, radians
  /// \param seed, cell determine the depth of the ray into leaves
  /// \param shifts nullptr: no object has moved
  Hit first(Hit hit, const Vector& from, const Vector& direction, double azimuth, std::uint64_t seed,
            std::uint64_t cell, const Shifts* shifts = nullptr) const;

 private:
  static constexpr std::size_t kSectors = 2048;

  struct Entry {
    const Solid* solid;
    std::uint32_t object;
  };
  /// The bounds of a solid as seen from the sensor.
  struct Candidate {
    double nearest;          ///< range, metres
    double lowest, highest;  ///< sine of the elevation
    std::uint32_t solid;
  };

  static double sectorPosition(double azimuth);
  static std::size_t sectorOf(double azimuth) { return static_cast<std::size_t>(sectorPosition(azimuth)) % kSectors; }

  double slack_;
  std::vector<Entry> solids_;
  std::vector<std::vector<Candidate>> sectors_;
};

/// The range that a sensor reports of a hit; nullopt: no return.
/// \param cell determines noise and drop-outs
std::optional<double> reportedRange(const Hit& hit, const Sensor& sensor, const Disturbance& disturbance,
                                    std::uint64_t cell);

}  // namespace lisco_simulation
