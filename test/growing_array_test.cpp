// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/growing_array.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
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
    const std::size_t most = size + std::max(size / 8, std::min(size, std::size_t{1024})) + 256;
    ASSERT_LE(array.size(), most + (size > 400'000 ? kQuarterOfAHugePage : 0));
    if (array.size() == before) continue;
    ++growths;
    fill(array, before);
    expectFilled(array, size);
    lisco::reserveInSteps(vector, size);
    ASSERT_GE(vector.capacity(), size);
    ASSERT_LE(vector.capacity(), most);
  }
  EXPECT_LT(growths, 80);
}

std::size_t pageSize() {
  return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// The pages of some memory that the system has not provided yet.
std::size_t missingPages(const void* begin, const void* end) {
  const auto first = reinterpret_cast<std::uintptr_t>(begin) / pageSize() * pageSize();
  std::vector<unsigned char> is_there((reinterpret_cast<std::uintptr_t>(end) - first + pageSize() - 1) / pageSize());
  EXPECT_EQ(mincore(reinterpret_cast<void*>(first), is_there.size() * pageSize(), is_there.data()), 0);
  return static_cast<std::size_t>(
      std::count_if(is_there.begin(), is_there.end(), [](unsigned char page) { return (page & 1) == 0; }));
}

/// Whether the system provides pages in one call: it does from Linux 5.14 on.
bool populates() {
  constexpr int kPopulateWrite = 23;
  void* const page = mmap(nullptr, pageSize(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  const bool does = madvise(page, pageSize(), kPopulateWrite) == 0;
  munmap(page, pageSize());
  return does;
}

TEST(GrowingArray, GrowsByPagesThatAreThere) {
  if (!populates()) GTEST_SKIP() << "the system provides no pages before they are written";
  for (const std::size_t size : {10'000U, 100'000U, 700'000U}) {
    malloc_trim(0);  // what has been given back has no pages
    Array array;
    for (const std::size_t grown : {size, 2 * size}) {
      array.grow(grown);
      EXPECT_EQ(missingPages(array.data(), array.data() + array.size()), 0U);
    }
  }
#ifndef __SANITIZE_ADDRESS__  // whose realloc () copies
  Array untouched;
  untouched.grow(50'000'000, lisco::NewPages::kUntouched);  // more than other tests have given back
  EXPECT_GT(missingPages(untouched.data(), untouched.data() + untouched.size()), 160'000'000U / pageSize());
#endif
}

TEST(GrowingArray, TakesNoMoreThanItHolds) {
  mallopt(M_MMAP_THRESHOLD, 1 << 17);  // mappings of their own, which alignment enlarges
  for (const std::size_t size : {100'000U, 600'000U, 1'300'000U}) {
    Array array;
    array.grow(size);
    EXPECT_LE(malloc_usable_size(array.data()), array.size() * sizeof(std::uint32_t) + pageSize());
  }
}

TEST(GrowingArray, GivesBackWhatIsBehindASize) {
  for (const std::size_t size : {100U, 200'000U, 700'000U, 2'000'000U}) {
    Array array;
    array.grow(size);
    fill(array, 0);
    array.shrink(array.size());
    array.shrink(0);
    EXPECT_GE(array.size(), size);
    array.shrink(size / 3);
    EXPECT_EQ(array.size(), size / 3);
    EXPECT_LE(malloc_usable_size(array.data()), array.size() * sizeof(std::uint32_t) + 4096);
    expectFilled(array, size / 3);
    array.grow(size);
    expectFilled(array, size / 3);
    EXPECT_GE(array.size(), size);
  }
  Array empty;
  empty.shrink(5);
  EXPECT_EQ(empty.size(), 0U);
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

using lisco::ImageCells;

/// Adds rows with memory, whose bins get values of their own.
void addRows(ImageCells& cells, std::size_t bins, std::size_t count) {
  const std::size_t before = cells.rowCount();
  cells.addRows(count);
  for (std::size_t row = before; row < cells.rowCount(); ++row) {
    EXPECT_FALSE(cells.hasMemory(row));
    cells.giveMemory(row, cells.rowCount() - row);
    const lisco::WritableRowBins to = cells.at(row, 0);
    for (std::size_t bin = 0; bin < bins; ++bin) {
      to.x()[bin] = static_cast<float>(10 * row + bin);
      to.y()[bin] = to.x()[bin] + 0.25F;
      to.z()[bin] = to.x()[bin] + 0.5F;
      to.element()[bin] = static_cast<std::uint32_t>(to.x()[bin]);
    }
  }
}

/// Checks that rows have the values of addRows ().
/// \param in_every these have memory: every so many rows, from the first on
void expectRows(const ImageCells& cells, std::size_t bins, std::size_t in_every = 1) {
  for (std::size_t row = 0; row < cells.rowCount(); ++row) {
    ASSERT_EQ(cells.hasMemory(row), row % in_every == 0);
    if (row % in_every != 0) continue;
    for (std::size_t bin = 0; bin < bins; ++bin) {
      const lisco::RowBins from = cells.at(row, bin);
      const auto x = static_cast<float>(10 * (row / in_every) + bin);
      ASSERT_EQ(*from.x(), x);
      ASSERT_EQ(*from.y(), x + 0.25F);
      ASSERT_EQ(*from.z(), x + 0.5F);
      ASSERT_EQ(*from.element(), static_cast<std::uint32_t>(x));
      ASSERT_EQ(from.from(-static_cast<std::ptrdiff_t>(bin)).z(), cells.at(row, 0).z());
    }
  }
}

TEST(ImageCells, KeepsRowsInPlaceWhileOthersAreAdded) {
  constexpr std::size_t kBins = 9;
  ImageCells cells;
  cells.clear(kBins);
  addRows(cells, kBins, 3);
  const float* const first = cells.at(0, 0).x();
  for (const std::size_t count : {1U, 5U, 50'000U}) addRows(cells, kBins, count);
  EXPECT_EQ(cells.at(0, 0).x(), first);
  EXPECT_EQ(cells.rowsWithMemory(), 50'009U);
  expectRows(cells, kBins);
  ImageCells copy(cells);
  ImageCells assigned;
  assigned = cells;
  cells.at(1, 0).x()[0] = -1.0F;
  for (const ImageCells* some : {&copy, &assigned}) expectRows(*some, kBins);
  cells = std::move(copy);
  expectRows(cells, kBins);
}

TEST(ImageCells, PopulatesRows) {
  if (!populates()) GTEST_SKIP() << "the system provides no pages before they are written";
  malloc_trim(0);  // what has been given back has no pages
  constexpr std::size_t kBins = 5000;
  ImageCells cells;
  cells.clear(kBins);
  cells.addRows(12);
  for (std::size_t row = 0; row < 12; ++row) cells.giveMemory(row, row < 4 ? 4 - row : 12 - row);  // in two chunks
  for (const std::size_t row : {0U, 1U, 3U, 2U, 4U, 11U}) {
    cells.populate(row);
    if (row == 2) continue;  // after one behind it: left to its first writes
    const float* const begin = cells.at(row, 0).x();
    EXPECT_EQ(missingPages(begin, begin + 4 * kBins), 0U) << row;
  }
  addRows(cells, kBins, 1);
  cells.populate(12);
  EXPECT_EQ(cells.at(12, 7).x()[0], 127.0F);
}

TEST(ImageCells, NumbersRowsAnewForAnotherLayer) {
  ImageCells cells;
  cells.clear(8);
  addRows(cells, 8, 5);
  cells.addLayer(1);
  EXPECT_EQ(cells.rowCount(), 10U);
  expectRows(cells, 8, 2);
  cells.addLayer(2);
  EXPECT_EQ(cells.rowCount(), 15U);
  expectRows(cells, 8, 3);
  EXPECT_EQ(cells.rowsWithMemory(), 5U);
}

TEST(ImageCells, UsesItsMemoryAgain) {
  ImageCells cells;
  std::size_t bytes = 0;
  for (const std::size_t bins : {20U, 20U, 19U, 10U, 20U}) {
    cells.clear(bins);
    addRows(cells, 10, 4);
    addRows(cells, 10, 4);
    expectRows(cells, 10);
    if (bytes == 0) bytes = cells.bytes();
    EXPECT_EQ(cells.bytes(), bytes);
  }
}

// Few times the memory of the largest rotation, whatever comes before.
TEST(ImageCells, TakesLittleMoreThanTheLargestImage) {
  ImageCells cells;
  for (std::size_t bins = 100; bins < 300; ++bins)
    for (const std::size_t rows : {1U, 8U}) {
      cells.clear(bins);
      addRows(cells, 10, rows);
      if (bins % 3 == 0) cells.widenRows(bins + 50, 10);
      expectRows(cells, 10);
      EXPECT_LE(cells.bytes(), 3 * 8 * (bins + 50) * 16) << bins;
      cells.clear(bins);
      EXPECT_GE(cells.capacityFor(bins), rows);
    }
}

TEST(ImageCells, WidensRowsOfAllChunks) {
  ImageCells cells;
  cells.clear(10);
  for (const std::size_t count : {3U, 4U}) addRows(cells, 10, count);
  cells.widenRows(25, 8);
  expectRows(cells, 8);
  for (std::size_t row = 0; row < cells.rowCount(); ++row)
    for (std::size_t bin = 8; bin < 25; ++bin) EXPECT_TRUE(std::isnan(cells.at(row, bin).x()[0])) << bin;
  addRows(cells, 25, 1);
  expectRows(cells, 8);
  for (std::size_t row = 0; row < cells.rowCount(); ++row) EXPECT_EQ(cells.at(row, 0).y(), cells.at(row, 0).x() + 25);
}

TEST(ImageCells, ShrinksToRowsOfFewerBins) {
  ImageCells cells;
  cells.clear(1000);
  for (const std::size_t count : {3U, 4U}) addRows(cells, 10, count);
  cells.shrinkTo(100);
  EXPECT_EQ(cells.rowCount(), 0U);
  EXPECT_EQ(cells.bytes(), 7U * 100 * 16);
  for (const std::size_t count : {3U, 4U}) addRows(cells, 10, count);
  expectRows(cells, 10);
  EXPECT_EQ(cells.bytes(), 7U * 100 * 16);
}

TEST(ImageCells, ExchangesTheMemoryOfItsFirstRows) {
  ImageCells cells;
  lisco::GrowingArray<std::uint64_t> words;
  words.grow(1000);
  const void* const memory = words.data();
  cells.exchangeMemory(words);
  EXPECT_EQ(words.size(), 0U);
  EXPECT_EQ(cells.exchangedBytes(), 8000U);
  cells.clear(10);
  addRows(cells, 10, 50);
  EXPECT_EQ(cells.at(0, 0).x(), memory);
  EXPECT_EQ(cells.bytes(), 8000U);
}

}  // namespace
}  // namespace lisco_test
