// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/bits.h"
#include "core/growing_array.h"

namespace lisco {

/// Which keys of a plane's bricks are in use, a bit for each, and the numbers of their bricks, which are in the order
/// of the keys. Words of 64 keys lie in a table: in order, or by a hash if there may be too many.
class BrickMap {
 public:
  /// No key is in use any more.
  /// \param bricks number of keys that follow, at most
  /// \param key_bits of a key
  void clear(std::size_t bricks, unsigned key_bits) {
    for (std::size_t i = 0; i < words_in_use_; ++i) words_[slots_[i]].used = 0;
    words_in_use_ = 0;
    is_in_order_ = key_bits <= kMaxOrderedBits;
    unsigned bits = key_bits < 6 ? 0 : key_bits - 6;
    if (!is_in_order_)
      for (bits = 1; std::size_t{1} << bits < (bits < kMaxSparseBits ? 16 : 2) * bricks;) ++bits;
    shift_ = 64 - bits;
    const std::size_t size = (std::size_t{1} << bits) + 1;  // near () reads the word behind a key's
    growWords(size);
    if (!is_in_order_) ids_.grow(size);
    slots_.growInSteps(bricks);
  }

  /// Makes room for as many keys as another map has room for.
  void reserveAs(const BrickMap& other) {
    growWords(other.words_.size());
    ids_.grow(other.ids_.size());
    slots_.grow(other.slots_.size());
  }

  /// Keys come ascending, with consecutive numbers.
  void add(std::uint64_t key, std::uint32_t number) {
    const std::size_t slot = is_in_order_ ? slotOf<true>(key / 64) : slotOf<false>(key / 64);
    Word& word = words_[slot];
    if (word.used == 0) {
      slots_[words_in_use_++] = static_cast<std::uint32_t>(slot);
      if (!is_in_order_) ids_[slot] = key / 64;
      word.first = number;
    }
    word.used |= std::uint64_t{1} << key % 64;
  }

  /// Whether the table is in order: of the other functions, the form for this is to be called.
  bool isInOrder() const { return is_in_order_; }

  /// Bit i: key - 1 + i is in use, for i up to 2. \param key at least 1
  template <bool kInOrder>
  std::uint32_t near(std::uint64_t key) const {
    const std::uint64_t first = key - 1;
    const std::uint64_t bits = words_[slotOf<kInOrder>(first / 64)].used >> first % 64;
    if (first % 64 <= 61) return static_cast<std::uint32_t>(bits) & 7U;
    return static_cast<std::uint32_t>(bits | words_[slotOf<kInOrder>(first / 64 + 1)].used << (64 - first % 64)) & 7U;
  }

  /// The number of a key in use.
  template <bool kInOrder>
  std::uint32_t numberOf(std::uint64_t key) const {
    const Word& word = words_[slotOf<kInOrder>(key / 64)];
    return word.first + countBits(word.used & ~bitsFrom(key % 64));
  }

 private:
  struct Word {
    std::uint64_t used;   ///< bit i: key 64 id + i
    std::uint32_t first;  ///< number of the first key in use
  };

  /// Most bits of a key for which the table is in order. More: up to 256 KiB for a plane of few bricks; less: hashes
  /// take longer (memory, recordings).
  static constexpr unsigned kMaxOrderedBits = 20;
  /// Most bits of a place at which a hashed table has 16 or more places per key; larger ones have 2 or more. Few places
  /// are taken then, so that most keys around one are missed at the first place: 1.2 times as fast on sparse clouds
  /// (recordings --cloud airborne).
  static constexpr unsigned kMaxSparseBits = 12;

  void growWords(std::size_t size) {
    const std::size_t before = words_.size();
    if (size <= before) return;
    words_.grow(size);
    std::fill(words_.data() + before, words_.data() + words_.size(), Word{0, 0});
  }

  /// Where a word is, or would be.
  template <bool kInOrder>
  std::size_t slotOf(std::uint64_t id) const {
    if (kInOrder) return static_cast<std::size_t>(id);
    const std::size_t mask = ~std::uint64_t{0} >> shift_;
    auto slot = static_cast<std::size_t>(id * 0x9E3779B97F4A7C15U >> shift_);
    while (words_[slot].used != 0 && ids_[slot] != id) slot = (slot + 1) & mask;
    return slot;
  }

  GrowingArray<Word> words_;
  GrowingArray<std::uint64_t> ids_;    ///< of words in use, in a table by a hash
  GrowingArray<std::uint32_t> slots_;  ///< of words in use
  std::size_t words_in_use_ = 0;
  bool is_in_order_ = true;
  unsigned shift_ = 64;  ///< of a hash
};

}  // namespace lisco
