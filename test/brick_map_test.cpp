// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Bricks of a plane, found by their keys.
#include "core/near/brick_map.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include "engine.h"
#include "random.h"

namespace lisco_test {
namespace {

template <bool kInOrder>
void expectKeys(const lisco::BrickMap& map, const std::set<std::uint64_t>& keys, std::uint64_t end) {
  const auto expectNear = [&](std::uint64_t key) {
    std::uint32_t near = 0;
    for (std::uint32_t i = 0; i < 3; ++i) near |= std::uint32_t{keys.count(key - 1 + i) != 0} << i;
    ASSERT_EQ(map.near<kInOrder>(key), near) << "key " << key;
  };
  std::uint32_t number = 0;
  for (const std::uint64_t key : keys) {
    ASSERT_EQ(map.numberOf<kInOrder>(key), number++) << "key " << key;
    for (std::uint64_t around = key < 3 ? 1 : key - 2; around <= key + 2 && around < end; ++around) expectNear(around);
  }
}

TEST(BrickMap, FindsKeysInUseAndTheirNumbers) {
  lisco::BrickMap map;
  std::size_t in_order = 0;
  std::size_t hashed = 0;
  for (std::uint64_t seed = 1; seed <= timesEffort(400); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto key_bits = static_cast<unsigned>(2 + random.below(random.chance(0.5) ? 18 : 50));
    const std::uint64_t end = std::uint64_t{1} << key_bits;
    const std::size_t count = random.below(random.chance(0.1) ? 3000 : 60);
    std::set<std::uint64_t> keys;
    std::uint64_t key = 0;
    for (std::size_t i = 0; i < count; ++i) {
      // Of one row, of rows beside each other, and anywhere.
      const std::uint64_t jump = random.chance(0.5) ? 1 + random.below(4) : std::uint64_t{1} << random.below(key_bits);
      key = random.chance(0.05) ? random.below(end) : (key + jump) % end;
      if (key != 0) keys.insert(key);
    }
    map.clear(keys.size(), key_bits);
    std::uint32_t number = 0;
    for (const std::uint64_t used : keys) map.add(used, number++);
    if (map.isInOrder()) {
      ++in_order;
      expectKeys<true>(map, keys, end);
    } else {
      ++hashed;
      expectKeys<false>(map, keys, end);
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(in_order, 50U);
  EXPECT_GT(hashed, 50U);
}

}  // namespace
}  // namespace lisco_test
