// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lisco_simulation {
namespace {

/// The view of a Caster serves while sensor and objects approach each other by this, metres.
constexpr double kViewLength = 0.1;
/// Contains that, and the sensor's way up and down, by a kerb too.
constexpr double kSlack = 0.3;

std::size_t columnsPerView(const World& world, const Sensor& sensor, const Motion& motion) {
  double fastest = 0;
  for (const Body& body : world.bodies) fastest = std::max(fastest, length(body.velocity));
  const double per_column =
      (fastest + std::fabs(motion.speed)) * motion.turn_seconds / static_cast<double>(sensor.steps);
  constexpr double kMaxColumns = 1e9;  // at rest, one view serves for all
  return per_column * kMaxColumns < kViewLength
             ? static_cast<std::size_t>(kMaxColumns)
             : std::max<std::size_t>(1, static_cast<std::size_t>(kViewLength / per_column));
}

}  // namespace

Standing standingAfter(const Body& body, double seconds, const Terrain& ground) {
  if (body.footing == Footing::kFixed) return {};
  Standing standing{body.at + seconds * body.velocity, {}};
  Vector& place = standing.place;
  place.z = ground.height(place.x, place.y);
  if (body.footing == Footing::kLevel) return standing;
  const Vector ahead = rotated({body.length / 2, 0, 0}, body.heading);
  const Vector left = rotated({0, body.width / 2, 0}, body.heading);
  const auto heightAt = [&](double along, double across) {
    const Vector at = place + along * ahead + across * left;
    return ground.height(at.x, at.y);
  };
  const auto slopeAlong = [&](const Vector& half, double high, double low) {
    const double square = dot(half, half);
    return square > 0 ? (high - low) / (2 * square) * half : Vector{};
  };
  standing.slope =
      slopeAlong(ahead, heightAt(1, 0), heightAt(-1, 0)) + slopeAlong(left, heightAt(0, 1), heightAt(0, -1));
  double gap = 0;
  double mean = 0;
  for (const double along : {-1.0, -0.5, 0.0, 0.5, 1.0})
    for (const double across : {-1.0, 0.0, 1.0}) {
      const Vector away = along * ahead + across * left;
      const double above = place.z + dot(standing.slope, away) - heightAt(along, across);
      gap = std::max(gap, above);
      mean += above / 15;
    }
  place.z -= body.footing == Footing::kFounded ? gap : mean;
  return standing;
}

std::vector<Solid> solidsOf(const Body& body, const Standing& standing) {
  std::vector<Solid> solids = body.solids;
  if (body.footing == Footing::kFixed) return solids;
  for (Solid& solid : solids) solid = solid.rotated(body.heading).sheared(standing.slope).moved(standing.place);
  return solids;
}

Drive::Drive(World world, Sensor sensor, const Disturbance& disturbance, const Motion& motion, double height)
    : world_(std::move(world)),
      sensor_(std::move(sensor)),
      disturbance_(disturbance),
      motion_(motion),
      height_(height),
      columns_per_view_(columnsPerView(world_, sensor_, motion_)),
      at_rest_(world_.bodies.size()),
      standing_(world_.bodies.size()),
      shifts_(world_.bodies.size()) {
  for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
    const Body& body = world_.bodies[i];
    if (!body.isMoving()) at_rest_[i] = solidsOf(body, standingAfter(body, 0, world_.ground));
  }
  const auto number = static_cast<std::uint32_t>(world_.bodies.size() + 1);
  for (const Solid& solid : world_.carrier) carrier_.add(solid, number);
  carrier_.sort();
}

void Drive::lookAround(std::size_t column) {
  if (view_ != column / columns_per_view_) {
    view_ = column / columns_per_view_;
    const std::size_t first = *view_ * columns_per_view_;
    centre_ = poseOf(first).place;
    seen_.clear();
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
      const Body& body = world_.bodies[i];
      std::vector<Solid> moving;
      if (body.isMoving()) {
        standing_[i] = standingAfter(body, secondsOf(first), world_.ground);
        moving = solidsOf(body, standing_[i]);
      }
      for (const Solid& solid : body.isMoving() ? moving : at_rest_[i]) seen_.push_back(solid.moved(-1 * centre_));
      numbers.resize(seen_.size(), static_cast<std::uint32_t>(i + 1));
    }
    caster_ = Caster(kSlack);
    for (std::size_t i = 0; i < seen_.size(); ++i) caster_.add(seen_[i], numbers[i]);
    caster_.sort();
  }
  const double since = secondsOf(column) - secondsOf(*view_ * columns_per_view_);
  for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
    const Body& body = world_.bodies[i];
    if (!body.isMoving()) continue;
    shifts_[i] = since * body.velocity;
    shifts_[i].z = dot(standing_[i].slope, shifts_[i]);
  }
}

SimulatedScan Drive::columns(std::size_t first, std::size_t count) {
  SimulatedScan scan = emptyScan(sensor_.lasers(), count);
  for (std::size_t column = first; column < first + count; ++column) {
    lookAround(column);
    const Pose pose = poseOf(column);
    const Rotation toWorld(pose);
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      const std::uint64_t cell = std::uint64_t{column} * scan.lasers + laser;
      const Vector direction = sensor_.direction(laser, column);
      const Vector ray = toWorld(direction);
      Hit hit{world_.ground.rangeAlong(pose.place, ray, sensor_.max_range), 0};
      hit = caster_.first(hit, pose.place - centre_, ray, std::atan2(ray.y, ray.x), disturbance_.seed, cell, &shifts_);
      hit = carrier_.first(hit, {}, direction, sensor_.azimuth(laser, column), disturbance_.seed, cell);
      if (const auto range = reportedRange(hit, sensor_, disturbance_, cell))
        scan.cells[laser * count + column - first] = cellAt(*range * direction, hit.object);
    }
  }
  return scan;
}

SimulatedScan scanInMotion(const Scene& scene, const Sensor& sensor, const Disturbance& disturbance,
                           const Motion& motion, std::size_t columns) {
  World world{Terrain(scene.floor_z), {}, {}};
  for (const Object& object : scene.objects) {
    Body body;
    body.kind = object.kind;
    body.solids = object.solids;
    body.footing = Footing::kFixed;
    world.bodies.push_back(std::move(body));
  }
  Drive drive(std::move(world), sensor, disturbance, motion, -scene.floor_z);
  SimulatedScan scan = drive.columns(0, columns);
  for (std::size_t column = 0; column < columns; ++column) {
    const Pose pose = drive.poseOf(column);
    const Rotation toWorld(pose);
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      SimulatedCell& cell = scan.cells[laser * columns + column];
      cell = cellAt(toWorld(placeOf(cell)) + pose.place, cell.object);
    }
  }
  return scan;
}

}  // namespace lisco_simulation
