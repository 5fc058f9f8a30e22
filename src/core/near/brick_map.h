// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/bits.h"
#include "core/growing_array.h"

namespace lisco {

/// Which keys are in use, a bit for each, and the numbers of their bricks, which are in the order of the keys.
class BrickMap {
 public:
  /// Makes room for keys below a number. No key is in use before the first add ().
  void reserve(std::size_t keys) {
    const std::size_t words = keys / 64 + 2;  // near () reads behind the last
    const std::size_t before = words_.size();
    if (words <= before) return;
    words_.grow(words);
    std::fill(words_.data() + before, words_.data() + words_.size(), Word{0, 0});
  }

  /// Keys come ascending, with consecutive numbers.
  void add(std::uint64_t key, std::uint32_t number) {
    Word& word = words_[key / 64];
    if (word.used == 0) word.first = number;
    word.used |= std::uint64_t{1} << key % 64;
  }
  void remove(std::uint64_t key) { words_[key / 64].used = 0; }

  /// Bit i: key - 1 + i is in use, for i up to 2. \param key at least 1
  std::uint32_t near(std::uint64_t key) const {
    const std::uint64_t first = key - 1;
    const std::uint64_t bits = words_[first / 64].used >> first % 64;
    // Twice by less than 64.
    const std::uint64_t next = words_[first / 64 + 1].used << 1 << (63 - first % 64);
    return static_cast<std::uint32_t>(bits | next) & 7U;
  }
  /// The number of a key in use.
  std::uint32_t numberOf(std::uint64_t key) const {
    const Word& word = words_[key / 64];
    return word.first + countBits(word.used & ~bitsFrom(key % 64));
  }

 private:
  struct Word {
    std::uint64_t used;   ///< bit i: key 64 n + i
    std::uint32_t first;  ///< number of the first key in use
  };
  GrowingArray<Word> words_;
};

}  // namespace lisco
