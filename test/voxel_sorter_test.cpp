// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Returns that are read at once and sorted by voxel: VoxelSorter alone, against brute force.
#include "core/near/voxel_sorter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/near/constants.h"
#include "core/near/near_returns.h"
#include "core/neighbour.h"
#include "engine.h"
#include "lisco/simd.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kMaxParts = 8;
constexpr std::size_t kShared = 0;  ///< returns from which on threads share the work

using Position = std::array<double, 3>;

/// Near returns, one thread's after the other's.
struct Cloud {
  float tolerance = 1.0F;
  std::vector<Point> points;
  std::vector<std::uint32_t> elements;                          ///< of each point's run, ascending
  std::vector<std::pair<std::uint32_t, std::uint32_t>> merged;  ///< elements that were joined before
  std::vector<std::size_t> part_ends;

  std::uint32_t elementCount() const { return elements.empty() ? 0 : elements.back() + 1; }
  void add(const Position& position) {
    points.push_back(
        {static_cast<float>(position[0]), static_cast<float>(position[1]), static_cast<float>(position[2])});
  }
};

std::ostream& operator<<(std::ostream& out, const Cloud& cloud) {
  out << std::hexfloat << "tolerance " << cloud.tolerance << ", parts end at";
  for (const std::size_t end : cloud.part_ends) out << ' ' << end;
  for (std::size_t i = 0; i < cloud.points.size() && cloud.points.size() <= 4; ++i)
    out << ", element " << cloud.elements[i] << " at (" << cloud.points[i].x << ", " << cloud.points[i].y << ", "
        << cloud.points[i].z << ')';
  return out << std::defaultfloat << ", " << cloud.points.size() << " points";
}

/// The lowest element of the set of each, by comparing all points with all others.
std::vector<std::uint32_t> trueSets(const Cloud& cloud, bool joins_neighbours) {
  std::vector<std::uint32_t> set(cloud.elementCount());
  std::iota(set.begin(), set.end(), 0U);
  const auto merge = [&](std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(set[a], set[b]);
    if (low != high) std::replace(set.begin(), set.end(), std::uint32_t{high}, std::uint32_t{low});
  };
  for (const auto& [a, b] : cloud.merged) merge(a, b);
  for (std::size_t i = 0; i < cloud.points.size() && joins_neighbours; ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const std::uint32_t a = cloud.elements[i];
      const std::uint32_t b = cloud.elements[k];
      if (set[a] != set[b] && areNeighbours(cloud.points[i], cloud.points[k], cloud.tolerance)) merge(a, b);
    }
  return set;
}

/// The parts of a cloud. Behind each part's returns, some memory is full of others.
std::vector<lisco::NearReturns> partsOf(const Cloud& cloud) {
  std::vector<lisco::NearReturns> parts;
  std::size_t begin = 0;
  for (const std::size_t end : cloud.part_ends) {
    lisco::NearReturns& part = parts.emplace_back();
    part.count = end - begin;
    const std::size_t behind = (begin + end) % 3 == 0 || begin == end ? lisco::kReadBehind : 70;
    part.returns.grow(part.count + behind);
    for (std::size_t i = 0; i < part.returns.size(); ++i) {
      if (part.count == 0) break;
      const std::size_t point = begin + i % part.count;
      part.returns[i] = {cloud.points[point].x, cloud.points[point].y, cloud.points[point].z, cloud.elements[point]};
    }
    begin = end;
  }
  return parts;
}

/// Whether voxels could be numbered, by a wide margin.
bool isEasy(const Cloud& cloud) {
  const double reach = lisco::Tolerance(cloud.tolerance).reach();
  if (reach < 2e-18 || reach > 5e17) return false;
  double bits = 6 + 14;  // of a voxel in its brick, and of a return's number
  for (float Point::*const axis : {&Point::x, &Point::y, &Point::z}) {
    const auto [least, greatest] = std::minmax_element(
        cloud.points.begin(), cloud.points.end(), [&](const Point& a, const Point& b) { return a.*axis < b.*axis; });
    const double voxels =
        (static_cast<double>((*greatest).*axis) - static_cast<double>((*least).*axis)) / (reach / kSqrt3);
    if (voxels > 2e9) return false;
    bits += std::log2(voxels / 4 + 5) + 1;
  }
  return bits < 64;
}

/// Numbers the sets of a cloud's points, each for itself, and holds them against brute force.
/// \param is_sorted whether the sorter is expected to take the cloud
void expectTrueNumbers(lisco::VoxelSorter& sorter, Cloud cloud, bool is_sorted) {
  cloud.merged.clear();
  cloud.elements.resize(cloud.points.size());
  std::iota(cloud.elements.begin(), cloud.elements.end(), 0U);
  const std::vector<lisco::NearReturns> parts = partsOf(cloud);
  constexpr std::uint32_t kUnset = ~std::uint32_t{0};
  std::vector<lisco::VoxelSorter::SingleReturns> single;
  for (const lisco::NearReturns& part : parts) single.push_back({&part, 0});
  std::vector<std::uint32_t> sizes{7, 7};
  EXPECT_EQ(sorter.number(single, lisco::Tolerance(cloud.tolerance), sizes), is_sorted) << cloud;
  if (!is_sorted) return;
  std::vector<std::uint32_t> numbers;
  for (const auto& part : single)
    for (std::size_t i = 0; i < part.near->count; ++i) numbers.push_back(sorter.setOf(part.first + i));
  const std::vector<std::uint32_t> right = trueSets(cloud, true);
  std::vector<std::uint32_t> set_of_number(sizes.size(), kUnset);
  std::vector<std::uint32_t> true_sizes(sizes.size(), 0);
  for (std::size_t i = 0; i < right.size(); ++i) {
    ASSERT_LT(numbers[i], sizes.size()) << "point " << i << ", " << cloud;
    std::uint32_t& set = set_of_number[numbers[i]];
    if (set == kUnset) set = right[i];
    ASSERT_EQ(set, right[i]) << "point " << i << ", " << lisco::simdLevel() << ", " << cloud;
    ++true_sizes[numbers[i]];
  }
  EXPECT_EQ(sizes, true_sizes) << cloud;
  std::sort(set_of_number.begin(), set_of_number.end());
  EXPECT_EQ(std::unique(set_of_number.begin(), set_of_number.end()), set_of_number.end()) << "a set of two numbers";
}

/// Links a cloud, and holds the sets against brute force; and those of its points without runs.
/// \return whether the returns were sorted
bool expectTrueSets(lisco::VoxelSorter& sorter, const Cloud& cloud) {
  lisco::DisjointSets subclusters;
  subclusters.reserve(cloud.elementCount());
  for (std::uint32_t i = 0; i < cloud.elementCount(); ++i) subclusters.create(i);
  for (const auto& [a, b] : cloud.merged) subclusters.merge(a, b);
  const std::vector<lisco::NearReturns> parts = partsOf(cloud);
  std::vector<const lisco::NearReturns*> pointers;
  for (const lisco::NearReturns& part : parts) pointers.push_back(&part);
  const bool is_sorted = sorter.link(pointers, lisco::Tolerance(cloud.tolerance), subclusters);
  if (!is_sorted) {
    EXPECT_FALSE(isEasy(cloud)) << "the voxels were not numbered: " << cloud;
  }
  const std::vector<std::uint32_t> right = trueSets(cloud, is_sorted);
  for (std::uint32_t i = 0; i < right.size(); ++i) {
    if (subclusters.find(i) == right[i]) continue;
    ADD_FAILURE() << "element " << i << " is in set " << subclusters.find(i) << " instead of " << right[i] << ", "
                  << lisco::simdLevel() << (is_sorted ? ", " : ", not sorted, ") << cloud;
    break;
  }
  if (lisco::Tolerance(cloud.tolerance).joinsAnything()) expectTrueNumbers(sorter, cloud, is_sorted);
  return is_sorted;
}

// --- Clouds ---------------------------------------------------------------------------------------------------------

/// Side of a voxel of a small cloud, whose voxels are numbered in float.
double sideOf(const Cloud& cloud) {
  return lisco::kFloatVoxelSide * lisco::Tolerance(cloud.tolerance).reach();
}

std::size_t someCount(Random& random) {
  return random.chance(0.3) ? 1 + random.below(20) : 1 + random.below(260);
}

float nudged(Random& random, float value, int most) {
  const int steps = static_cast<int>(random.below(2 * static_cast<std::size_t>(most) + 1)) - most;
  for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, steps > 0 ? kInfinity : -kInfinity);
  return value;
}

void fillBox(Random& random, Cloud& cloud, const Position& corner, const Position& sides, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    cloud.add({corner[0] + sides[0] * random.unit(), corner[1] + sides[1] * random.unit(),
               corner[2] + sides[2] * random.unit()});
}

Position anyCorner(Random& random) {
  const double size = random.chance(0.5) ? 0 : random.magnitude(0.1, 1000);
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

void boxes(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const auto tolerance = static_cast<double>(cloud.tolerance);
  const Position corner = anyCorner(random);
  Position sides;
  for (double& side : sides) side = tolerance * random.magnitude(0.1, 20);
  fillBox(random, cloud, corner, sides, someCount(random));
}

// Thin along one axis.
void sheets(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const auto tolerance = static_cast<double>(cloud.tolerance);
  const double size = tolerance * random.magnitude(2, 30);
  Position sides{size, size * random.between(0.5, 1), size * random.between(0.5, 1)};
  sides[random.below(3)] = random.chance(0.5) ? 0 : tolerance * random.unit();
  fillBox(random, cloud, anyCorner(random), sides, someCount(random));
}

// Along one axis, in steps about the tolerance, with gaps of some planes of bricks.
void lines(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const auto tolerance = static_cast<double>(cloud.tolerance);
  const std::size_t axis = random.below(3);
  Position at = anyCorner(random);
  const double thickness = random.chance(0.5) ? 0 : random.between(0, 3) * tolerance;
  const double step = random.magnitude(0.01, 1.5);
  const std::size_t count = someCount(random);
  for (std::size_t i = 0; i < count; ++i) {
    Position here = at;
    for (double& coordinate : here) coordinate += thickness * random.unit();
    cloud.add(here);
    at[axis] += tolerance * (random.chance(0.05) ? random.magnitude(0.5, 1000) : step * random.between(0.8, 1.2));
  }
  if (random.chance(0.5)) random.shuffle(cloud.points);
}

/// On the borders of voxels, seen from the corner of the box, and a few units in the last place beside them.
/// \param first numbers of the voxels, along each axis; the corner has 0
/// \param side of a voxel
void addBorders(Random& random, Cloud& cloud, const Position& corner, const Position& first, double side) {
  const auto tolerance = static_cast<double>(cloud.tolerance);
  const std::size_t reach = 2 + random.below(10);
  const double off = random.chance(0.5) ? 0.0 : 0.3;
  cloud.add(corner);
  Position start{static_cast<double>(cloud.points.back().x), static_cast<double>(cloud.points.back().y),
                 static_cast<double>(cloud.points.back().z)};
  for (std::size_t axis = 0; axis < 3; ++axis) start[axis] += side * first[axis];
  const std::size_t count = someCount(random);
  for (std::size_t i = 0; i < count; ++i) {
    Position here = start;
    for (double& coordinate : here) {
      coordinate += side * static_cast<double>(random.below(reach));
      if (random.chance(off)) coordinate += tolerance * static_cast<double>(random.below(3));
    }
    cloud.add(here);
    for (float Point::*const axis : {&Point::x, &Point::y, &Point::z})
      cloud.points.back().*axis = nudged(random, cloud.points.back().*axis, 2);
  }
}

float someTolerance(Random& random) {
  return random.chance(0.5) ? static_cast<float>(std::ldexp(1.0, static_cast<int>(random.below(8)) - 5))
                            : static_cast<float>(random.magnitude(0.01, 10));
}

void borders(Random& random, Cloud& cloud) {
  cloud.tolerance = someTolerance(random);
  addBorders(random, cloud, anyCorner(random), {}, sideOf(cloud));
}

// The same so far from the corner that numbers are as large as they may be in float, or a little larger: in double.
void farBorders(Random& random, Cloud& cloud) {
  cloud.tolerance = someTolerance(random);
  Position first{};
  const std::size_t axes = 1 + random.below(7);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1U) != 0) first[axis] = std::floor(lisco::kMaxFloatSide * random.between(0.99, 1.004));
  const double double_side = lisco::kVoxelSide * lisco::Tolerance(cloud.tolerance).reach();
  addBorders(random, cloud, anyCorner(random), first, random.chance(0.7) ? sideOf(cloud) : double_side);
}

void duplicates(Random& random, Cloud& cloud) {
  boxes(random, cloud);
  const std::vector<Point> some(cloud.points.begin(),
                                cloud.points.begin() + static_cast<std::ptrdiff_t>((cloud.points.size() + 7) / 8));
  for (Point& point : cloud.points) point = random.oneOf(some);
}

// Pairs a tolerance apart or a little more or less, too far from each other to disturb.
void pairs(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const auto tolerance = static_cast<double>(cloud.tolerance);
  const double side = sideOf(cloud);
  const std::size_t count = 1 + random.below(60);
  const Position corner = anyCorner(random);
  for (std::size_t i = 0; i < count; ++i) {
    Position p = corner;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[axis] += 4 * tolerance * static_cast<double>(axis == 0 ? i % 8 : axis == 1 ? i / 8 : random.below(2));
      p[axis] += tolerance * random.between(0, 1.5);
      // So that numbers differ by as much as they may.
      if (random.chance(0.3)) p[axis] = corner[axis] + (std::ceil((p[axis] - corner[axis]) / side) - 1e-6) * side;
    }
    Position by{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    if (random.chance(0.3)) by[random.below(3)] = 0;
    if (random.chance(0.3)) by = {random.chance(0.5) ? 1.0 : 0.0, random.chance(0.5) ? 1.0 : 0.0, 1.0};
    const double length = std::hypot(by[0], by[1], by[2]);
    const std::array<double, 6> lengths{1.0 + 1e-7, 1.0, 1.0, 1.0 - 1e-7, 1.0 - 1e-6, 0.99};
    const double stretch = tolerance * random.oneOf(lengths) / std::max(length, 1e-3);
    cloud.add(p);
    cloud.add({p[0] + by[0] * stretch, p[1] + by[1] * stretch, p[2] + by[2] * stretch});
  }
  if (random.chance(0.5)) random.shuffle(cloud.points);
}

// Pairs at about opposite corners of a voxel, whose numbers are as large as they may be in float. Their coordinates are
// small, and finer than the differences from the corner of the box: rounding moves the borders of voxels.
void farPairs(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const double side = sideOf(cloud);
  const double corner = -side * std::floor(lisco::kMaxFloatSide * random.between(0.8, 0.95));
  cloud.add({corner, corner, corner});
  const auto start = static_cast<double>(cloud.points.front().x) - corner;
  const std::size_t count = 1 + random.below(60);
  for (std::size_t i = 0; i < count; ++i) {
    const auto voxel = 8 * static_cast<double>(i);  // along each axis, so that rounding is alike
    const std::size_t turned = random.below(4);
    const double beyond = random.between(0, 3e-4);  // of a voxel
    for (const bool is_first : {true, false}) {
      Position here{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_low = is_first != ((turned >> axis & 1U) != 0);
        here[axis] = start + side * (voxel + (is_low ? -beyond : 1 + beyond));
      }
      cloud.add(here);
    }
  }
}

// Eastings and northings, where floats are half a metre apart.
void mapCoordinates(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.05, 3));
  const double size = random.magnitude(0.1, 100);
  const double height = random.chance(0.5) ? 1 : 30;
  fillBox(random, cloud, {5e5, 5.4e6, 100}, {size, size, height}, someCount(random));
}

// Floats along one axis are about as far apart as the tolerance, and twice as far above a power of two.
void slices(Random& random, Cloud& cloud) {
  const std::size_t axis = random.below(3);
  const auto exponent = static_cast<int>(random.below(40)) - 10;
  const double step = std::ldexp(1.0, exponent - 23);
  const double ratio = random.chance(0.5) ? 1 : random.magnitude(0.2, 1.2);
  cloud.tolerance = nudged(random, static_cast<float>(ratio * step), 1);
  const auto tolerance = static_cast<double>(cloud.tolerance);
  Position corner{}, sides;
  for (double& side : sides) side = tolerance * random.magnitude(0.5, 12);
  sides[axis] = step * static_cast<double>(20 + random.below(60));
  corner[axis] = std::ldexp(random.chance(0.3) ? 2.0 : random.between(1, 2), exponent) - sides[axis] * random.unit();
  if (random.chance(0.5)) corner[axis] = -corner[axis] - sides[axis];
  fillBox(random, cloud, corner, sides, 2 + 2 * someCount(random));
  if (random.chance(0.5)) {
    // In few slices, on the borders of voxels.
    const double side = lisco::kSliceVoxelSide * lisco::Tolerance(cloud.tolerance).reach();
    const std::vector<Point> some(cloud.points.begin(), cloud.points.begin() + 2);
    for (std::size_t i = 2; i < cloud.points.size(); ++i)
      for (float Point::*const along : {&Point::x, &Point::y, &Point::z}) {
        const bool is_across = std::fabs(cloud.points[i].*along) < std::ldexp(1.0F, exponent - 1);
        if (is_across)
          cloud.points[i].*along = nudged(
              random, static_cast<float>(side * std::floor(static_cast<double>(cloud.points[i].*along) / side)), 2);
        else if (random.chance(0.8))
          cloud.points[i].*along = random.oneOf(some).*along;
      }
  }
}

// Several clouds so far apart that keys are long, or too long.
void farApart(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.001, 1));
  const auto tolerance = static_cast<double>(cloud.tolerance);
  const double size = tolerance * random.magnitude(10, 1e9);
  const std::size_t axes = 1 + random.below(7);
  for (std::size_t i = 0; i < 6; ++i) {
    Position corner;
    for (std::size_t axis = 0; axis < 3; ++axis)
      corner[axis] = (axes >> axis & 1U) != 0 ? random.between(-size, size) : 0;
    const double side = tolerance * random.between(0.1, 4);
    fillBox(random, cloud, corner, {side, side, side}, 1 + random.below(30));
  }
  if (random.chance(0.5)) random.shuffle(cloud.points);
}

// Up to where squares, and then numbers, overflow.
void hugeCoordinates(Random& random, Cloud& cloud) {
  const double size = random.magnitude(1e6, 3e38);
  cloud.tolerance = static_cast<float>(size * random.magnitude(1e-12, 1));
  const double side = random.chance(0.5) ? size : static_cast<double>(cloud.tolerance) * random.between(1, 9);
  Position corner;
  for (double& coordinate : corner) coordinate = random.chance(0.5) ? -side / 2 : random.between(-size, size);
  for (double& coordinate : corner) coordinate = std::clamp(coordinate, -3.4e38, 3.4e38 - side);
  fillBox(random, cloud, corner, {side, side, side}, someCount(random));
}

// Tolerances around the least and greatest for which voxels are numbered.
void endsOfTolerances(Random& random, Cloud& cloud) {
  const double end = random.chance(0.5) ? 1e-18 : 1e18;
  cloud.tolerance =
      static_cast<float>(end * (random.chance(0.5) ? random.magnitude(0.999, 1.001) : random.magnitude(1e-4, 1e4)));
  const double size = static_cast<double>(cloud.tolerance) * random.magnitude(0.5, 10);
  fillBox(random, cloud, {-size / 2, -size / 3, 0}, {size, size, size}, someCount(random));
}

// Many returns of a run in one voxel: fragments of more than a word, and parts of whole words.
void denseRuns(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const double side = sideOf(cloud);
  Position corner = anyCorner(random);
  const std::size_t balls = 1 + random.below(5);
  std::uint32_t element = 0;
  for (std::size_t ball = 0; ball < balls; ++ball, ++element) {
    const std::array<std::size_t, 7> counts{63, 64, 65, 127, 128, 129, 1 + random.below(200)};
    fillBox(random, cloud, corner, {side / 9, side / 9, side / 9}, random.oneOf(counts));
    cloud.elements.resize(cloud.points.size(), element);
    corner[random.below(3)] += side * random.between(0, 2.2);
  }
}

void few(Random& random, Cloud& cloud) {
  cloud.tolerance = static_cast<float>(random.magnitude(0.01, 10));
  const double size = 1.5 * static_cast<double>(cloud.tolerance);
  fillBox(random, cloud, anyCorner(random), {size, size, size}, 1 + random.below(4));
}

struct Kind {
  const char* name;
  void (*make)(Random&, Cloud&);
  double sorted;  ///< the least share that is sorted
};
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

/// Sets the tolerance to the distance of some pair, or a little more or less.
void tune(Random& random, Cloud& cloud) {
  const Point& a = random.oneOf(cloud.points);
  const Point& b = random.oneOf(cloud.points);
  const auto apart = [](float p, float q) { return static_cast<double>(p) - static_cast<double>(q); };
  const double distance = std::hypot(apart(a.x, b.x), apart(a.y, b.y), apart(a.z, b.z));
  const auto old = static_cast<double>(cloud.tolerance);
  if (distance > old / 20 && distance < old * 20) cloud.tolerance = nudged(random, static_cast<float>(distance), 2);
}

void cutIntoRuns(Random& random, Cloud& cloud) {
  const std::array<double, 5> chances{0, 0, 0.5, 0.9, 1};
  const double goes_on = random.oneOf(chances);
  const bool neighbours_only = random.chance(0.8);
  for (std::size_t i = cloud.elements.size(); i < cloud.points.size(); ++i) {
    const bool is_same = i > 0 && random.chance(goes_on) &&
                         (!neighbours_only || areNeighbours(cloud.points[i], cloud.points[i - 1], cloud.tolerance));
    cloud.elements.push_back(i == 0 ? 0 : cloud.elements.back() + (is_same ? 0 : 1));
  }
  if (random.chance(0.3))
    for (std::size_t i = 0; i < cloud.points.size() / 4; ++i)
      cloud.merged.emplace_back(random.oneOf(cloud.elements), random.oneOf(cloud.elements));
}

void cutIntoParts(Random& random, Cloud& cloud) {
  const std::size_t parts = random.chance(0.5) ? 1 : 1 + random.below(kMaxParts);
  const bool by_words = random.chance(0.3);
  for (std::size_t i = 1; i < parts; ++i) {
    const std::size_t end = random.below(cloud.points.size() + 1);
    cloud.part_ends.push_back(by_words ? end / 64 * 64 : random.chance(0.2) ? 0 : end);
  }
  cloud.part_ends.push_back(cloud.points.size());
  std::sort(cloud.part_ends.begin(), cloud.part_ends.end());
}

class VoxelSorterClouds : public testing::TestWithParam<Kind> {};

// Two sorters for all, one with threads: what is left in them of one cloud does not matter for the next.
TEST_P(VoxelSorterClouds, AreLinkedAsByBruteForce) {
  lisco::VoxelSorter shared(kShared);
  lisco::VoxelSorter alone;
  std::uint64_t sorted = 0;
  const std::uint64_t count = timesEffort(300);
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Cloud cloud;
    GetParam().make(random, cloud);
    if (random.chance(0.3)) tune(random, cloud);
    cutIntoRuns(random, cloud);
    cutIntoParts(random, cloud);
    const SimdLevel level(levels()[seed % levels().size()]);
    sorted += expectTrueSets(seed % 3 == 0 ? alone : shared, cloud) ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_GE(static_cast<double>(sorted), GetParam().sorted * static_cast<double>(count));
}

INSTANTIATE_TEST_SUITE_P(Kinds, VoxelSorterClouds,
                         testing::Values(Kind{"boxes", boxes, 1}, Kind{"sheets", sheets, 1}, Kind{"lines", lines, 1},
                                         Kind{"far_borders", farBorders, 1}, Kind{"far_pairs", farPairs, 1},
                                         Kind{"borders", borders, 1}, Kind{"duplicates", duplicates, 1},
                                         Kind{"pairs", pairs, 1}, Kind{"map_coordinates", mapCoordinates, 1},
                                         Kind{"slices", slices, 1}, Kind{"far_apart", farApart, 0.5},
                                         Kind{"huge_coordinates", hugeCoordinates, 0.2},
                                         Kind{"ends_of_tolerances", endsOfTolerances, 0.4},
                                         Kind{"dense_runs", denseRuns, 1}, Kind{"few", few, 1}),
                         [](const auto& kind) { return std::string(kind.param.name); });

// --- Cases ----------------------------------------------------------------------------------------------------------

Cloud cloudOf(const std::vector<Point>& points, float tolerance, std::vector<std::size_t> part_ends) {
  Cloud cloud;
  cloud.tolerance = tolerance;
  cloud.points = points;
  cloud.elements.resize(points.size());
  std::iota(cloud.elements.begin(), cloud.elements.end(), 0U);
  cloud.part_ends = std::move(part_ends);
  return cloud;
}

TEST(VoxelSorter, JoinsOnlyBelowTheTolerance) {
  lisco::VoxelSorter sorter(kShared);
  const auto expectForAll = [&](const std::vector<std::size_t>& part_ends) {
    for (const float distance : {0.5F, std::nextafter(0.5F, 0.0F), std::nextafter(0.5F, 1.0F)})
      for (const Point& by : {Point{distance, 0, 0}, Point{0, distance, 0}, Point{0, 0, distance}})
        for (const Point& third : {by, Point{9, 0, 0}, Point{0, -9, 0}, Point{0, 0, 9}})  // decides the major axis
          EXPECT_TRUE(expectTrueSets(sorter, cloudOf({{0, 0, 0}, by, third}, 0.5F, part_ends)));
    // Along a voxel's diagonal, from the corner where numbers begin.
    for (const float side : {0.5F * 0.9999F / static_cast<float>(kSqrt3), 0.5F * 1.0001F / static_cast<float>(kSqrt3)})
      EXPECT_TRUE(expectTrueSets(sorter, cloudOf({{0, 0, 0}, {side, side, side}, {9, 9, 9}}, 0.5F, part_ends)));
  };
  for (const std::string& name : levels()) {
    const SimdLevel level(name);
    expectForAll({3});
  }
  expectForAll({1, 3});
  expectForAll({0, 1, 1, 2, 3});
}

TEST(VoxelSorter, DoesNothingWithoutReturnsOrTolerance) {
  lisco::VoxelSorter sorter(kShared);
  EXPECT_TRUE(expectTrueSets(sorter, cloudOf({}, 0.5F, {})));
  EXPECT_TRUE(expectTrueSets(sorter, cloudOf({}, 0.5F, {0, 0, 0})));
  for (const float tolerance : {0.0F, kNan, 1e-30F})
    EXPECT_TRUE(expectTrueSets(sorter, cloudOf({{1, 1, 1}, {1, 1, 1}}, tolerance, {1, 2})));
}

TEST(VoxelSorter, RefusesWhatCannotBeNumbered) {
  lisco::VoxelSorter sorter(kShared);
  for (const float tolerance : {1e-19F, 1e19F, kInfinity, -kInfinity, 3e38F})
    EXPECT_FALSE(expectTrueSets(sorter, cloudOf({{1, 1, 1}, {1, 1, 1}}, tolerance, {1, 2}))) << tolerance;
  EXPECT_FALSE(expectTrueSets(sorter, cloudOf({{-3e38F, 0, 0}, {3e38F, 0, 0}}, 1.0F, {2})));
  EXPECT_FALSE(expectTrueSets(sorter, cloudOf({{0, 0, 0}, {1e6F, 1e6F, 1e6F}}, 0.1F, {2})));
  EXPECT_TRUE(expectTrueSets(sorter, cloudOf({{0, 0, 0}, {1e6F, 1e6F, 1}}, 0.1F, {2})));
}

// Each pair of voxels at most two apart, at any place of their bricks.
TEST(VoxelSorter, LinksAllVoxelsAround) {
  lisco::VoxelSorter sorter(kShared);
  const float tolerance = 1.0F;
  const double side = sideOf(cloudOf({}, tolerance, {}));
  const auto at = [&](std::size_t number, double within) {
    return static_cast<float>((static_cast<double>(number) + within) * side);
  };
  for (std::size_t voxel = 0; voxel < 64; ++voxel)
    for (std::size_t by = 0; by < 125; ++by) {
      const std::size_t x = 4 + (voxel & 3U), y = 4 + (voxel >> 2U & 3U), z = 4 + (voxel >> 4U);
      const std::size_t dx = by % 5, dy = by / 5 % 5, dz = by / 25;  // and 2 less
      // The nearest corners of the two voxels, nearly; two more returns span the box.
      const auto towards = [](std::size_t d) { return d < 2 ? 0.01 : 0.99; };
      const Point one{at(x, towards(dx)), at(y, towards(dy)), at(z, towards(dz))};
      const Point other{at(x + dx - 2, 1 - towards(dx)), at(y + dy - 2, 1 - towards(dy)),
                        at(z + dz - 2, 1 - towards(dz))};
      const float near = at(11, 0.5);
      const float far = at(20, 0.5);
      const std::array<Point, 3> ends{{{near, near, far}, {near, far, near}, {far, near, near}}};
      const Cloud cloud =
          cloudOf({{0, 0, 0}, one, other, ends[voxel % 3]}, tolerance, {voxel % 8 == 7 ? by % 5 : 0, 4});
      EXPECT_TRUE(expectTrueSets(sorter, cloud)) << "voxel " << voxel << ", by " << by;
      if (HasFailure()) return;
    }
}

// A chain along the major axis, across all slabs.
TEST(VoxelSorter, LinksSlabsWithEachOther) {
  lisco::VoxelSorter sorter(kShared);
  for (std::size_t parts = 1; parts <= kMaxParts; ++parts)
    for (const double step : {0.3, 0.9, 0.999, 1.001}) {
      std::vector<Point> points;
      std::vector<std::size_t> part_ends;
      for (std::size_t i = 0; i < 400; ++i) points.push_back({0, static_cast<float>(step * static_cast<double>(i)), 1});
      Random random(parts);
      random.shuffle(points);
      for (std::size_t part = 1; part <= parts; ++part) part_ends.push_back(400 * part / parts);
      EXPECT_TRUE(expectTrueSets(sorter, cloudOf(points, 1.0F, part_ends)));
    }
}

// Lines across the parts of threads, which lie side by side along the shorter side, in their order or reversed.
TEST(VoxelSorter, LinksPartsThatLieSideBySide) {
  lisco::VoxelSorter sorter(kShared);
  for (std::size_t parts = 2; parts <= 4; ++parts)
    for (const float sign : {1.0F, -1.0F}) {
      Random random(parts);
      std::vector<Point> points;
      const double length = 40 * static_cast<double>(parts);
      const double width = 25 * static_cast<double>(parts);
      for (std::size_t line = 0; line < 12; ++line) {
        const double x = line == 0 ? 0 : line == 1 ? length : random.between(0, length);
        for (double y = 0; y < width; y += random.between(0.9, 1.01))
          points.push_back({static_cast<float>(x), sign * static_cast<float>(y), 1});
      }
      std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return sign * a.y < sign * b.y; });
      std::vector<std::size_t> part_ends;
      for (std::size_t part = 1; part <= parts; ++part) part_ends.push_back(points.size() * part / parts);
      EXPECT_TRUE(expectTrueSets(sorter, cloudOf(points, 1.0F, part_ends)));
    }
}

// Neighbours of random sets in all slabs: threads join the same sets at the same time.
TEST(VoxelSorter, LosesNoJoinOfAnotherThread) {
  constexpr std::size_t kSets = 4000;
  lisco::VoxelSorter sorter(kShared);
  lisco::DisjointSets right;
  lisco::DisjointSets subclusters;
  for (std::uint64_t seed = 1; seed <= timesEffort(100); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    for (lisco::DisjointSets* sets : {&right, &subclusters}) {
      sets->reserve(kSets);
      for (std::uint32_t i = 0; i < kSets; ++i) sets->create(i);
    }
    const std::size_t count = 2 + seed % 3;
    std::vector<lisco::NearReturns> parts(count);
    for (std::size_t pair = 0; pair < kSets; ++pair) {
      lisco::NearReturns& part = parts[pair % count];
      part.returns.grow(part.count + 2 + lisco::kReadBehind);
      const auto a = static_cast<std::uint32_t>(random.below(kSets));
      const auto b = static_cast<std::uint32_t>(random.below(kSets));
      part.returns[part.count++] = {0, 3 * static_cast<float>(pair), 0, a};
      part.returns[part.count++] = {0.9F, 3 * static_cast<float>(pair), 0, b};
      right.merge(a, b);
    }
    std::vector<const lisco::NearReturns*> pointers;
    for (const lisco::NearReturns& part : parts) pointers.push_back(&part);
    ASSERT_TRUE(sorter.link(pointers, lisco::Tolerance(1), subclusters));
    for (std::uint32_t i = 0; i < kSets; ++i) ASSERT_EQ(subclusters.find(i), right.find(i)) << "element " << i;
  }
}

}  // namespace
}  // namespace lisco_test
