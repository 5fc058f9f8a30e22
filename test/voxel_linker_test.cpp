// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Near returns in their cubes, alone: what are neighbours is found, however it comes, and nothing else is joined.
#include "core/near/voxel_linker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/neighbour.h"
#include "core/ring_block.h"
#include "engine.h"
#include "lisco/simd.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kPairs = 3000;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

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
    {"large_numbers", anyAzimuth, anyElevation, 3e5, 3e6},  // where numbers are computed in double
    {"wrapping_numbers", anyAzimuth, anyElevation, 1e6, 1e7, 0.5, {0.0F, 2e9F, -2e9F}},
    {"greatest_numbers", anyAzimuth, anyElevation, 1.0, 1e10, 1e-9, {0.0F, 0.0F, 1e38F}},
    {"unbounded_tolerance", anyAzimuth, anyElevation, 1e-30, 1e8, 1e30},
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

/// The side of a cube.
double sideOf(const Geometry& geometry) {
  return 0.9999 * lisco::Tolerance(static_cast<float>(geometry.tolerance)).reach() / std::sqrt(3.0);
}

/// Where cubes meet, in one axis.
double atCubesEnd(Random& random, const Geometry& geometry, std::size_t axis, double coordinate) {
  const double side = sideOf(geometry);
  const double moved = coordinate + static_cast<double>(geometry.origin[axis]);
  return std::round(moved / side) * side * (1.0 + (random.chance(0.5) ? 1e-7 : 1e-4) * random.between(-1, 1)) -
         static_cast<double>(geometry.origin[axis]);
}

Vector firstOfPair(Random& random, const Geometry& geometry) {
  const Vector to = direction(geometry.azimuth(random), geometry.elevation(random));
  const double range = reachOf(geometry) * random.magnitude(geometry.least_range, geometry.greatest_range);
  Vector p{to.x * range, to.y * range, to.z * range};
  if (random.chance(0.3)) p.x = atCubesEnd(random, geometry, 0, p.x);
  if (random.chance(0.3)) p.y = atCubesEnd(random, geometry, 1, p.y);
  if (random.chance(0.3)) p.z = atCubesEnd(random, geometry, 2, p.z);
  return p;
}

/// Something about a tolerance away: often across the line of sight, where angles grow fastest, or along it.
Vector secondOfPair(Random& random, const Geometry& geometry, const Vector& p) {
  Vector by = anyDirection(random);
  const double rho = std::hypot(p.x, p.y);
  const double range = std::hypot(rho, p.z);
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  const std::size_t kind = random.below(7);
  if (kind == 1 && rho > 0.0) by = {-sign * p.y / rho, sign * p.x / rho, 0.0};
  if (kind == 2 && rho > 0.0)
    by = {-sign * p.z * p.x / (rho * range), -sign * p.z * p.y / (rho * range), sign * rho / range};
  if (kind == 3 && range > 0.0) by = {sign * p.x / range, sign * p.y / range, sign * p.z / range};
  if (kind == 4 && rho > geometry.tolerance) {  // the tangent from the axis to the disk around p
    const double s = geometry.tolerance / rho;
    const double c = std::sqrt(1.0 - s * s);
    by = {(-p.x * s - sign * p.y * c) / rho, (-p.y * s + sign * p.x * c) / rho, 0.0};
  }
  if (kind == 5) {  // along a diagonal of the cubes
    const auto along = [&random] { return (random.chance(0.5) ? 1.0 : -1.0) / std::sqrt(3.0); };
    by = {along(), along(), along()};
  }
  if (kind == 6) {
    const std::array<Vector, 3> axes{{{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}}};
    by = random.oneOf(axes);
  }
  const std::array<double, 6> lengths{1.0 + 1e-7, 1.0, 1.0 - 1e-7, 1.0 - 1e-6, 0.99, random.unit()};
  const double length = reachOf(geometry) * random.oneOf(lengths);
  return {p.x + by.x * length, p.y + by.y * length, p.z + by.z * length};
}

/// Joins what voxels find in others.
class Joiner : public lisco::PairVisitor {
 public:
  explicit Joiner(lisco::DisjointSets& subclusters) : subclusters_(subclusters) {}
  bool inDifferentSets(std::uint32_t own, std::uint32_t others) override {
    return subclusters_.find(own) != subclusters_.find(others);
  }
  void join(std::uint32_t own, std::uint32_t others) override { subclusters_.merge(own, others); }

 private:
  lisco::DisjointSets& subclusters_;
};

/// A voxel grid and its linker.
struct NearPart {
  lisco::VoxelGrid grid;
  lisco::VoxelLinker linker;
};

/// Near returns alone, and the sets they form.
class Probe {
 public:
  explicit Probe(float tolerance) { begin(tolerance); }

  void begin(float tolerance) {
    tolerance_ = lisco::Tolerance(tolerance);
    added_.clear();
    runs_ = 0;
    subclusters_.reset(0);
    voxels_.grid.prepare(tolerance_);
    others_.grid.prepare(tolerance_);
  }

  /// Adds a row of up to 64 cells, of which some are no returns, and of those that are some only.
  /// \param apart to other voxels, to which these are linked
  void addRow(const std::vector<Point>& cells, std::uint64_t which = ~std::uint64_t{0}, bool apart = false) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      row_.x[lisco::RingBlock::kMargin + i] = cells[i].x;
      row_.y[lisco::RingBlock::kMargin + i] = cells[i].y;
      row_.z[lisco::RingBlock::kMargin + i] = cells[i].z;
    }
    lisco::measure(row_, cells.size(), tolerance_.squared(), lisco::FarRange(), measured_);
    which &= measured_.returns;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if ((measured_.returns >> i & 1U) == 0) continue;
      if ((measured_.starts >> i & 1U) != 0) {  // the engine's runs: each chain of neighbours is one
        ++runs_;
        subclusters_.grow(runs_);
        subclusters_.create(runs_ - 1);
      }
      measured_.run[i] = runs_ - 1;
      if ((which >> i & 1U) != 0) added_.push_back({cells[i], runs_ - 1});
    }
    if (which != 0) (apart ? others_ : voxels_).grid.add(row_, measured_, which, subclusters_);
  }
  void add(const Point& point) { addRow({point}); }
  void link() {
    Joiner joiner(subclusters_);
    for (NearPart* one : {&voxels_, &others_}) one->linker.link(one->grid, subclusters_);
    lisco::VoxelLinker::linkTo(voxels_.grid, others_.grid, lisco::VoxelLinker::Part::kNew, joiner);
    lisco::VoxelLinker::linkTo(others_.grid, voxels_.grid, lisco::VoxelLinker::Part::kNew, joiner);
    for (NearPart* one : {&voxels_, &others_}) lisco::VoxelLinker::markLinked(one->grid);
  }

  /// Two of the returns added, in their order.
  bool joined(std::size_t a, std::size_t b) {
    return subclusters_.find(added_[a].run) == subclusters_.find(added_[b].run);
  }

  /// What differs from the clusters of all returns added. Runs that were added in part only still are one.
  std::string wrong(float tolerance) {
    std::vector<Point> points;
    std::map<std::uint32_t, Cluster> by_head;
    for (const auto& [point, run] : added_) {
      by_head[subclusters_.find(run)].members.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(point);
    }
    Clustering found;
    for (auto& [head, cluster] : by_head) found.push_back({cluster.members, cluster.members.size()});
    return difference(trueClusters(points, tolerance), inOrder(std::move(found)));
  }

 private:
  struct Added {
    Point point;
    std::uint32_t run;
  };
  lisco::Tolerance tolerance_;
  NearPart voxels_;
  NearPart others_;
  lisco::DisjointSets subclusters_;
  std::vector<Added> added_;
  std::uint32_t runs_ = 0;
  lisco::RingBlock row_{};
  lisco::RingBlockInfo measured_{};
};

std::string print(const Point& p) {
  return "(" + testing::PrintToString(p.x) + ", " + testing::PrintToString(p.y) + ", " + testing::PrintToString(p.z) +
         ")";
}

class VoxelPairs : public testing::TestWithParam<Geometry> {};

// In either order, at once or with a look in between, in one row or in two.
TEST_P(VoxelPairs, AreJoinedIfTheyAreNeighbours) {
  const auto tolerance = static_cast<float>(GetParam().tolerance);
  Probe probe(tolerance);
  int neighbours = 0;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(kPairs); ++seed) {
    Random random(seed);
    const Vector seen = firstOfPair(random, GetParam());
    const Point p = placed(GetParam(), seen);
    const Point q = placed(GetParam(), secondOfPair(random, GetParam(), seen));
    if (!isValid(p) || !isValid(q)) continue;
    const bool near = areNeighbours(p, q, tolerance);
    neighbours += near ? 1 : 0;
    const SimdLevel level(levels()[seed % levels().size()]);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + lisco::simdLevel() + ": " + print(p) + ", " + print(q));
    for (const auto& [one, other] : {std::pair{p, q}, std::pair{q, p}})
      for (const bool linked_between : {false, true}) {
        probe.begin(tolerance);
        probe.add(one);
        if (linked_between) probe.link();
        probe.add(other);
        probe.link();
        ASSERT_EQ(probe.joined(0, 1), near) << "in two rows" << (linked_between ? ", linked between" : "");
      }
    std::vector<Point> cells(64, Point{0, 0, 0});
    cells[random.below(30)] = p;
    cells[32 + random.below(32)] = q;
    probe.begin(tolerance);
    probe.addRow(cells);
    probe.link();
    ASSERT_EQ(probe.joined(0, 1), near) << "in one row";
    probe.begin(tolerance);
    probe.addRow({p, q});
    probe.link();
    ASSERT_EQ(probe.joined(0, 1), near) << "side by side";
    probe.begin(tolerance);
    probe.add(p);
    if (random.chance(0.5)) probe.link();
    probe.addRow({q}, 1, true);
    probe.link();
    ASSERT_EQ(probe.joined(0, 1), near) << "apart";
  }
  EXPECT_GT(neighbours, kPairs / 20);
}

INSTANTIATE_TEST_SUITE_P(Geometries, VoxelPairs, testing::ValuesIn(kGeometries),
                         [](const auto& geometry) { return geometry.param.name; });

/// In parts, so that they can run side by side.
class VoxelClouds : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, VoxelClouds, testing::Range<std::uint64_t>(1, 4));

/// Rows of returns in a space of some cubes; those of a row follow each other, or lie anywhere.
std::vector<std::vector<Point>> randomRows(Random& random, double side, std::size_t most_rows) {
  const std::array<double, 6> extents{0.7, 3.0, 5.0, 12.0, 30.0, 100.0};
  const double extent = side * random.oneOf(extents);
  const double height = random.chance(0.4) ? 0.0 : extent;
  const std::array<double, 5> displacements{0.0, 0.0, 100.0, 1e5, 3e6};
  const double displacement = side * random.oneOf(displacements);
  const double step = side * random.magnitude(0.01, 3.0);
  const double lost = random.chance(0.5) ? random.unit() : 0.0;
  const bool lattice = random.chance(0.2);
  std::vector<std::vector<Point>> rows(1 + random.below(most_rows));
  for (std::vector<Point>& row : rows) {
    std::array<double, 3> at{random.between(-extent, extent), random.between(-extent, extent),
                             random.between(-height, height)};
    const bool anywhere = random.chance(0.3);
    row.resize(1 + random.below(64));
    for (Point& cell : row) {
      for (double& axis : at) {
        axis = anywhere ? random.between(-extent, extent) : axis + random.between(-step, step);
        if (lattice) axis = side * std::round(axis / side);
      }
      cell = random.chance(lost) ? Point{0, kNan, 0}
                                 : Point{static_cast<float>(at[0] + displacement),
                                         static_cast<float>(at[1] - displacement), static_cast<float>(at[2])};
    }
  }
  return rows;
}

TEST_P(VoxelClouds, EqualTheOracle) {
  const std::uint64_t seeds = GetParam() * 1'000'000;
  Probe probe(1.0F);
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(random.oneOf(levels()));
    const std::array<float, 5> tolerances{1.0F, 0.3F, 1e-17F, 1e10F, 7e-22F};
    const float tolerance = random.oneOf(tolerances);
    const auto rows = randomRows(random, 0.9999 / std::sqrt(3.0) * static_cast<double>(tolerance), 30);
    probe.begin(tolerance);
    const std::array<double, 4> chances{0.0, 0.0, 0.2, 1.0};
    const double looks = random.oneOf(chances);
    const double apart = random.oneOf(chances);
    for (const auto& row : rows) {
      probe.addRow(row, ~std::uint64_t{0}, random.chance(apart));
      if (!random.chance(looks)) continue;
      probe.link();
      ASSERT_EQ(probe.wrong(tolerance), "") << "in between";
    }
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "");
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "") << "linked once more";
  }
}

// Some returns of a row only, as where the others have places in a strip: all of them single, none is a run.
TEST_P(VoxelClouds, OfSomeReturnsOfEachRow) {
  const std::uint64_t seeds = GetParam() * 1'000'000 + 500'000;
  Probe probe(1.0F);
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto rows = randomRows(random, 0.9999 / std::sqrt(3.0), 20);
    probe.begin(1.0F);
    for (const auto& row : rows) {
      std::vector<Point> alternating;
      for (std::size_t i = 0; i < row.size() && alternating.size() < 63; ++i) {
        alternating.push_back(row[i]);
        alternating.push_back({1e6F + 10.0F * static_cast<float>(i), 0, 0});  // is not added
      }
      probe.addRow(alternating, 0x5555555555555555U & ~(random.chance(0.5) ? std::uint64_t{0xFF} << 8 : 0U));
      if (random.chance(0.1)) probe.link();
    }
    probe.link();
    ASSERT_EQ(probe.wrong(1.0F), "");
  }
}

// Along an axis, as far apart as neighbours can be, where numbers computed in float begin to be too coarse.
TEST(VoxelLinker, WhereNumbersAreRounded) {
  Probe probe(1.0F);
  int apart = 0;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(30000); ++seed) {
    Random random(seed);
    const auto tolerance = static_cast<float>(random.between(0.5, 2.0));
    const double side = 0.9999 / std::sqrt(3.0) * static_cast<double>(tolerance);
    const auto one = static_cast<float>((random.chance(0.5) ? 1.0 : -1.0) * side * random.magnitude(0x1p18, 0x1p25));
    float other = one;
    for (float next = one; areNeighbours({one, 0, 0}, {next, 0, 0}, tolerance);
         next = std::nextafter(next, std::numeric_limits<float>::infinity()))
      other = next;
    if (other == one) continue;
    ++apart;
    const auto aside = static_cast<float>(random.between(-3.0, 3.0));
    std::array<Point, 2> points{{{one, aside, 1.0F}, {other, aside, 1.0F}}};
    if (seed % 3 > 0)
      for (Point& point : points) std::swap(point.x, seed % 3 == 1 ? point.y : point.z);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + print(points[0]) + ", " + print(points[1]));
    const SimdLevel level(random.oneOf(levels()));
    probe.begin(tolerance);
    for (const Point& point : points) {
      // Beside another return that makes the whole row's numbers double; or not.
      if (random.chance(0.3))
        probe.addRow({point, {0, 0, 0}, {1e9F + static_cast<float>(seed), 0, 0}}, random.chance(0.5) ? 5 : 1);
      else
        probe.add(point);
    }
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "");
  }
  EXPECT_GT(apart, 10000);
}

// So far out that neighbouring floats, some of them alike, are many cubes apart, and numbers wrap.
TEST(VoxelLinker, WhereNumbersWrap) {
  Probe probe(1.0F);
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(200); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto tolerance = static_cast<float>(random.magnitude(1e-3, 1e3));
    const double turn = 0.9999 / std::sqrt(3.0) * static_cast<double>(tolerance) * 4294967296.0;
    probe.begin(tolerance);
    std::vector<Point> cells;
    for (int i = 0; i < 300; ++i) {
      const auto coordinate = [&] {
        const double turns = static_cast<double>(random.below(5)) - 2.0;
        return static_cast<float>(turns * turn + static_cast<double>(tolerance) * random.between(-2.0, 2.0));
      };
      cells.push_back(
          {coordinate(), random.chance(0.5) ? coordinate() : 1.0F, random.chance(0.5) ? coordinate() : 1.0F});
      if (cells.size() < 64) continue;
      probe.addRow(cells);
      cells.clear();
      if (random.chance(0.3)) probe.link();
    }
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "");
  }
}

// A cube is shared by those whose numbers are the same modulo 2^32: what does not fit together stays apart.
TEST(VoxelLinker, OneCubeOfManyUnits) {
  constexpr float kTolerance = 1.0F;
  const double turn = 0.9999 / std::sqrt(3.0) * 4294967296.0;
  for (const bool linked : {false, true}) {
    Probe probe(kTolerance);
    for (int time = 0; time < 3; ++time)
      for (int i = -4; i <= 4; ++i) {
        // There, floats are 128 m and more apart.
        probe.add({static_cast<float>(i * turn), 0.3F, 0.3F});
        probe.add({static_cast<float>(i * turn), 0.3F + 0.4F * static_cast<float>(time), 0.3F});
        if (linked) probe.link();
      }
    probe.link();
    EXPECT_EQ(probe.wrong(kTolerance), "");
  }
}

// At the least and the greatest floats, where d2 under- or overflows.
TEST(VoxelLinker, WhereSquaresEnd) {
  for (const float tolerance :
       {5e-23F, 1e-22F, 2e-22F, 1e-21F, 1.8e19F, 3e19F, 1e30F, std::numeric_limits<float>::infinity()}) {
    Probe probe(tolerance);
    const double reach = lisco::Tolerance(tolerance).reach();
    for (std::uint64_t seed = 1; seed < 1 + timesEffort(60); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", tolerance " + testing::PrintToString(tolerance));
      Random random(seed);
      probe.begin(tolerance);
      const double extent = reach * random.magnitude(0.3, 3.0);
      for (int row = 0; row < 6; ++row) {
        std::vector<Point> cells(1 + random.below(20));
        for (Point& cell : cells)
          for (float* axis : {&cell.x, &cell.y, &cell.z}) *axis = static_cast<float>(random.between(-extent, extent));
        probe.addRow(cells);
        if (random.chance(0.3)) probe.link();
      }
      probe.link();
      ASSERT_EQ(probe.wrong(tolerance), "");
    }
  }
}

// The list of a block's cubes moves as it grows; all 64 of a block are found, from wherever it began.
TEST(VoxelLinker, ABlockOfAllItsCubes) {
  constexpr float kTolerance = 1.0F;
  const double side = 0.9999 / std::sqrt(3.0);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<int> order(3 * 64);  // three blocks at once, so that their lists must move
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    random.shuffle(order);
    Probe probe(kTolerance);
    const double shift = random.chance(0.5) ? 0.5 : random.between(0.0, 1.0);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const int cube = order[i];
      const auto inside = [&](int number) { return static_cast<float>(side * (number + shift)); };
      probe.add({inside((cube & 3) + (cube >> 6) * 8), inside(cube >> 2 & 3), inside(cube >> 4 & 3)});
      if (seed % 3 == 0 || i == 100) {
        probe.link();
        ASSERT_EQ(probe.wrong(kTolerance), "") << i;
      }
    }
    probe.link();
    ASSERT_EQ(probe.wrong(kTolerance), "");
  }
}

// More blocks than the table has slots at first; each is found again, before and after the table has grown.
// Blocks of cubes that touch along a face, an edge or at a corner, all of them at once or one after the other: around
// the origin, where numbers change their sign, and where numbers are last computed in float.
TEST(VoxelLinker, BlocksInEveryDirection) {
  constexpr float kTolerance = 1.0F;
  const double block = 4 * 0.9999 / std::sqrt(3.0);
  for (const double corner : {0.0, -7.0, 200.0, 262143.0, -262143.0, 262144.0, -262144.0})
    for (const bool linked_between : {false, true})
      for (int direction = 0; direction < 27; ++direction) {
        SCOPED_TRACE("block " + std::to_string(corner) + ", direction " + std::to_string(direction));
        const std::array<int, 3> to{direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
        const auto at = [&](double side) {  // how far from the corner, in tolerances
          const auto along = [&](std::size_t axis) {
            return static_cast<float>(corner * block + (to[axis] == 0 ? 1.0 : side * to[axis]));
          };
          return Point{along(0), along(1), along(2)};
        };
        const Point near = at(0.25);
        const Point nearer = at(-0.25);
        Probe probe(kTolerance);
        probe.add(near);
        if (linked_between) probe.link();
        probe.add(nearer);
        probe.add(at(2.0));
        probe.link();
        EXPECT_EQ(probe.joined(0, 1), areNeighbours(near, nearer, kTolerance));
        EXPECT_EQ(probe.wrong(kTolerance), "");
      }
}

// Two crowds of returns that are all but neighbours: each has more of them near the other than are looked at together.
TEST(VoxelLinker, CrowdsApart) {
  constexpr float kTolerance = 1.0F;
  for (const std::string& level : levels())
    for (const std::size_t bridge : {0, 1, 100, 399}) {
      SCOPED_TRACE(level + ", " + std::to_string(bridge));
      const SimdLevel used(level);
      Random random(bridge + 1);
      Probe probe(kTolerance);
      for (std::size_t i = 0; i < 400; ++i)
        for (const double side : {-0.501, 0.501}) {
          const double x = i == bridge && bridge > 0 ? 0.9 * side : side;
          const auto across = [&random] { return static_cast<float>(random.between(0.01, 0.04)); };
          probe.add({static_cast<float>(x), across(), across()});
        }
      probe.link();
      EXPECT_EQ(probe.wrong(kTolerance), "");
      EXPECT_EQ(probe.joined(0, 1), bridge > 0);
    }
}

TEST(VoxelLinker, TheTableGrows) {
  constexpr float kTolerance = 1.0F;
  Probe probe(kTolerance);
  for (const bool in_between : {false, true})
    for (const float spacing : {4.0F, 1000.0F}) {
      probe.begin(kTolerance);
      Random random(1);
      constexpr std::size_t kSites = 1500;
      std::vector<Point> sites;
      for (std::size_t i = 0; i < kSites; ++i)
        sites.push_back({1.0F + spacing * static_cast<float>(i % 40), spacing * static_cast<float>(i / 40),
                         spacing * static_cast<float>(random.below(3))});
      for (const float aside : {0.0F, 0.6F})
        for (std::size_t i = 0; i < kSites; ++i) {
          probe.add({sites[i].x + aside, sites[i].y, sites[i].z});
          if (in_between && i % 100 == 0) probe.link();
        }
      probe.link();
      for (std::size_t i = 0; i < kSites; ++i) ASSERT_TRUE(probe.joined(i, i + kSites)) << i;
      for (std::size_t i = 1; i < kSites; ++i) ASSERT_FALSE(probe.joined(0, i)) << i;
    }
}

TEST(VoxelLinker, NothingOfTheLastRotationIsLeft) {
  Probe probe(1.0F);
  for (int rotation = 0; rotation < 3; ++rotation) {
    probe.begin(1.0F);
    for (int i = 0; i < 500; ++i) probe.add({0.1F * static_cast<float>(i), 0.0F, 0.5F});
    probe.link();
    EXPECT_TRUE(probe.joined(0, 499));
    probe.begin(1.0F);
    for (int i = 0; i < 20; ++i) probe.add({5.0F * static_cast<float>(i), 0.0F, 0.5F});
    probe.link();
    for (std::size_t i = 1; i < 20; ++i) EXPECT_FALSE(probe.joined(0, i)) << i;
  }
}

TEST(VoxelLinker, OthersAreLinkedAgainWhenTheyHaveGrown) {
  Probe probe(1.0F);
  probe.link();
  probe.addRow({{0.5F, 0, 0}}, 1, true);
  probe.link();
  probe.addRow({{1.4F, 0, 0}, {9.0F, 0, 0}});
  probe.addRow({{9.5F, 0, 0}}, 1, true);
  probe.link();
  EXPECT_EQ(probe.wrong(1.0F), "");
  EXPECT_TRUE(probe.joined(0, 1));
  EXPECT_TRUE(probe.joined(2, 3));
  EXPECT_FALSE(probe.joined(0, 2));
}

TEST(VoxelLinker, WithoutNeighboursNothingIsJoined) {
  for (const float tolerance : {0.0F, 1e-30F, kNan}) {
    Probe probe(tolerance);
    for (int time = 0; time < 2; ++time) {
      probe.addRow({{1, 2, 3}, {1, 2, 3}, {3e38F, -3e38F, 3e38F}, {0, 0, -1e-45F}});
      probe.link();
    }
    EXPECT_EQ(probe.wrong(tolerance), "");
  }
}

}  // namespace
}  // namespace lisco_test
