// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Both masks alone: the tile of every neighbour of a return is among the tiles they show for a box around it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "lisco/box.h"
#include "lisco/grid_mask.h"
#include "lisco/tolerance.h"
#include "lisco/view_mask.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

// So many that every tile has a place of its own: tiles that share one would hide mistakes.
constexpr std::size_t kManyReturns = std::size_t{1} << 24;

constexpr double kPi = 3.14159265358979323846;
constexpr int kPairs = 3000;

struct Vector {
  double x, y, z;
};

Vector direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

Vector anyDirection(Random& random) {
  return direction(random.between(0.0, 2.0 * kPi), std::asin(random.between(-1.0, 1.0)));
}

/// Where the first return of a pair lies, seen from the sensor, and how large the tolerance is.
struct Geometry {
  const char* name;
  double (*azimuth)(Random&);
  double (*elevation)(Random&);
  double least_range, greatest_range;  ///< in units of the tolerance
  double tolerance = 0.5;
  std::array<float, 3> origin{0.0F, 0.0F, 0.0F};
};

void PrintTo(const Geometry& geometry, std::ostream* out) {
  *out << geometry.name;
}

double anyAzimuth(Random& random) {
  return random.between(0.0, 2.0 * kPi);
}
double nearSeam(Random& random) {
  return (random.chance(0.5) ? 1.0 : -1.0) * random.magnitude(1e-9, 0.1);
}
double nearOctant(Random& random) {
  return kPi / 4.0 * static_cast<double>(random.below(8)) + nearSeam(random);
}
double anyElevation(Random& random) {
  return std::asin(random.between(-1.0, 1.0));
}
double horizon(Random& random) {
  return random.between(-0.02, 0.02);
}
double zenith(Random& random) {
  return kPi / 2.0 - random.magnitude(1e-8, 0.5);
}
double nadir(Random& random) {
  return -zenith(random);
}
double exactlyUp(Random&) {
  return kPi / 2.0;
}
double below(Random& random) {
  return random.between(-1.2, -0.3);
}

const std::vector<Geometry> kGeometries{
    {"near", anyAzimuth, anyElevation, 1.0, 6.0},
    {"middle", anyAzimuth, anyElevation, 6.0, 200.0},
    {"far", anyAzimuth, anyElevation, 200.0, 1e5},
    {"very_far", anyAzimuth, anyElevation, 1e5, 1e8},
    {"inside_the_tolerance", anyAzimuth, anyElevation, 1e-6, 1.0},
    {"at_the_tolerance", anyAzimuth, anyElevation, 0.999999, 1.000001},
    {"zenith_near", anyAzimuth, zenith, 0.5, 5.0},
    {"zenith_far", anyAzimuth, zenith, 5.0, 1e4},
    {"zenith_exactly", anyAzimuth, exactlyUp, 0.5, 1e4},
    {"nadir", anyAzimuth, nadir, 0.5, 1e4},
    {"seam_on_the_horizon", nearSeam, horizon, 0.5, 1e4},
    {"seam_anywhere", nearSeam, anyElevation, 0.5, 1e4},
    {"octant_borders", nearOctant, anyElevation, 0.5, 1e4},
    {"below_the_sensor", anyAzimuth, below, 0.5, 1e3},
    {"displaced_sensor", anyAzimuth, anyElevation, 0.5, 1e3, 0.5, {1000.0F, -2000.0F, 300.0F}},
    {"far_displaced_sensor", anyAzimuth, anyElevation, 0.5, 1e3, 0.5, {1e6F, 1e6F, -1e6F}},
    {"displaced_seam", nearSeam, horizon, 0.5, 1e4, 0.5, {1000.0F, -2000.0F, 300.0F}},
    {"tiny_scale", anyAzimuth, anyElevation, 0.5, 1e3, 1e-18},
    {"denormal_scale", anyAzimuth, anyElevation, 0.5, 1e3, 2e-22},
    {"huge_scale", anyAzimuth, anyElevation, 0.5, 1e3, 1e15},
    {"overflowing_scale", anyAzimuth, anyElevation, 0.5, 1e18, 1.5e19},
    {"unbounded_tolerance", anyAzimuth, anyElevation, 1e-30, 1e8, 1e30},
};

const std::vector<lisco::ViewHints> kHints{
    {},
    {{}, 0.0F, 0.0F},    // the finest tiles
    {{}, 10.0F, 10.0F},  // the coarsest
    {{}, 0.0F, 10.0F},
    {{}, 0.003F, 0.035F},
};

Point placed(const Geometry& geometry, const Vector& seen) {
  return {static_cast<float>(seen.x + static_cast<double>(geometry.origin[0])),
          static_cast<float>(seen.y + static_cast<double>(geometry.origin[1])),
          static_cast<float>(seen.z + static_cast<double>(geometry.origin[2]))};
}

/// The tolerance cannot be longer than this without overflow.
double reachOf(const Geometry& geometry) {
  return std::min(geometry.tolerance, 1.8e19);
}

Vector firstOfPair(Random& random, const Geometry& geometry) {
  const Vector to = direction(geometry.azimuth(random), geometry.elevation(random));
  const double range = reachOf(geometry) * random.magnitude(geometry.least_range, geometry.greatest_range);
  return {to.x * range, to.y * range, to.z * range};
}

/// Something about a tolerance away: often across the line of sight, where angles grow fastest, or along it.
Vector secondOfPair(Random& random, const Geometry& geometry, const Vector& p) {
  Vector by = anyDirection(random);
  const double rho = std::hypot(p.x, p.y);
  const double range = std::hypot(rho, p.z);
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  const std::size_t kind = random.below(5);
  if (kind == 1 && rho > 0.0) by = {-sign * p.y / rho, sign * p.x / rho, 0.0};
  if (kind == 2 && rho > 0.0)
    by = {-sign * p.z * p.x / (rho * range), -sign * p.z * p.y / (rho * range), sign * rho / range};
  if (kind == 3 && range > 0.0) by = {sign * p.x / range, sign * p.y / range, sign * p.z / range};
  if (kind == 4 && rho > geometry.tolerance) {  // the tangent from the axis to the disk around p
    const double s = geometry.tolerance / rho;
    const double c = std::sqrt(1.0 - s * s);
    by = {(-p.x * s - sign * p.y * c) / rho, (-p.y * s + sign * p.x * c) / rho, 0.0};
  }
  const std::array<double, 5> lengths{1.0, 1.0 - 1e-7, 1.0 - 1e-6, 0.99, random.unit()};
  const double length = reachOf(geometry) * random.oneOf(lengths);
  return {p.x + by.x * length, p.y + by.y * length, p.z + by.z * length};
}

template <typename Mask>
std::uint32_t tileOf(const Mask& mask, const Point& p) {
  std::uint32_t tile = 0;
  mask.tilesOf(&p.x, &p.y, &p.z, 1, &tile);
  EXPECT_LT(tile, mask.tileCount());
  return tile;
}

template <typename Mask>
bool shows(const Mask& mask, const lisco::Box& box, std::uint32_t tile) {
  bool shown = false;
  mask.forEachTile(box, [&](std::uint32_t visited) { shown |= visited == tile; });
  return shown;
}

std::string print(const Point& p) {
  return "(" + testing::PrintToString(p.x) + ", " + testing::PrintToString(p.y) + ", " + testing::PrintToString(p.z) +
         ")";
}

/// Draws pairs until enough are neighbours; also with other returns of the first one's tile around it, as a
/// patch would have them. \return how many pairs were neighbours
template <typename Mask>
int expectSound(const Mask& mask, const Geometry& geometry, Random& random) {
  const auto tolerance = static_cast<float>(geometry.tolerance);
  int neighbours = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    const Vector seen = firstOfPair(random, geometry);
    const Point p = placed(geometry, seen);
    const Point q = placed(geometry, secondOfPair(random, geometry, seen));
    if (!isValid(p) || !isValid(q) || !areNeighbours(p, q, tolerance)) continue;
    ++neighbours;
    const std::uint32_t tile = tileOf(mask, p);
    const std::uint32_t other = tileOf(mask, q);
    lisco::Box box = lisco::Box::around(p.x, p.y, p.z);
    if (!shows(mask, box, other)) {
      ADD_FAILURE() << "pair " << pair << ": the mask of " << print(p) << " misses " << print(q);
      return neighbours;
    }
    for (int i = 0; i < 4; ++i) {
      const Point companion = placed(geometry, secondOfPair(random, geometry, seen));
      if (isValid(companion) && tileOf(mask, companion) == tile)
        box.add(lisco::Box::around(companion.x, companion.y, companion.z));
    }
    if (!shows(mask, box, other)) {
      ADD_FAILURE() << "pair " << pair << ": the mask of " << print(p) << " and others misses " << print(q);
      return neighbours;
    }
  }
  return neighbours;
}

class MaskSoundness : public testing::TestWithParam<Geometry> {};

TEST_P(MaskSoundness, ViewMaskShowsTheTileOfEveryNeighbour) {
  lisco::ViewMask mask;
  for (std::size_t hints = 0; hints < kHints.size(); ++hints) {
    SCOPED_TRACE("hints " + std::to_string(hints));
    Random random(hints + 1);
    lisco::ViewHints view = kHints[hints];
    view.origin = GetParam().origin;
    mask.prepare(lisco::Tolerance(static_cast<float>(GetParam().tolerance)), view, kManyReturns);
    EXPECT_GT(expectSound(mask, GetParam(), random), kPairs / 20);
  }
}

// The sensor stands elsewhere than the mask believes: only slower, never wrong.
TEST_P(MaskSoundness, ViewMaskFromAWrongPlace) {
  lisco::ViewMask mask;
  Random random(77);
  lisco::ViewHints view;
  for (std::size_t axis = 0; axis < 3; ++axis)
    view.origin[axis] = GetParam().origin[axis] + static_cast<float>(random.between(-3.0, 3.0) * reachOf(GetParam()));
  mask.prepare(lisco::Tolerance(static_cast<float>(GetParam().tolerance)), view, kManyReturns);
  expectSound(mask, GetParam(), random);
}

TEST_P(MaskSoundness, GridMaskShowsTheCellOfEveryNeighbour) {
  lisco::GridMask mask;
  for (const std::size_t returns : {std::size_t{0}, std::size_t{1000}, std::size_t{2000000}}) {
    SCOPED_TRACE("expected returns " + std::to_string(returns));
    Random random(returns + 1);
    mask.prepare(lisco::Tolerance(static_cast<float>(GetParam().tolerance)), returns);
    EXPECT_GT(expectSound(mask, GetParam(), random), kPairs / 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Geometries, MaskSoundness, testing::ValuesIn(kGeometries),
                         [](const auto& geometry) { return geometry.param.name; });

// Any box, not only what fits a tile: its corners, edges and inside, and neighbours of all of these.
TEST(Mask, ViewMaskOfAnyBox) {
  constexpr float kTolerance = 0.5F;
  const Geometry anywhere{"any box", anyAzimuth, anyElevation, 1e-3, 1e4, 0.5};
  lisco::ViewMask mask;
  mask.prepare(lisco::Tolerance(kTolerance), {{}, 0.01F, 0.01F}, kManyReturns);
  Random random(5);
  for (int i = 0; i < 4000; ++i) {
    const Vector centre = firstOfPair(random, anywhere);
    const double size = random.magnitude(1e-3, 100.0);
    std::vector<Point> corners;
    lisco::Box box{};
    for (int corner = 0; corner < 2; ++corner) {
      const Point at =
          placed(anywhere, {centre.x + size * random.between(-1, 1), centre.y + size * random.between(-1, 1),
                            centre.z + size * random.between(-1, 1)});
      if (corner == 0)
        box = lisco::Box::around(at.x, at.y, at.z);
      else
        box.add(lisco::Box::around(at.x, at.y, at.z));
    }
    for (int k = 0; k < 5; ++k) {
      const auto inside = [&](std::size_t axis) {
        const std::array<double, 3> fractions{0.0, 1.0, random.unit()};
        return static_cast<double>(box.lo[axis]) +
               random.oneOf(fractions) * static_cast<double>(box.hi[axis] - box.lo[axis]);
      };
      const Vector p{inside(0), inside(1), inside(2)};
      const Point q = placed(anywhere, secondOfPair(random, anywhere, p));
      const Point first = placed(anywhere, p);
      const auto within = [&](float value, std::size_t axis) { return value >= box.lo[axis] && value <= box.hi[axis]; };
      if (!within(first.x, 0) || !within(first.y, 1) || !within(first.z, 2)) continue;
      if (!areNeighbours(first, q, kTolerance)) continue;
      ASSERT_TRUE(shows(mask, box, tileOf(mask, q)))
          << "box " << i << ": the mask of " << print(first) << " misses " << print(q);
    }
  }
}

// A box seen from its middle covers nearly half a turn, to either side of its corners.
TEST(Mask, ViewMaskOfAWallOfNearlyHalfATurn) {
  constexpr float kTolerance = 0.5F;
  lisco::ViewMask mask;
  mask.prepare(lisco::Tolerance(kTolerance), {{}, 0.1F, 0.1F}, kManyReturns);
  for (const float side : {-1.0F, 1.0F})
    for (const bool along_y : {false, true}) {
      const float away = 2.0F * side;
      const lisco::Box wall = along_y ? lisco::Box{{away, -1e4F, -0.1F}, {away, 1e4F, 0.1F}}
                                      : lisco::Box{{-1e4F, away, -0.1F}, {1e4F, away, 0.1F}};
      const Point in_front = along_y ? Point{away, 0.1F, 0.1F} : Point{0.1F, away, 0.1F};
      EXPECT_TRUE(shows(mask, wall, tileOf(mask, in_front))) << side << (along_y ? " along y" : " along x");
    }
}

TEST(Mask, WithoutNeighboursThereIsStillATile) {
  for (const float tolerance : {0.0F, 1e-30F, std::numeric_limits<float>::quiet_NaN()}) {
    lisco::ViewMask view;
    view.prepare(lisco::Tolerance(tolerance), {}, kManyReturns);
    lisco::GridMask grid;
    grid.prepare(lisco::Tolerance(tolerance), 100);
    for (const Point& p : {Point{1, 2, 3}, Point{3e38F, -3e38F, 3e38F}, Point{0, 0, -1e-45F}}) {
      EXPECT_LT(tileOf(view, p), view.tileCount());
      EXPECT_LT(tileOf(grid, p), grid.tileCount());
    }
  }
}

}  // namespace
}  // namespace lisco_test
