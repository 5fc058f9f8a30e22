// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

/// Sets of a ring block's 64 columns, bit i for column i.
using ColumnBits = std::uint64_t;

/// Bits of a vector mask that were stored in one or two bytes, as a word. GCC 12 may store a mask register in as many
/// bytes and load eight, seen with -fsanitize=thread; not if the word is in a general register in between.
inline std::uint32_t wordOf(std::uint32_t mask_bits) {
#if defined(__GNUC__) && !defined(__clang__)
  asm("" : "+r"(mask_bits));
#endif
  return mask_bits;
}

/// Calls visit(i) for each bit that is set, ascending.
template <typename Visit>
void forEachBit(ColumnBits bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(__builtin_ctzll(bits)));
}

/// Number of bits set, without the instruction for it, which the oldest processors do not have.
inline std::uint32_t countBits(ColumnBits bits) {
  bits -= bits >> 1 & 0x5555555555555555U;
  bits = (bits & 0x3333333333333333U) + (bits >> 2 & 0x3333333333333333U);
  bits = (bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0FU;
  return static_cast<std::uint32_t>(bits * 0x0101010101010101U >> 56);
}

/// Number of bits that all numbers up to the largest need, at least 1.
/// \param largest below 2^63
inline unsigned bitsFor(std::uint64_t largest) {
  unsigned bits = 1;
  while (largest >> bits != 0) ++bits;
  return bits;
}

/// Bits first, first + 1, ... ; none from 64 on.
inline ColumnBits bitsFrom(std::size_t first) {
  return first < 64 ? ~ColumnBits{0} << first : 0;
}

/// The end of the chain that begins with a column, 64 at most.
/// \param ends columns that no chain goes on with
inline std::size_t endOfChain(ColumnBits ends, std::size_t begin) {
  const ColumnBits after = ends & bitsFrom(begin + 1);
  return after != 0 ? static_cast<std::size_t>(__builtin_ctzll(after)) : std::size_t{64};
}

/// Calls visit(begin, end) for each chain of consecutive members; a chain ends before the next start as well.
/// \param starts the members that begin a chain: the first of each group of consecutive ones, and more
template <typename Visit>
void forEachChain(ColumnBits starts, ColumnBits members, Visit&& visit) {
  const ColumnBits ends = ~members | starts;
  forEachBit(starts, [&](std::size_t begin) { visit(begin, endOfChain(ends, begin)); });
}

}  // namespace lisco
