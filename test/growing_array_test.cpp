// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/growing_array.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <numeric>
#include <utility>
#include <vector>

#include "core/far/image_cells.h"

namespace lisco_test {
namespace {

using Array = lisco::GrowingArray<std::uint32_t>;

void fill(Array& array, std::size_t from) {
  std::iota(array.data() + from, array.data() + array.size(), static_cast<std::uint32_t>(from));
}

void expectFilled(const Array& array, std::size_t count) {
  ASSERT_GE(array.size(), count);
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(array[i], i);
}

TEST(GrowingArray, KeepsItsElementsWhenItGrows) {
  Array array;
  EXPECT_EQ(array.size(), 0U);
  for (const std::size_t size : {1U, 100U, 100'000U, 600'000U, 700'000U, 2'000'000U}) {  // the last ones in huge pages
    const std::size_t before = array.size();
    array.grow(size);
    fill(array, before);
    expectFilled(array, size);
    array.grow(size / 2);
    EXPECT_GE(array.size(), size);
  }
}

// Few times, and with little to spare.
TEST(GrowingArray, GrowsInSteps) {
  Array array;
  std::vector<std::uint32_t> vector;
  int growths = 0;
  constexpr std::size_t kQuarterOfAHugePage = (std::size_t{1} << 19) / sizeof(std::uint32_t);
  for (std::size_t size = 1; size <= 2'000'000; ++size) {
    const std::size_t before = array.size();
    array.growInSteps(size);
    ASSERT_GE(array.size(), size);
    ASSERT_LE(array.size(), size + size / 8 + 256 + (size > 400'000 ? kQuarterOfAHugePage : 0));
    if (array.size() == before) continue;
    ++growths;
    fill(array, before);
    expectFilled(array, size);
    lisco::reserveInSteps(vector, size);
    ASSERT_GE(vector.capacity(), size);
    ASSERT_LE(vector.capacity(), size + size / 8 + 256);
  }
  EXPECT_LT(growths, 80);
}

TEST(GrowingArray, TakesNoMoreThanItHolds) {
  mallopt(M_MMAP_THRESHOLD, 1 << 17);  // mappings of their own, which alignment enlarges
  for (const std::size_t size : {100'000U, 600'000U, 1'300'000U}) {
    Array array;
    array.grow(size);
    constexpr std::size_t kPage = 4096;
    EXPECT_LE(malloc_usable_size(array.data()), array.size() * sizeof(std::uint32_t) + kPage);
  }
}

TEST(GrowingArray, Copies) {
  for (const std::size_t size : {0U, 7U, 600'000U}) {
    Array array;
    array.grow(size);
    fill(array, 0);
    Array copy(array);
    expectFilled(copy, size);
    if (size > 0) copy[0] = 1;
    expectFilled(array, size);
    copy = array;
    expectFilled(copy, size);
    const Array& same = copy;
    copy = same;
    expectFilled(copy, size);
    const Array moved(std::move(copy));
    expectFilled(moved, size);
  }
}

TEST(GrowingArray, RefusesMoreThanThereIs) {
  Array array;
  array.grow(5);
  fill(array, 0);
  EXPECT_THROW(array.grow(~std::size_t{0} / 4), std::bad_alloc);
  EXPECT_THROW(array.grow(~std::size_t{0}), std::bad_alloc);
  expectFilled(array, 5);
}

TEST(GrowingArray, ExchangesMemoryWithOtherElements) {
  struct Pair {
    std::uint64_t first, second;
  };
  for (const std::size_t size : {std::size_t{0}, std::size_t{9}, std::size_t{1'000'000}}) {
    lisco::GrowingArray<Pair> pairs;
    lisco::GrowingArray<std::uint32_t> words;
    pairs.grow(size);
    words.grow(7);
    const void* const memory = pairs.data();
    const std::size_t pair_count = pairs.size();
    words.exchangeMemory(pairs);
    EXPECT_EQ(words.data(), memory);
    EXPECT_EQ(words.size(), 4 * pair_count);
    EXPECT_EQ(pairs.size(), 1U);
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = 0;  // all is there: AddressSanitizer
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {0, 0};
    pairs.exchangeMemory(words);
    EXPECT_EQ(pairs.data(), memory);
    EXPECT_EQ(pairs.size(), pair_count);
    EXPECT_EQ(words.size(), 4U);
  }
}

TEST(ImageCells, HaveFourPlanesInEachRow) {
  lisco::ImageCells cells;
  cells.setRowSize(10);
  cells.reserveRows(3);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t i = cells.firstOf(row); i < cells.firstOf(row) + 10; ++i) {
      cells.x[i] = static_cast<float>(i);
      cells.y[i] = static_cast<float>(i) + 0.25F;
      cells.z[i] = static_cast<float>(i) + 0.5F;
      cells.element[i] = static_cast<std::uint32_t>(i);
    }
  lisco::ImageCells copy(cells);
  cells.reserveRows(50'000);
  for (const lisco::ImageCells* some : {&cells, &copy})
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t i = some->firstOf(row); i < some->firstOf(row) + 10; ++i) {
        ASSERT_EQ(some->x[i], static_cast<float>(i));
        ASSERT_EQ(some->y[i], static_cast<float>(i) + 0.25F);
        ASSERT_EQ(some->z[i], static_cast<float>(i) + 0.5F);
        ASSERT_EQ(some->element[i], i);
      }
}

}  // namespace
}  // namespace lisco_test
