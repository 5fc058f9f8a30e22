// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The measurements of a ring block at every level of vector instructions, against the same cell by cell.
#include "core/ring_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/far/range_image.h"
#include "core/neighbour.h"
#include "engine.h"
#include "lisco/return.h"
#include "lisco/simd.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kMargin = lisco::RingBlock::kMargin;

/// What lisco::measure() finds, without vectors. Elements beyond the columns are no returns.
lisco::RingBlockInfo measuredCellByCell(const lisco::RingBlock& block, std::size_t columns, float squared_tolerance,
                                        const lisco::FarRange& range) {
  lisco::RingBlockInfo measured{};
  measured.lowest = kInfinity;
  measured.highest = -kInfinity;
  for (std::size_t i = 0; i < columns; ++i) {
    const float x = block.x[kMargin + i];
    const float y = block.y[kMargin + i];
    const float z = block.z[kMargin + i];
    if (!lisco::isReturn(x, y, z)) continue;
    const std::uint64_t bit = std::uint64_t{1} << i;
    const bool follows = (measured.returns & bit >> 1) != 0;
    measured.returns |= bit;
    const std::size_t before = kMargin + i - 1;
    if (i == 0 || !follows ||
        !(lisco::squaredDistance(x - block.x[before], y - block.y[before], z - block.z[before]) < squared_tolerance))
      measured.starts |= bit;
    const float east = x - range.origin[0];
    const float north = y - range.origin[1];
    const float rho = std::sqrt(east * east + north * north);
    measured.rho[i] = rho;
    if (rho >= range.interior_min && rho < range.interior_max) measured.interior |= bit;
    if (!(rho >= range.min_range && rho < range.max_range)) continue;
    measured.far |= bit;
    const float slope = (z - range.origin[2]) / rho;
    measured.lowest = std::min(measured.lowest, slope);
    measured.highest = std::max(measured.highest, slope);
  }
  return measured;
}

/// Measures the block at every level of vector instructions.
void expectMeasured(const lisco::RingBlock& block, std::size_t columns, float squared_tolerance,
                    const lisco::FarRange& range) {
  const lisco::RingBlockInfo right = measuredCellByCell(block, columns, squared_tolerance, range);
  for (const std::string& name : levels()) {
    const SimdLevel level(name);
    SCOPED_TRACE(name);
    ASSERT_EQ(lisco::findReturns(block, columns), right.returns);
    lisco::RingBlockInfo found;
    lisco::findRuns(block, columns, squared_tolerance, found);
    ASSERT_EQ(found.returns, right.returns);
    ASSERT_EQ(found.starts, right.starts);
    ASSERT_EQ(found.far | found.interior, 0U);
    lisco::RingBlockInfo measured;
    std::fill_n(measured.run, lisco::RingBlock::kColumns, 77U);
    lisco::measure(block, columns, squared_tolerance, range, measured);
    ASSERT_EQ(measured.returns, right.returns);
    ASSERT_EQ(measured.starts, right.starts);
    ASSERT_EQ(measured.far, right.far);
    ASSERT_EQ(measured.interior & right.far, right.interior & right.far);
    ASSERT_EQ(measured.lowest, right.lowest);
    ASSERT_EQ(measured.highest, right.highest);
    for (std::size_t i = 0; i < lisco::RingBlock::kColumns; ++i) {
      ASSERT_EQ(measured.run[i], 77U) << "runs are set by Runs::add";
      if ((right.returns >> i & 1U) == 0) continue;
      ASSERT_EQ(measured.rho[i], right.rho[i]) << i;
    }
  }
}

float oddNumber(Random& random) {
  const std::array<float, 14> numbers{
      0.0F,   -0.0F,  kNan,  kInfinity, -kInfinity, 1e-45F, -1e-45F,
      1e-38F, 1e-20F, 1e15F, -3e15F,    1e19F,      -1e30F, std::numeric_limits<float>::max()};
  return random.oneOf(numbers);
}

lisco::RingBlock randomBlock(Random& random) {
  lisco::RingBlock block;
  const std::array<double, 4> sizes{1.0, 30.0, 1e-15, 1e10};
  const double size = random.oneOf(sizes);
  const double step = size * random.magnitude(1e-4, 1.0);
  const double odd = random.chance(0.5) ? 0.0 : random.unit();
  const double lost = random.chance(0.5) ? 0.0 : random.unit();
  std::array<double, 3> at{random.between(-size, size), random.between(-size, size), random.between(-size, size)};
  // The margin and the elements beyond the columns hold anything.
  for (std::size_t i = 0; i < kMargin + lisco::RingBlock::kColumns; ++i) {
    for (double& axis : at) axis += random.between(-step, step);
    block.x[i] = static_cast<float>(at[0]);
    block.y[i] = static_cast<float>(at[1]);
    block.z[i] = static_cast<float>(at[2]);
    for (float* axis : {&block.x[i], &block.y[i], &block.z[i]})
      if (random.chance(odd * 0.5)) *axis = oddNumber(random);
    if (random.chance(lost)) block.x[i] = block.y[i] = block.z[i] = random.chance(0.5) ? 0.0F : kNan;
    if (i > 0 && random.chance(0.05)) {
      block.x[i] = block.x[i - 1];
      block.y[i] = block.y[i - 1];
      block.z[i] = block.z[i - 1];
    }
  }
  return block;
}

/// A tolerance at or just above the distance of two adjacent returns.
float criticalSquare(Random& random, const lisco::RingBlock& block) {
  const std::size_t i = kMargin + 1 + random.below(lisco::RingBlock::kColumns - 1);
  const float d2 =
      lisco::squaredDistance(block.x[i] - block.x[i - 1], block.y[i] - block.y[i - 1], block.z[i] - block.z[i - 1]);
  return random.chance(0.5) ? d2 : std::nextafter(d2, kInfinity);
}

TEST(RingBlock, IsMeasuredEquallyAtEveryLevel) {
  for (std::uint64_t seed = 1; seed < 6000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const lisco::RingBlock block = randomBlock(random);
    lisco::FarRange range;
    if (random.chance(0.4))
      for (float& axis : range.origin) axis = static_cast<float>(random.between(-20.0, 20.0));
    // Limits that equal some return's distance.
    const auto distance = [&] {
      const std::size_t i = kMargin + random.below(lisco::RingBlock::kColumns);
      const float east = block.x[i] - range.origin[0];
      const float north = block.y[i] - range.origin[1];
      return std::sqrt(east * east + north * north);
    };
    range.min_range = distance();
    range.max_range = random.chance(0.5) ? 1e15F : distance();
    range.interior_min = random.chance(0.5) ? 1.1F * range.min_range : distance();
    range.interior_max = random.chance(0.5) ? 0.9F * range.max_range : distance();
    expectMeasured(block, 1 + random.below(lisco::RingBlock::kColumns), criticalSquare(random, block), range);
    if (HasFailure()) return;
  }
}

TEST(RingBlock, HasAnyNumberOfColumns) {
  Random random(1);
  lisco::FarRange range;
  range.min_range = 0.5F;
  range.interior_min = 0.6F;
  range.max_range = range.interior_max = 1e15F;
  for (std::size_t columns = 0; columns <= lisco::RingBlock::kColumns; ++columns)
    for (int time = 0; time < 20; ++time) {
      SCOPED_TRACE(columns);
      const lisco::RingBlock block = randomBlock(random);
      expectMeasured(block, columns, criticalSquare(random, block), range);
      if (HasFailure()) return;
    }
}

TEST(RingBlock, SeparatesEqualReturnsIfTheToleranceJoinsNothing) {
  lisco::RingBlock block{};
  for (std::size_t i = 0; i < kMargin + lisco::RingBlock::kColumns; ++i) block.x[i] = 1.0F;
  for (const float squared : {0.0F, kNan, 1e-45F, kInfinity})
    expectMeasured(block, lisco::RingBlock::kColumns, squared, lisco::FarRange());
}

// With the ranges that the range image sets.
TEST(RingBlock, HasNoFarReturnsWithoutARangeImage) {
  Random random(2);
  lisco::RangeImage image;
  image.prepare(lisco::Tolerance(1.0F), lisco::SensorHints(), ~std::size_t{0});
  for (int time = 0; time < 100; ++time) {
    const lisco::RingBlock block = randomBlock(random);
    expectMeasured(block, lisco::RingBlock::kColumns, 1.0F, image.range);
    EXPECT_EQ(measuredCellByCell(block, lisco::RingBlock::kColumns, 1.0F, image.range).far, 0U);
  }
}

TEST(Simd, LevelsCanBeChosen) {
  ASSERT_FALSE(levels().empty());
  EXPECT_EQ(lisco::simdLevel(), levels().front()) << "the best is in use";
  for (const std::string& level : levels()) {
    EXPECT_TRUE(lisco::useSimdLevel(level));
    EXPECT_EQ(lisco::simdLevel(), level);
    EXPECT_EQ(lisco::simdLevels(), levels());
  }
  EXPECT_FALSE(lisco::useSimdLevel("no such level"));
  EXPECT_EQ(lisco::simdLevel(), levels().back());
  EXPECT_TRUE(lisco::useSimdLevel({}));
  EXPECT_EQ(lisco::simdLevel(), levels().front());
}

}  // namespace
}  // namespace lisco_test
