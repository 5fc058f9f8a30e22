// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/merge_sorted.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "random.h"

namespace lisco_test {
namespace {

using Items = std::vector<std::uint64_t>;

Items randomItems(Random& random, std::size_t count, std::uint64_t first, std::uint64_t values) {
  Items items(count);
  for (std::uint64_t& item : items) item = first + random.below(values);
  std::sort(items.begin(), items.end());
  return items;
}

void expectMerged(const Items& a, const Items& b) {
  Items expected(a.size() + b.size());
  std::merge(a.begin(), a.end(), b.begin(), b.end(), expected.begin());
  constexpr std::uint64_t kBehind = 0x123456789;
  Items merged(expected.size() + 1, kBehind);
  lisco::mergeSorted({a.data(), a.size()}, {b.data(), b.size()}, merged.data());
  EXPECT_EQ(merged.back(), kBehind);
  merged.pop_back();
  EXPECT_EQ(merged, expected) << a.size() << " and " << b.size() << " items";
}

TEST(MergeSorted, MergesAsTheStandardLibrary) {
  Random random(1);
  for (int round = 0; round < 2000; ++round) {
    const std::size_t most = random.chance(0.5) ? 4 : 300;
    const std::uint64_t values = random.chance(0.3) ? 3 : std::uint64_t{1} << 40;
    const std::uint64_t offset = random.chance(0.2) ? values / 2 : 0;
    expectMerged(randomItems(random, random.below(most), 0, values),
                 randomItems(random, random.below(most), offset, values));
  }
}

TEST(MergeSorted, PutsOneBehindTheOther) {
  Random random(2);
  const Items low = randomItems(random, 50, 0, 1000);
  const Items high = randomItems(random, 20, 1000, 1000);
  expectMerged(low, high);
  expectMerged(high, low);
}

}  // namespace
}  // namespace lisco_test
