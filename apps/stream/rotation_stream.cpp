// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/rotation_stream.h"

#include <algorithm>
#include <cmath>

#include "core/sorted_element.h"
#include "lisco/sensor_hints.h"
#include "sensors/laser.h"

namespace lisco_apps {
namespace {

/// The sensor of a rotation, by its model.
lisco::SensorHints hintsFor(const Decoder& decoder) {
  lisco::SensorHints hints;
  hints.clockwise = true;
  hints.steps_per_turn = static_cast<int>(std::lround(std::min(decoder.columnsPerTurn(), double{kMaxColumns})));
  const std::vector<double>& elevations = decoder.elevations();
  std::vector<double> steps;
  for (std::size_t i = 1; i < elevations.size(); ++i) steps.push_back(elevations[i - 1] - elevations[i]);
  if (steps.empty()) return hints;
  hints.elevation_step = static_cast<float>(lisco::sortedElement(steps, steps.size() / 2) * kRadiansPerDegree);
  return hints;
}

}  // namespace

bool RotationStream::take(const PreparedColumn& column) {
  if (column.starts_turn || !has_begun_ || turn_.columns() == kMaxColumns) {
    end(Clock::now());
    if (isOver()) return false;
    begin(column);
  }
  listener_.column(column);
  column.fill(static_cast<std::uint32_t>(turn_.cells.size()), returns_);
  turn_.add(column);
  clusterer_.addColumn(returns_.data(), returns_.size());
  return true;
}

/// The rotation's clusters do not wait for columns of the next one.
void RotationStream::turnIsOver(Clock::time_point start) {
  finishGround();
  end(start);
}

void RotationStream::finish() {
  turnIsOver(Clock::now());
}

/// The expected view of the next rotation, which affects the speed only.
lisco::Parameters RotationStream::parametersFor(const PreparedColumn& first) const {
  lisco::Parameters parameters;
  parameters.sensor = hintsFor(decoder_);
  if (turn_.columns() > 0) {
    // Measured on the last rotation: ranges of returns, and how the sensor turns.
    const auto cell_at = [this](std::size_t laser, std::size_t column) {
      const std::size_t at = column * turn_.lasers + laser;
      return returnOf(turn_.cells[at], turn_.uses[at], 0);
    };
    const lisco::SensorHints estimated =
        lisco::estimateSensor(turn_.columns(), turn_.lasers, decoder_.sensorPlace().origin, lisco::CellSource(cell_at));
    if (estimated.steps_per_turn > 0) parameters.sensor = estimated;
  }
  parameters.tolerance = options_.tolerance;
  parameters.lasers = first.cells.size();
  return parameters;
}

void RotationStream::begin(const PreparedColumn& column) {
  clusterer_.begin(parametersFor(column));
  turn_.begin(++rotations_, column.cells.size(), column.azimuth);
  has_begun_ = true;
}

void RotationStream::end(Clock::time_point start) {
  if (!has_begun_) return;
  has_begun_ = false;
  clusterer_.update();
  collector_.collect(
      clusterer_, options_, [](std::uint32_t index) { return std::size_t{index}; }, turn_, clusters_);
  const auto latency = last_column_took_ + (Clock::now() - start);
  cluster_latency_.add(latency);
  turn_.lost = takeLost();
  collector_.measure(turn_, clusters_);
  listener_.found(turn_, clusters_, latency);
}

}  // namespace lisco_apps
