// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace lisco_test {
namespace {

struct Bits {
  unsigned low, count;
};

std::vector<std::uint64_t> sortedStably(std::vector<std::uint64_t> items, const Bits& bits) {
  const auto key = [&](std::uint64_t item) { return item >> bits.low & ~std::uint64_t{0} >> (64 - bits.count); };
  std::stable_sort(items.begin(), items.end(), [&](std::uint64_t a, std::uint64_t b) { return key(a) < key(b); });
  return items;
}

TEST(RadixSort, SortsByTheBitsGivenAndKeepsTheOrderOfEqualOnes) {
  std::mt19937_64 random(5);
  for (const Bits bits : {Bits{0, 64}, {0, 1}, {31, 6}, {32, 21}, {53, 11}, {63, 1}, {20, 23}, {7, 34}})
    for (const std::size_t count : {1U, 2U, 3U, 100U, 5001U})
      for (const std::uint64_t used : {~std::uint64_t{0}, std::uint64_t{0x0F0F0F0F0F0F0F0F}, std::uint64_t{0}}) {
        std::vector<std::uint64_t> items(count), scratch(count);
        for (std::uint64_t& item : items) item = random() & used;
        const std::vector<std::uint64_t> expected = sortedStably(items, bits);
        lisco::radixSort(items.data(), scratch.data(), count, bits.low, bits.count);
        EXPECT_EQ(items, expected) << count << " items by " << bits.count << " bits from " << bits.low << " on";
      }
}

TEST(RadixSort, LeavesNoItemsAndNoBitsAsTheyAre) {
  std::vector<std::uint64_t> items{3, 1, 2}, scratch(3);
  const std::vector<std::uint64_t> expected = items;
  lisco::radixSort(items.data(), scratch.data(), 3, 5, 0);
  EXPECT_EQ(items, expected);
  lisco::radixSort(nullptr, nullptr, 0, 0, 64);
}

}  // namespace
}  // namespace lisco_test
