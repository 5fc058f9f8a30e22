// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Terrains, and the scans of a sensor that drives over them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "lisco/ground_filter.h"
#include "lisco/sensor_hints.h"
#include "simulation/drive.h"
#include "simulation/motion.h"
#include "simulation/random.h"
#include "simulation/scenes.h"
#include "simulation/sensor.h"
#include "simulation/solid.h"
#include "simulation/street.h"
#include "simulation/terrain.h"

namespace lisco_simulation {
namespace {

constexpr double kDegree = kPi / 180;
constexpr double kHeight = 1.8;
constexpr Disturbance kExact{1, 0, 0};

std::string bytesOf(const SimulatedScan& scan) {
  return {reinterpret_cast<const char*>(scan.cells.data()), scan.cells.size() * sizeof(SimulatedCell)};
}

/// A sensor that does everything at once.
Motion restlessMotion() {
  Motion motion;
  motion.speed = 15;
  motion.turn_rate = 20 * kDegree;
  motion.roll = 4 * kDegree;
  motion.pitch = 3 * kDegree;
  return motion;
}

Drive driveOver(const std::string& terrain, const Motion& motion, const Disturbance& disturbance,
                const std::string& sensor = "vlp16", std::size_t steps = 300, double seconds = 1) {
  const auto seed = static_cast<unsigned>(disturbance.seed);
  const Terrain ground = makeTerrain(terrain, 10 * kDegree, seed);
  return {makeStreet(ground, motion, seconds, kHeight, seed), makeSensor(sensor, 0, steps), disturbance, motion,
          kHeight};
}

// --- Terrains ------------------------------------------------------------------------------------------------------

class EachTerrain : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Name, EachTerrain, testing::ValuesIn(terrainNames()),
                         [](const auto& each) { return each.param; });

TEST_P(EachTerrain, MeetsRaysWhereMarchingMeetsIt) {
  Random random(3);
  constexpr double kFar = 60;
  int met = 0;
  for (int round = 0; round < 3000; ++round) {
    const Terrain ground = makeTerrain(GetParam(), random.between(0, 25) * kDegree, static_cast<unsigned>(round % 7));
    Vector from{random.between(-30, 30), random.between(-30, 30), 0};
    from.z = ground.height(from.x, from.y) + random.between(0.3, 4);
    const double heading = random.between(-kPi, kPi);
    const double elevation = random.between(-0.6, 0.25);
    const Vector direction{std::cos(elevation) * std::cos(heading), std::cos(elevation) * std::sin(heading),
                           std::sin(elevation)};
    const auto gapAt = [&](double range) {
      const Vector place = from + range * direction;
      return place.z - ground.height(place.x, place.y);
    };
    const double range = ground.rangeAlong(from, direction, kFar);
    if (range < kFar) {
      ++met;
      ASSERT_NEAR(gapAt(range), 0, 1e-5) << "round " << round;
    }
    for (double before = 0; before < std::min(range, kFar) - 0.02; before += 0.01)
      ASSERT_GT(gapAt(before), -1e-4) << "round " << round << ", at " << before << " of " << range;
  }
  EXPECT_GT(met, 1000);
}

TEST_P(EachTerrain, IsAsSteepAsItSays) {
  double steepest = 0;
  double sideways = 0;
  const double slope = 12 * kDegree;
  const Terrain ground = makeTerrain(GetParam(), slope, 4);
  for (double x = -60; x <= 60; x += 0.5)
    for (double y = -8; y <= 8; y += 0.25) {
      const auto rise = [&](double dx, double dy) {
        constexpr double kStep = 0.005;
        return (ground.height(x + dx * kStep, y + dy * kStep) - ground.height(x - dx * kStep, y - dy * kStep)) /
               (2 * kStep);
      };
      steepest = std::max(steepest, std::hypot(rise(1, 0), rise(0, 1)));
      sideways = std::max(sideways, std::fabs(rise(0, 1)));
    }
  const double degrees = std::atan(steepest) / kDegree;
  if (GetParam() == "plane") {
    EXPECT_EQ(steepest, 0);
  } else if (GetParam() == "slope" || GetParam() == "ramp") {
    EXPECT_NEAR(degrees, 12, 0.01);
    EXPECT_EQ(sideways, 0);
  } else if (GetParam() == "hill") {
    EXPECT_GT(degrees, 8);
    EXPECT_LE(degrees, 12.01);
  } else if (GetParam() == "field") {
    EXPECT_GT(degrees, 6);
    EXPECT_LT(degrees, 20);
  }
  EXPECT_EQ(terrainHasSlope(GetParam()), GetParam() == "slope" || GetParam() == "ramp" || GetParam() == "hill");
  EXPECT_FALSE(describeTerrain(GetParam()).empty());
}

TEST(Terrain, RoadHasACrownAndKerbs) {
  const Terrain road = makeTerrain("road", 0, 1);
  const double crown = road.height(0, kRoadMiddle);
  for (const double side : {-1.0, 1.0}) {
    const double edge = kRoadMiddle + side * kRoadHalfWidth;
    EXPECT_NEAR(crown - road.height(7, edge), 0.025 * kRoadHalfWidth, 1e-9);
    EXPECT_NEAR(road.height(0, edge + side * 0.03) - road.height(0, edge - side * 0.01), 0.12, 0.002);
  }
}

TEST(Terrain, RampHasItsHeights) {
  const Terrain ramp = makeTerrain("ramp", 10 * kDegree, 1);
  EXPECT_NEAR(ramp.height(11.9, 5), 0, 1e-12);
  EXPECT_NEAR(ramp.height(100, 5), 3, 1e-12);
  EXPECT_NEAR(ramp.height(-100, 5), -2, 1e-12);
  EXPECT_THROW(makeTerrain("lake", 0, 1), std::invalid_argument);
}

// --- Solids on slopes ----------------------------------------------------------------------------------------------

TEST(Solid, IsShearedPointByPoint) {
  Random random(9);
  int inside = 0;
  for (int round = 0; round < 200; ++round) {
    const Vector slope{random.between(-0.5, 0.5), random.between(-0.5, 0.5), 0};
    const Solid upright = round % 2 == 0 ? Solid::box({-1, -0.5, 0}, {2, 0.7, 1.5})
                                         : Solid::cylinder({0.2, 0, 0}, {0.5, 1, 1.5}, random.between(0.2, 1));
    const Solid sheared = upright.sheared(slope);
    for (int sample = 0; sample < 300; ++sample) {
      const Vector place{random.between(-2, 3), random.between(-2, 2), random.between(-1, 2.5)};
      const Vector lifted = place + Vector{0, 0, dot(slope, place)};
      // Margins are measured before and after: leave out the surface.
      if (upright.contains(place, -0.02) == upright.contains(place, 0.02)) {
        ASSERT_EQ(sheared.contains(lifted), upright.contains(place)) << "round " << round;
      }
      if (!upright.contains(place)) continue;
      ++inside;
      ASSERT_LE(length(lifted - sheared.bounds().centre), sheared.bounds().radius + 1e-9);
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(Solid, IsMetFromElsewhereAsIfItWereMoved) {
  Random random(10);
  const Solid solid = Solid::cylinder({3, 0, -1}, {3.5, 0.4, 1}, 0.8).sheared({0.1, -0.2, 0});
  for (int round = 0; round < 1000; ++round) {
    const Vector from{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    Vector direction{1, random.between(-0.6, 0.6), random.between(-0.6, 0.6)};
    direction = (1 / length(direction)) * direction;
    const Interval a = solid.along(direction, from);
    const Interval b = solid.moved(-1 * from).along(direction);
    ASSERT_EQ(a.enter > a.leave, b.enter > b.leave);
    if (a.enter > a.leave) continue;
    ASSERT_NEAR(a.enter, b.enter, 1e-9);
    ASSERT_NEAR(a.leave, b.leave, 1e-9);
  }
}

// --- Poses ---------------------------------------------------------------------------------------------------------

TEST(Pose, TurnsByRollThenPitchThenYaw) {
  const auto expect = [](const Pose& pose, const Vector& v, const Vector& turned) {
    EXPECT_NEAR(length(Rotation(pose)(v) - turned), 0, 1e-12);
  };
  expect({{}, 0, 0, kPi / 2}, {1, 0, 0}, {0, 1, 0});                               // to the left
  expect({{}, 0, 30 * kDegree, 0}, {1, 0, 0}, {std::cos(30 * kDegree), 0, -0.5});  // looks down
  expect({{}, 30 * kDegree, 0, 0}, {0, 1, 0}, {0, std::cos(30 * kDegree), 0.5});   // leans to the right
  expect({{}, kPi / 2, kPi / 2, 0}, {0, 1, 0}, {1, 0, 0});                         // up by roll, ahead by pitch
  expect({{}, kPi / 2, kPi / 2, kPi / 2}, {0, 1, 0}, {0, 1, 0});
}

TEST(Motion, FollowsItsCircleAndSways) {
  const Motion motion = restlessMotion();
  constexpr double kSmall = 1e-4;
  for (const double turns : {0.0, 3.3, 12.0}) {
    const Vector way = motion.placeAfter(turns + kSmall) - motion.placeAfter(turns);
    EXPECT_NEAR(length(way), motion.speed * motion.turn_seconds * kSmall, 1e-9);
    EXPECT_NEAR(std::atan2(way.y, way.x), motion.headingAfter(turns), 1e-4);
  }
  const Terrain flat;
  const Pose start = motion.poseAfter(0, flat, kHeight);
  EXPECT_NEAR(start.roll, motion.roll, 1e-12);
  EXPECT_NEAR(start.place.z, kHeight, 1e-12);
  EXPECT_NEAR(motion.poseAfter(motion.pitch_seconds / 2 / motion.turn_seconds, flat, kHeight).pitch, -motion.pitch,
              1e-9);
}

// --- Drives --------------------------------------------------------------------------------------------------------

TEST(Motion, KeepsALowSensorAboveCrests) {
  const Terrain ramp = makeTerrain("ramp", 30 * kDegree, 1);
  Motion motion;
  motion.speed = 20;
  double least = 1;
  for (double turns = 0; turns < 30; turns += 0.01) {
    const Vector place = motion.poseAfter(turns, ramp, 0.2).place;
    least = std::min(least, place.z - ramp.height(place.x, place.y));
  }
  EXPECT_NEAR(least, 0.1, 1e-9);
}

TEST_P(EachTerrain, LabelsReturnsWithWhatTheyLieOn) {
  Drive drive = driveOver(GetParam(), restlessMotion(), kExact);
  const World& world = drive.world();
  std::size_t ground = 0;
  std::set<std::uint32_t> objects;
  constexpr std::size_t kColumns = 900;
  const SimulatedScan scan = drive.columns(0, kColumns);
  for (std::size_t column = 0; column < kColumns; ++column) {
    const Pose pose = drive.poseOf(column);
    const Rotation toWorld(pose);
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      const SimulatedCell& cell = scan.at(laser, column);
      if (std::isnan(cell.x)) {
        ASSERT_EQ(cell.object, 0U);
        continue;
      }
      const Vector place = toWorld(placeOf(cell)) + pose.place;
      const double gap = place.z - world.ground.height(place.x, place.y);
      if (cell.object == 0) {
        ++ground;
        ASSERT_NEAR(gap, 0, 1e-3) << "column " << column << ", laser " << laser;
        continue;
      }
      ASSERT_GT(gap, -1e-3) << "column " << column << ", laser " << laser;
      objects.insert(cell.object);
      std::vector<Solid> solids = world.carrier;
      Vector seen = placeOf(cell);
      if (cell.object <= world.bodies.size()) {
        const Body& body = world.bodies[cell.object - 1];
        solids = solidsOf(body, standingAfter(body, drive.secondsOf(column), world.ground));
        seen = place;
      }
      // Within a view, moving objects are shifted and not leant anew.
      ASSERT_TRUE(
          std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) { return solid.contains(seen, 0.02); }))
          << "column " << column << ", laser " << laser << ", object " << cell.object;
    }
  }
  EXPECT_GT(ground, kColumns);
  EXPECT_GT(objects.size(), 20U);
}

TEST_P(EachTerrain, HasNoObjectWhereABruteForceLookFindsTheGround) {
  // All solids tested for each ray, at the moment of its column.
  Drive drive = driveOver(GetParam(), restlessMotion(), kExact, "vlp16", 60);
  const World& world = drive.world();
  for (const std::size_t column : {std::size_t{0}, std::size_t{31}, std::size_t{137}, std::size_t{290}}) {
    const SimulatedScan scan = drive.columns(column, 1);
    const Pose pose = drive.poseOf(column);
    const Rotation toWorld(pose);
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      const Vector ray = toWorld(drive.sensor().direction(laser, column));
      double nearest = world.ground.rangeAlong(pose.place, ray, drive.sensor().max_range);
      double nearest_leaves = std::numeric_limits<double>::infinity();
      for (const Body& body : world.bodies)
        for (const Solid& solid : solidsOf(body, standingAfter(body, drive.secondsOf(column), world.ground))) {
          const Interval inside = solid.along(ray, pose.place);
          if (inside.enter > inside.leave || inside.enter <= 0) continue;
          double& which = solid.meanDepth() > 0 ? nearest_leaves : nearest;
          which = std::min(which, inside.enter);
        }
      for (const Solid& solid : world.carrier) {
        const Interval inside = solid.along(drive.sensor().direction(laser, column));
        if (inside.enter <= inside.leave && inside.enter > 0) nearest = std::min(nearest, inside.enter);
      }
      if (nearest_leaves < nearest) continue;  // the depth in leaves is random
      const SimulatedCell& cell = scan.at(laser, 0);
      const double range = std::isnan(cell.x) ? nearest : length(placeOf(cell));
      ASSERT_EQ(std::isnan(cell.x), nearest > drive.sensor().max_range) << "column " << column << ", laser " << laser;
      if (nearest > drive.sensor().max_range) continue;
      ASSERT_NEAR(range, nearest, 0.02 + 0.001 * nearest) << "column " << column << ", laser " << laser;
    }
  }
}

TEST(Drive, HasTheNoiseOfItsRanges) {
  const Motion motion = restlessMotion();
  Drive exact = driveOver("field", motion, kExact);
  Drive noisy = driveOver("field", motion, {1, 0.02, 0});
  const SimulatedScan was = exact.columns(0, 300);
  const SimulatedScan is = noisy.columns(0, 300);
  double squares = 0;
  for (std::size_t i = 0; i < was.cells.size(); ++i) {
    if (std::isnan(was.cells[i].x)) continue;
    const double error = length(placeOf(is.cells[i])) - length(placeOf(was.cells[i]));
    ASSERT_LT(std::fabs(error), 6.1 * 0.02);
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(was.returns())), 0.02, 0.001);
}

TEST(Drive, GivesTheSameColumnsHoweverTheyAreAskedFor) {
  Drive drive = driveOver("hill", restlessMotion(), {});
  const SimulatedScan whole = drive.columns(0, 600);
  for (const std::size_t first : {std::size_t{437}, std::size_t{3}, std::size_t{0}, std::size_t{590}}) {
    const SimulatedScan part = drive.columns(first, 10);
    for (std::size_t laser = 0; laser < part.lasers; ++laser)
      ASSERT_EQ(std::memcmp(&part.at(laser, 0), &whole.at(laser, first), 10 * sizeof(SimulatedCell)), 0);
  }
  EXPECT_EQ(bytesOf(driveOver("hill", restlessMotion(), {}).columns(0, 600)), bytesOf(whole));
  EXPECT_NE(bytesOf(driveOver("hill", restlessMotion(), {2}).columns(0, 600)), bytesOf(whole));
}

TEST(Drive, AtRestIsAScan) {
  const Scene scene = layOutScene(3, 1, 2);
  const Sensor sensor = makeSensor("os1-128", 20, 400);
  const SimulatedScan still = scanInMotion(scene, sensor, kExact, {}, 400);
  const SimulatedScan expected = scan(scene, sensor, kExact);
  std::size_t leaves = 0;
  for (std::size_t i = 0; i < still.cells.size(); ++i) {
    if (still.cells[i].object != expected.cells[i].object) {
      ++leaves;  // other random numbers
      continue;
    }
    const std::uint32_t object = expected.cells[i].object;
    if (object != 0 && scene.objects[object - 1].kind == "tree") continue;
    ASSERT_EQ(std::isnan(still.cells[i].x), std::isnan(expected.cells[i].x));
    if (std::isnan(still.cells[i].x)) continue;
    ASSERT_NEAR(length(placeOf(still.cells[i]) - placeOf(expected.cells[i])), 0, 1e-4) << "cell " << i;
  }
  EXPECT_LT(leaves, still.cells.size() / 10);
}

/// Parts of the ground that the filter finds, and of its finds that are ground.
struct GroundFound {
  double recall, precision;
};

/// \param found a byte for each cell: 1 is ground
GroundFound compared(const SimulatedScan& scan, const std::vector<std::uint8_t>& found) {
  double both = 0, ground = 0, all = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::isnan(scan.cells[i].x)) continue;
    const bool is_ground = scan.cells[i].object == 0;
    ground += is_ground;
    all += found[i];
    both += is_ground && found[i] != 0;
  }
  return {both / ground, both / all};
}

/// The cells of a scan, which must last, for the library.
auto cellsOf(const SimulatedScan& scan) {
  return [&scan](std::size_t laser, std::size_t step) {
    const SimulatedCell& cell = scan.cells[laser * scan.steps + step];
    return lisco::Return{cell.x, cell.y, cell.z, 0};
  };
}

GroundFound groundFoundIn(const SimulatedScan& scan) {
  const auto cell_at = cellsOf(scan);
  lisco::GroundParameters parameters;
  parameters.sensor = lisco::estimateSensor(scan.steps, scan.lasers, {}, lisco::CellSource(cell_at));
  std::vector<std::uint8_t> found(scan.cells.size());
  lisco::GroundFilter().filterScan(parameters, scan.steps, scan.lasers, cell_at, found.data());
  return compared(scan, found);
}

// The first columns show nothing but the foot of the ramp behind, 3 m below: cars hide the ground nearby.
TEST(Drive, ShowsTheGroundAroundTheTopOfARamp) {
  Motion motion;
  motion.speed = 8;
  motion.roll = motion.pitch = 2 * kDegree;
  Drive ramp = driveOver("ramp", motion, {8, 0.02, 0.005}, "vlp16", 0, 4.2);
  const std::size_t steps = ramp.sensor().steps;
  const SimulatedScan scan = ramp.columns(40 * steps, 2 * steps);
  const auto cell_at = cellsOf(scan);
  std::vector<std::uint8_t> found(scan.cells.size());
  lisco::GroundFilter().filter({}, scan.steps, scan.lasers, cell_at, found.data());
  EXPECT_GT(compared(scan, found).recall, 0.87);  // 0.78 if these columns tell the height
}

// The lines of such fields, drawn on to beneath the sensor, end up to a metre below the ground.
TEST(Drive, ShowsTheGroundOfUnevenFieldsInASingleScan) {
  for (const char* const sensor : {"hdl64e", "hdl32e"})
    for (const unsigned seed : {1U, 14U}) {
      Drive field = driveOver("field", {}, {seed, 0.02, 0.005}, sensor, 0);
      const GroundFound found = groundFoundIn(field.columns(0, field.sensor().steps));
      EXPECT_GT(found.recall, 0.9) << sensor << ", seed " << seed;
      EXPECT_GT(found.precision, 0.98) << sensor << ", seed " << seed;
    }
}

TEST(Drive, MovesObjectsBySpeedTimesTime) {
  // A single box that passes the sensor, seen from a sensor that moves too.
  Body box;
  box.kind = "box";
  box.solids = {Solid::box({-1, -1, 0}, {1, 1, 3})};
  box.length = box.width = 2;
  box.at = {20, 6, 0};
  box.velocity = {-12, 3, 0};
  Motion motion;
  motion.speed = 5;
  const Terrain slope = makeTerrain("slope", 8 * kDegree, 1);
  Drive drive({slope, {box}, {}}, makeSensor("os1-128", 0, 1024), kExact, motion, kHeight);
  for (const std::size_t rotation : {std::size_t{0}, std::size_t{6}, std::size_t{14}}) {
    const SimulatedScan scan = drive.columns(rotation * 1024, 1024);
    std::size_t returns = 0;
    for (std::size_t i = 0; i < scan.cells.size(); ++i) {
      if (std::isnan(scan.cells[i].x) || scan.cells[i].object != 1) continue;
      ++returns;
      const std::size_t column = rotation * 1024 + i % 1024;
      const double seconds = 0.1 * static_cast<double>(column) / 1024;
      const Vector sensor{5 * seconds, 0, slope.height(5 * seconds, 0) + kHeight};
      const Vector place = placeOf(scan.cells[i]) + sensor;
      const Vector middle{20 - 12 * seconds, 6 + 3 * seconds, 0};
      // On a side of the box: one of the distances from its middle is 1 m, the other at most that.
      const double x = std::fabs(place.x - middle.x);
      const double y = std::fabs(place.y - middle.y);
      const double above = place.z - slope.height(place.x, place.y);
      ASSERT_TRUE(std::fabs(std::max(x, y) - 1) < 1e-3 || std::fabs(above - 3) < 1e-3) << x << ' ' << y << ' ' << above;
      ASSERT_LE(std::max(x, y), 1.001);
      ASSERT_LE(above, 3.001);
    }
    EXPECT_GT(returns, 50U) << "rotation " << rotation;
  }
}

TEST(Street, StandsOnTheGround) {
  for (const std::string& name : terrainNames()) {
    const Terrain ground = makeTerrain(name, 15 * kDegree, 2);
    const World world = makeStreet(ground, {}, 1, kHeight, 2);
    std::set<std::string> kinds;
    for (const Body& body : world.bodies) {
      kinds.insert(body.kind);
      const Standing standing = standingAfter(body, 0, ground);
      if (body.kind == "bridge") continue;
      EXPECT_NEAR(standing.place.z, ground.height(standing.place.x, standing.place.y), name == "plane" ? 1e-9 : 1.5);
      // Nothing that is founded has a gap beneath its corners.
      if (body.footing != Footing::kFounded) continue;
      for (const double along : {-0.5, 0.5})
        for (const double across : {-0.5, 0.5}) {
          const Vector away = rotated({along * body.length, across * body.width, 0}, body.heading);
          EXPECT_LE(standing.place.z + dot(standing.slope, away),
                    ground.height(standing.place.x + away.x, standing.place.y + away.y) + 1e-9)
              << body.kind << " on " << name;
        }
    }
    for (const char* kind : {"car", "lorry", "person", "lamp post", "sign post", "tree", "wall", "house", "bridge"})
      EXPECT_EQ(kinds.count(kind), 1U) << kind;
    EXPECT_FALSE(world.carrier.empty());
    EXPECT_TRUE(makeStreet(ground, {}, 1, 0.6, 2).carrier.empty());
  }
}

TEST(Street, SaysTheExtentsOfBoxes) {
  // The solids of a body in its own frame, met by rays from outside along each axis.
  const World world = makeStreet(Terrain(), {}, 1, kHeight, 3);
  std::set<std::string> kinds;
  for (const Body& body : world.bodies) {
    if (body.height == 0) continue;
    kinds.insert(body.kind);
    double length = 0;
    double width = 0;
    double height = 0;
    for (double x = -body.length; x <= body.length; x += 0.02)
      for (const Solid& solid : body.solids) {
        for (double z = 0.02; z < 4; z += 0.1) {
          const Interval across = solid.along({0, 1, 0}, {x, 0, z});
          if (across.enter > across.leave) continue;
          width = std::max({width, -across.enter, across.leave});
          length = std::max(length, std::fabs(x));
        }
        for (const double y : {0.0, 0.2, 0.5}) {
          const Interval up = solid.along({0, 0, 1}, {x, y, 0});
          if (up.enter <= up.leave) height = std::max(height, up.leave);
        }
      }
    EXPECT_NEAR(2 * length, body.length, 0.05) << body.kind;
    EXPECT_NEAR(2 * width, body.width, 0.01) << body.kind;
    EXPECT_NEAR(height, body.height, 0.01) << body.kind;
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"car", "lorry", "wall"}));
}

TEST(Street, LeavesTheSensorsWayFree) {
  Motion motion;
  motion.speed = 10;
  motion.turn_rate = 30 * kDegree;
  const World world = makeStreet(Terrain(), motion, 5, kHeight, 1);
  for (double turns = 0; turns <= 50; turns += 0.5)
    for (const Body& body : world.bodies) {
      if (body.kind == "bridge" || body.isMoving()) continue;
      EXPECT_GT(length(motion.placeAfter(turns) - body.at), 2.2) << body.kind << " after " << turns;
    }
}

}  // namespace
}  // namespace lisco_simulation
