// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Near returns in their voxels, alone: neighbours are joined in any order, other returns are not.
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

/// The first return of a pair as seen from the sensor, and the tolerance.
struct Geometry {
  const char* name;
  double (*azimuth)(Random&);
  double (*elevation)(Random&);
  double min_range, max_range;  ///< in units of the tolerance
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

/// The longest distance up to the tolerance that does not overflow.
double reachOf(const Geometry& geometry) {
  return std::min(geometry.tolerance, 1.8e19);
}

/// The side of a voxel.
double sideOf(const Geometry& geometry) {
  return 0.9999 * lisco::Tolerance(static_cast<float>(geometry.tolerance)).reach() / std::sqrt(3.0);
}

/// A coordinate at the border of two voxels.
double atVoxelBorder(Random& random, const Geometry& geometry, std::size_t axis, double coordinate) {
  const double side = sideOf(geometry);
  const double moved = coordinate + static_cast<double>(geometry.origin[axis]);
  return std::round(moved / side) * side * (1.0 + (random.chance(0.5) ? 1e-7 : 1e-4) * random.between(-1, 1)) -
         static_cast<double>(geometry.origin[axis]);
}

Vector firstOfPair(Random& random, const Geometry& geometry) {
  const Vector to = direction(geometry.azimuth(random), geometry.elevation(random));
  const double range = reachOf(geometry) * random.magnitude(geometry.min_range, geometry.max_range);
  Vector p{to.x * range, to.y * range, to.z * range};
  if (random.chance(0.3)) p.x = atVoxelBorder(random, geometry, 0, p.x);
  if (random.chance(0.3)) p.y = atVoxelBorder(random, geometry, 1, p.y);
  if (random.chance(0.3)) p.z = atVoxelBorder(random, geometry, 2, p.z);
  return p;
}

/// A point about a tolerance away: often across the line of sight, where angles grow fastest, or along it.
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
  if (kind == 5) {  // along a diagonal of the voxels
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

/// Joins the pairs that voxels find in others.
class JoiningVisitor : public lisco::PairVisitor {
 public:
  explicit JoiningVisitor(lisco::DisjointSets& subclusters) : subclusters_(subclusters) {}
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
    voxels_.grid.prepare(tolerance_);
    others_.grid.prepare(tolerance_);
  }

  /// Adds up to 64 cells of a ring block, some of which are no returns.
  /// \param which bit i: cell i is added
  /// \param apart to other voxels, to which these are linked
  void addBlock(const std::vector<Point>& cells, std::uint64_t which = ~std::uint64_t{0}, bool apart = false) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      block_.x[lisco::RingBlock::kMargin + i] = cells[i].x;
      block_.y[lisco::RingBlock::kMargin + i] = cells[i].y;
      block_.z[lisco::RingBlock::kMargin + i] = cells[i].z;
    }
    lisco::measure(block_, cells.size(), tolerance_.squared(), lisco::FarRange(), info_);
    which &= info_.returns;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if ((info_.returns >> i & 1U) == 0) continue;
      if ((info_.starts >> i & 1U) != 0) {  // as Runs::add: a chain of neighbours is a run
        ++runs_;
        subclusters_.grow(runs_);
        subclusters_.create(runs_ - 1);
      }
      info_.run[i] = runs_ - 1;
      if ((which >> i & 1U) != 0) added_.push_back({cells[i], runs_ - 1});
    }
    if (which != 0) (apart ? others_ : voxels_).grid.add(block_, info_, which, subclusters_);
  }
  void add(const Point& point) { addBlock({point}); }
  void link() {
    JoiningVisitor visitor(subclusters_);
    for (NearPart* one : {&voxels_, &others_}) one->linker.link(one->grid, subclusters_);
    lisco::VoxelLinker::linkTo(voxels_.grid, others_.grid, lisco::VoxelLinker::Part::kNew, visitor);
    lisco::VoxelLinker::linkTo(others_.grid, voxels_.grid, lisco::VoxelLinker::Part::kNew, visitor);
    for (NearPart* one : {&voxels_, &others_}) lisco::VoxelLinker::markLinked(one->grid);
  }

  /// Links within the voxels, as columns that follow do.
  /// \param parts at most
  void linkParts(std::size_t parts) {
    for (; parts > 0 && lisco::VoxelLinker::bricksLeft(voxels_.grid) > 0; --parts)
      EXPECT_GT(lisco::VoxelLinker::linkPart(voxels_.grid, subclusters_), 0U);
  }

  /// By their numbers in the order of adding.
  bool joined(std::size_t a, std::size_t b) {
    return subclusters_.find(added_[a].run) == subclusters_.find(added_[b].run);
  }

  /// Differences from the clusters of all returns added. A run that was added in part is still one.
  std::string wrong(float tolerance) {
    std::vector<Point> points;
    std::map<std::uint32_t, Cluster> by_root;
    for (const auto& [point, run] : added_) {
      by_root[subclusters_.find(run)].members.push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(point);
    }
    Clustering found;
    for (auto& [root, cluster] : by_root) found.push_back({cluster.members, cluster.members.size()});
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
  lisco::RingBlock block_{};
  lisco::RingBlockInfo info_{};
};

std::string print(const Point& p) {
  return "(" + testing::PrintToString(p.x) + ", " + testing::PrintToString(p.y) + ", " + testing::PrintToString(p.z) +
         ")";
}

class VoxelPairs : public testing::TestWithParam<Geometry> {};

// In either order, linked at once or in between, in one ring block or in two.
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
        ASSERT_EQ(probe.joined(0, 1), near) << "in two blocks" << (linked_between ? ", linked between" : "");
      }
    std::vector<Point> cells(64, Point{0, 0, 0});
    cells[random.below(30)] = p;
    cells[32 + random.below(32)] = q;
    probe.begin(tolerance);
    probe.addBlock(cells);
    probe.link();
    ASSERT_EQ(probe.joined(0, 1), near) << "in one block";
    probe.begin(tolerance);
    probe.addBlock({p, q});
    probe.link();
    ASSERT_EQ(probe.joined(0, 1), near) << "side by side";
    probe.begin(tolerance);
    probe.add(p);
    if (random.chance(0.5)) probe.link();
    probe.addBlock({q}, 1, true);
    probe.link();
    ASSERT_EQ(probe.joined(0, 1), near) << "apart";
  }
  EXPECT_GT(neighbours, kPairs / 20);
}

INSTANTIATE_TEST_SUITE_P(Geometries, VoxelPairs, testing::ValuesIn(kGeometries),
                         [](const auto& geometry) { return geometry.param.name; });

/// In parts that run side by side.
class VoxelClouds : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, VoxelClouds, testing::Range<std::uint64_t>(1, 4));

/// Ring blocks of returns in a space of some voxels; the returns of a block follow each other, or lie anywhere.
std::vector<std::vector<Point>> randomBlocks(Random& random, double side, std::size_t max_blocks) {
  const std::array<double, 6> extents{0.7, 3.0, 5.0, 12.0, 30.0, 100.0};
  const double extent = side * random.oneOf(extents);
  const double height = random.chance(0.4) ? 0.0 : extent;
  const std::array<double, 5> displacements{0.0, 0.0, 100.0, 1e5, 3e6};
  const double displacement = side * random.oneOf(displacements);
  const double step = side * random.magnitude(0.01, 3.0);
  const double lost = random.chance(0.5) ? random.unit() : 0.0;
  const bool lattice = random.chance(0.2);
  std::vector<std::vector<Point>> blocks(1 + random.below(max_blocks));
  for (std::vector<Point>& block : blocks) {
    std::array<double, 3> at{random.between(-extent, extent), random.between(-extent, extent),
                             random.between(-height, height)};
    const bool anywhere = random.chance(0.3);
    block.resize(1 + random.below(64));
    for (Point& cell : block) {
      for (double& axis : at) {
        axis = anywhere ? random.between(-extent, extent) : axis + random.between(-step, step);
        if (lattice) axis = side * std::round(axis / side);
      }
      cell = random.chance(lost) ? Point{0, kNan, 0}
                                 : Point{static_cast<float>(at[0] + displacement),
                                         static_cast<float>(at[1] - displacement), static_cast<float>(at[2])};
    }
  }
  return blocks;
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
    const auto blocks = randomBlocks(random, 0.9999 / std::sqrt(3.0) * static_cast<double>(tolerance), 30);
    probe.begin(tolerance);
    const std::array<double, 4> chances{0.0, 0.0, 0.2, 1.0};
    const double queries = random.oneOf(chances);
    const double apart = random.oneOf(chances);
    const double in_parts = random.oneOf(chances);
    for (const auto& block : blocks) {
      probe.addBlock(block, ~std::uint64_t{0}, random.chance(apart));
      if (random.chance(in_parts)) probe.linkParts(random.below(20));
      if (!random.chance(queries)) continue;
      probe.link();
      ASSERT_EQ(probe.wrong(tolerance), "") << "in between";
    }
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "");
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "") << "linked once more";
  }
}

// Only some returns of a ring block, as where the others are placed in the range image: none continues a run.
TEST_P(VoxelClouds, EqualTheOracleOnSomeReturns) {
  const std::uint64_t seeds = GetParam() * 1'000'000 + 500'000;
  Probe probe(1.0F);
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto blocks = randomBlocks(random, 0.9999 / std::sqrt(3.0), 20);
    probe.begin(1.0F);
    for (const auto& block : blocks) {
      std::vector<Point> alternating;
      for (std::size_t i = 0; i < block.size() && alternating.size() < 63; ++i) {
        alternating.push_back(block[i]);
        alternating.push_back({1e6F + 10.0F * static_cast<float>(i), 0, 0});  // not added
      }
      probe.addBlock(alternating, 0x5555555555555555U & ~(random.chance(0.5) ? std::uint64_t{0xFF} << 8 : 0U));
      if (random.chance(0.1)) probe.link();
    }
    probe.link();
    ASSERT_EQ(probe.wrong(1.0F), "");
  }
}

// Along an axis, as far apart as neighbours can be, where voxel numbers computed in float begin to be too coarse.
TEST(VoxelLinker, JoinsWhereNumbersAreRounded) {
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
      // With another return that makes the whole block's numbers double, or without.
      if (random.chance(0.3))
        probe.addBlock({point, {0, 0, 0}, {1e9F + static_cast<float>(seed), 0, 0}}, random.chance(0.5) ? 5 : 1);
      else
        probe.add(point);
    }
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "");
  }
  EXPECT_GT(apart, 10000);
}

// So far out that neighbouring floats, some of them equal, are many voxels apart, and voxel numbers wrap.
TEST(VoxelLinker, JoinsWhereNumbersWrap) {
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
      probe.addBlock(cells);
      cells.clear();
      if (random.chance(0.5)) probe.linkParts(random.below(20));
      if (random.chance(0.3)) probe.link();
    }
    probe.link();
    ASSERT_EQ(probe.wrong(tolerance), "");
  }
}

// Voxels whose numbers are equal modulo 2^32 share an entry: their cliques stay apart.
TEST(VoxelLinker, SeparatesCliquesOfOneVoxel) {
  constexpr float kTolerance = 1.0F;
  const double turn = 0.9999 / std::sqrt(3.0) * 4294967296.0;
  for (const bool linked : {false, true}) {
    Probe probe(kTolerance);
    for (int time = 0; time < 3; ++time)
      for (int i = -4; i <= 4; ++i) {
        // Floats are at least 128 m apart here.
        probe.add({static_cast<float>(i * turn), 0.3F, 0.3F});
        probe.add({static_cast<float>(i * turn), 0.3F + 0.4F * static_cast<float>(time), 0.3F});
        if (linked) probe.link();
      }
    probe.link();
    EXPECT_EQ(probe.wrong(kTolerance), "");
  }
}

// At the least and the greatest floats, where d2 under- or overflows.
TEST(VoxelLinker, JoinsWhereSquaresUnderflowAndOverflow) {
  for (const float tolerance :
       {5e-23F, 1e-22F, 2e-22F, 1e-21F, 1.8e19F, 3e19F, 1e30F, std::numeric_limits<float>::infinity()}) {
    Probe probe(tolerance);
    const double reach = lisco::Tolerance(tolerance).reach();
    for (std::uint64_t seed = 1; seed < 1 + timesEffort(60); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", tolerance " + testing::PrintToString(tolerance));
      Random random(seed);
      probe.begin(tolerance);
      const double extent = reach * random.magnitude(0.3, 3.0);
      for (int block = 0; block < 6; ++block) {
        std::vector<Point> cells(1 + random.below(20));
        for (Point& cell : cells)
          for (float* axis : {&cell.x, &cell.y, &cell.z}) *axis = static_cast<float>(random.between(-extent, extent));
        probe.addBlock(cells);
        if (random.chance(0.3)) probe.link();
      }
      probe.link();
      ASSERT_EQ(probe.wrong(tolerance), "");
    }
  }
}

// The list of a brick's voxels moves as it grows; all 64 voxels are found in any order.
TEST(VoxelLinker, FindsAllVoxelsOfABrick) {
  constexpr float kTolerance = 1.0F;
  const double side = 0.9999 / std::sqrt(3.0);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<int> order(3 * 64);  // three bricks at once, so that their lists move
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    random.shuffle(order);
    Probe probe(kTolerance);
    const double shift = random.chance(0.5) ? 0.5 : random.between(0.0, 1.0);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const int voxel = order[i];
      const auto inside = [&](int number) { return static_cast<float>(side * (number + shift)); };
      probe.add({inside((voxel & 3) + (voxel >> 6) * 8), inside(voxel >> 2 & 3), inside(voxel >> 4 & 3)});
      if (random.chance(0.2)) probe.linkParts(random.below(3));
      if (seed % 3 == 0 || i == 100) {
        probe.link();
        ASSERT_EQ(probe.wrong(kTolerance), "") << i;
      }
    }
    probe.link();
    ASSERT_EQ(probe.wrong(kTolerance), "");
  }
}

// Bricks that touch at a face, an edge or a corner, linked at once or in between: around the origin, where numbers
// change their sign, and where numbers are last computed in float.
TEST(VoxelLinker, JoinsBricksInEveryDirection) {
  constexpr float kTolerance = 1.0F;
  const double brick = 4 * 0.9999 / std::sqrt(3.0);
  for (const double corner : {0.0, -7.0, 200.0, 262143.0, -262143.0, 262144.0, -262144.0})
    for (const bool linked_between : {false, true})
      for (int direction = 0; direction < 27; ++direction) {
        SCOPED_TRACE("brick " + std::to_string(corner) + ", direction " + std::to_string(direction));
        const std::array<int, 3> to{direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
        const auto at = [&](double side) {  // distance from the corner, in tolerances
          const auto along = [&](std::size_t axis) {
            return static_cast<float>(corner * brick + (to[axis] == 0 ? 1.0 : side * to[axis]));
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

// Two crowds of returns just farther apart than the tolerance: more pairs than one comparison of vectors takes.
TEST(VoxelLinker, SeparatesCrowds) {
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

TEST(VoxelLinker, FindsBricksAfterTheTableHasGrown) {
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

TEST(VoxelLinker, BeginForgetsTheLastRotation) {
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

TEST(VoxelLinker, LinksOtherVoxelsAgainAfterTheyHaveGrown) {
  Probe probe(1.0F);
  probe.link();
  probe.addBlock({{0.5F, 0, 0}}, 1, true);
  probe.link();
  probe.addBlock({{1.4F, 0, 0}, {9.0F, 0, 0}});
  probe.addBlock({{9.5F, 0, 0}}, 1, true);
  probe.link();
  EXPECT_EQ(probe.wrong(1.0F), "");
  EXPECT_TRUE(probe.joined(0, 1));
  EXPECT_TRUE(probe.joined(2, 3));
  EXPECT_FALSE(probe.joined(0, 2));
}

TEST(VoxelLinker, JoinsNothingIfTheToleranceJoinsNothing) {
  for (const float tolerance : {0.0F, 1e-30F, kNan}) {
    Probe probe(tolerance);
    for (int time = 0; time < 2; ++time) {
      probe.addBlock({{1, 2, 3}, {1, 2, 3}, {3e38F, -3e38F, 3e38F}, {0, 0, -1e-45F}});
      probe.link();
    }
    EXPECT_EQ(probe.wrong(tolerance), "");
  }
}

}  // namespace
}  // namespace lisco_test
