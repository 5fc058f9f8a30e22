// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

namespace lisco {

/// How points are labelled as ground.
struct LabelGroundParameters {
  /// Of the sensor above the ground beneath it, metres, any finite value; NaN: estimated. In unorganized clouds, a
  /// given height counts from `origin`, and the points are seen from there, never from above it.
  float sensor_height = std::numeric_limits<float>::quiet_NaN();
  float max_slope = 17.0F;        ///< steepest ground, see GroundParameters
  std::size_t lasers = 1;         ///< rows of an organized cloud, stored row by row; 1: unorganized
  std::array<float, 3> origin{};  ///< position of the sensor, metres, finite
};

/// Labels the points of a scan that lie on the ground, by GroundFilter. The columns of a rotating sensor's organized
/// scan are filtered as they are. The points of other clouds, in any order, are sorted into columns of equal azimuth as
/// seen from the origin first, or from above it, where the ground is less than 0.5 m below, as in a vehicle's frame. If
/// the height is not given, and the scan as a whole shows no ground clearly, all points get 0.
/// \param points the first point: x, y and z as floats, metres; NaN, infinite or all 0 where there is no return
/// \param count number of points, below 2^31
/// \param stride bytes from one point to the next, at least 12; points need not be aligned
/// \param ground receives `count` bytes: 1 on the ground, else 0
/// \throws std::invalid_argument if the stride is below 12, count is 2^31 or more, lasers do not divide count, the
///         origin is not finite, a pointer is null while count is not 0, or GroundFilter::begin rejects a parameter
LISCO_EXPORT void labelGround(const void* points, std::size_t count, std::size_t stride,
                              const LabelGroundParameters& parameters, std::uint8_t* ground);

/// labelGround () for scan after scan: keeps its memory. Not thread safe; any number of instances may work side by
/// side.
class LISCO_EXPORT GroundLabeller {
 public:
  GroundLabeller();
  ~GroundLabeller();
  GroundLabeller(const GroundLabeller& other);             ///< a copy has memory of its own
  GroundLabeller& operator=(const GroundLabeller& other);  ///< the same

  /// Parameters and errors as those of labelGround.
  void label(const void* points, std::size_t count, std::size_t stride, const LabelGroundParameters& parameters,
             std::uint8_t* ground);

 private:
  class LISCO_HIDDEN State;
  std::unique_ptr<State> state_;
};

}  // namespace lisco
