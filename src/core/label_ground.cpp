// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/label_ground.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/finite.h"
#include "core/ground/azimuth_columns.h"
#include "lisco/ground_filter.h"
#include "lisco/strided_points.h"

namespace lisco {

using ground::AzimuthColumns;

namespace {

void check(const void* points, std::size_t count, std::size_t stride, const LabelGroundParameters& parameters,
           const std::uint8_t* ground) {
  if (stride < 3 * sizeof(float))
    throw std::invalid_argument("lisco::labelGround: the stride must be 12 bytes or more");
  if (count >= std::size_t{1} << 31)
    throw std::invalid_argument("lisco::labelGround: the number of points must be below 2^31");
  if (parameters.lasers == 0 || count % parameters.lasers != 0)
    throw std::invalid_argument("lisco::labelGround: the number of points must be a multiple of the lasers");
  if (!areFinite(parameters.origin)) throw std::invalid_argument("lisco::labelGround: the origin must be finite");
  if (count > 0 && (points == nullptr || ground == nullptr))
    throw std::invalid_argument("lisco::labelGround: points and ground must not be null");
}

/// Whether a rotating sensor may be above the origin: it has hardly any returns from straight below, as there would be
/// if the origin were itself the sensor, on a table.
bool mayBeBelowSensor(const StridedPoints& points, std::size_t count, const std::array<float, 3>& origin, float above) {
  constexpr float kSteep = 1.73F;     // metres per metre, 60 degrees
  constexpr double kMaxSteep = 0.01;  // share of the returns
  std::size_t returns = 0, steep = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Return point = points.at(i);
    if (!isReturn(point.x, point.y, point.z)) continue;
    const float x = point.x - origin[0], y = point.y - origin[1], depth = origin[2] + above - point.z;
    ++returns;
    steep += depth > kSteep * std::sqrt(x * x + y * y) ? 1 : 0;
  }
  return static_cast<double>(steep) <= kMaxSteep * static_cast<double>(returns);
}

/// Reads the points in the cells of columns.
struct SortedPoints {
  const AzimuthColumns& columns;
  const StridedPoints& all;

  void operator()(std::size_t row, std::size_t first, std::size_t count, const CellSource::Destination& to) const {
    // Chosen without a branch: which cells are empty cannot be predicted.
    const StridedPoints none = StridedPoints::sideBySide(&kNoReturn, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t point = columns.pointAt(row, first + i);
      const Return cell = (point == AzimuthColumns::kNone ? none : all).at(point);
      to.x[i] = cell.x;
      to.y[i] = cell.y;
      to.z[i] = cell.z;
    }
  }
};

}  // namespace

class GroundLabeller::State {
 public:
  void label(const StridedPoints& points, std::size_t count, std::size_t lasers, GroundParameters parameters,
             const std::array<float, 3>& origin, std::uint8_t* ground);

 private:
  void labelUnorganized(const StridedPoints& points, std::size_t count, GroundParameters parameters,
                        std::uint8_t* ground);

  GroundFilter filter_;
  AzimuthColumns columns_;
  std::vector<std::uint8_t> decisions_;  // on its cells
};

/// \param parameters without the sensor
void GroundLabeller::State::label(const StridedPoints& points, std::size_t count, std::size_t lasers,
                                  GroundParameters parameters, const std::array<float, 3>& origin,
                                  std::uint8_t* ground) {
  filter_.begin(parameters, 0);  // rejects bad parameters, even without points
  if (count == 0) return;
  const std::size_t width = count / lasers;
  const auto cells = [&](std::size_t laser, std::size_t first, std::size_t number, const CellSource::Destination& to) {
    points.read(laser * width + first, number, to);
  };
  if (lasers > 1) parameters.sensor = estimateSensor(width, lasers, origin, CellSource(cells));
  if (parameters.sensor.steps_per_turn != 0) {
    filter_.filterScan(parameters, width, lasers, cells, ground);
    return;
  }
  parameters.sensor = SensorHints();
  parameters.sensor.origin = origin;
  labelUnorganized(points, count, parameters, ground);
}

void GroundLabeller::State::labelUnorganized(const StridedPoints& points, std::size_t count,
                                             GroundParameters parameters, std::uint8_t* ground) {
  // Metres. Seen from a point on the ground, as is the origin of a vehicle's frame, rays to the ground do not rise with
  // the distance; seen from above it, they do. A scan in its sensor's frame shows as much ground from there.
  constexpr float kLowOrigin = 0.5F, kRise = 1.5F;
  constexpr float kOnTable = 0.2F;  // metres; nearer, what is below a sensor is what it stands on
  std::fill_n(ground, count, std::uint8_t{0});
  SortedPoints cells{columns_, points};
  const auto estimated = [&] {
    columns_.sort(points, count, parameters.sensor.origin);
    return estimateGroundPlane(columns_.columns(), columns_.rows(), parameters, CellSource(cells));
  };
  GroundParameters plane = estimated();
  if (std::isnan(parameters.sensor_height) && plane.sensor_height < kLowOrigin) {
    if (mayBeBelowSensor(points, count, parameters.sensor.origin, kRise)) {
      parameters.sensor.origin[2] += kRise;
      plane = estimated();
    } else if (plane.sensor_height < kOnTable) {
      return;
    }
  }
  if (std::isnan(plane.sensor_height)) return;
  decisions_.resize(columns_.rows() * columns_.columns());
  filter_.filter(plane, columns_.columns(), columns_.rows(), cells, decisions_.data());
  std::uint8_t of_none = 0;
  for (std::size_t column = 0; column < columns_.columns(); ++column)
    for (std::size_t row = 0; row < columns_.rows(); ++row) {
      const std::uint32_t point = columns_.pointAt(row, column);
      *(point == AzimuthColumns::kNone ? &of_none : ground + point) = decisions_[row * columns_.columns() + column];
    }
}

GroundLabeller::GroundLabeller() : state_(std::make_unique<State>()) {}
GroundLabeller::~GroundLabeller() = default;
GroundLabeller::GroundLabeller(const GroundLabeller& /*other*/) : GroundLabeller() {}
GroundLabeller& GroundLabeller::operator=(const GroundLabeller& /*other*/) {
  return *this;
}

void GroundLabeller::label(const void* points, std::size_t count, std::size_t stride,
                           const LabelGroundParameters& parameters, std::uint8_t* ground) {
  check(points, count, stride, parameters, ground);
  GroundParameters filter_parameters;
  filter_parameters.sensor_height = parameters.sensor_height;
  filter_parameters.max_slope = parameters.max_slope;
  state_->label(StridedPoints::sideBySide(points, static_cast<std::ptrdiff_t>(stride)), count, parameters.lasers,
                filter_parameters, parameters.origin, ground);
}

void labelGround(const void* points, std::size_t count, std::size_t stride, const LabelGroundParameters& parameters,
                 std::uint8_t* ground) {
  GroundLabeller().label(points, count, stride, parameters, ground);
}

}  // namespace lisco
