// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "engine.h"
#include "lisco/strided_points.h"

namespace lisco_test {
namespace {

using lisco::StridedPoints;

float valueOf(std::size_t point, std::size_t axis) {
  return static_cast<float>(100 * point + axis);
}

/// Points in memory that ends with the last one's last coordinate, so that reading behind it is found.
class PointsInMemory {
 public:
  PointsInMemory(std::size_t count, std::ptrdiff_t stride, const std::vector<std::size_t>& offsets) {
    const auto step = static_cast<std::size_t>(std::abs(stride));
    const std::size_t size = (count - 1) * step + *std::max_element(offsets.begin(), offsets.end()) + sizeof(float);
    bytes_.assign(size, 0xFF);
    bytes_.shrink_to_fit();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float value = valueOf(i, axis);
        std::memcpy(&bytes_[(stride < 0 ? count - 1 - i : i) * step + offsets[axis]], &value, sizeof value);
      }
    const unsigned char* const first = bytes_.data() + (stride < 0 ? (count - 1) * step : 0);
    points = {first + offsets[0], first + offsets[1], first + offsets[2], stride};
  }
  StridedPoints points;

 private:
  std::vector<unsigned char> bytes_;
};

void expectAllAreRead(std::size_t count, std::ptrdiff_t stride, const std::vector<std::size_t>& offsets) {
  SCOPED_TRACE(std::to_string(count) + " points, stride " + std::to_string(stride));
  const PointsInMemory memory(count, stride, offsets);
  for (const std::size_t first : {std::size_t{0}, count / 3, count - 1}) {
    const std::size_t read = count - first;
    constexpr float kUntouched = -1.0F;
    std::vector<float> x(read + 1, kUntouched), y(x), z(x);
    memory.points.read(first, read, {x.data(), y.data(), z.data(), nullptr});
    for (std::size_t i = 0; i < read; ++i) {
      ASSERT_EQ(x[i], valueOf(first + i, 0)) << i;
      ASSERT_EQ(y[i], valueOf(first + i, 1)) << i;
      ASSERT_EQ(z[i], valueOf(first + i, 2)) << i;
      ASSERT_EQ(memory.points.at(first + i).z, valueOf(first + i, 2)) << i;
    }
    EXPECT_EQ(x[read], kUntouched);
    EXPECT_EQ(y[read], kUntouched);
    EXPECT_EQ(z[read], kUntouched);
  }
}

TEST(StridedPoints, AreReadAtAnyStride) {
  for (const std::string& name : levels()) {
    const SimdLevel level(name);
    for (std::size_t count = 1; count <= 70; ++count)
      for (const std::ptrdiff_t stride : {12, 13, 16, 20, 32, 48, -12, -16, -33})
        expectAllAreRead(count, stride, {0, 4, 8});
  }
}

TEST(StridedPoints, AreReadWhereverTheirCoordinatesAre) {
  for (const std::size_t count : {1U, 4U, 5U, 64U}) {
    expectAllAreRead(count, 16, {4, 8, 12});
    expectAllAreRead(count, 17, {1, 5, 9});
    expectAllAreRead(count, 16, {0, 8, 4});
    expectAllAreRead(count, 24, {0, 8, 16});
    expectAllAreRead(count, 24, {0, 4, 16});
    expectAllAreRead(count, -24, {16, 4, 8});
  }
}

TEST(StridedPoints, MayBeOneOrNone) {
  const float xyz[3] = {1.0F, 2.0F, 3.0F};
  std::vector<float> x(9), y(9), z(9);
  StridedPoints::sideBySide(xyz, 0).read(5, 9, {x.data(), y.data(), z.data(), nullptr});
  EXPECT_EQ(x, std::vector<float>(9, 1.0F));
  EXPECT_EQ(y, std::vector<float>(9, 2.0F));
  EXPECT_EQ(z, std::vector<float>(9, 3.0F));
  const StridedPoints none = StridedPoints::sideBySide(nullptr, 12);
  none.read(0, 0, {nullptr, nullptr, nullptr, nullptr});
  EXPECT_EQ(none.x, nullptr);
}

}  // namespace
}  // namespace lisco_test
