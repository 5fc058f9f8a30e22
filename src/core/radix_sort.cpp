// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/radix_sort.h"

#include <algorithm>
#include <utility>

namespace lisco {

/// Digit by digit, from the lowest one on. Items are counted and moved two at a time: where both have the same digit,
/// the second need not wait until the first one's count or place is written.
void radixSort(std::uint64_t* items, std::uint64_t* scratch, std::size_t count, unsigned low_bit, unsigned bits) {
  constexpr unsigned kDigitBits = 11;  // a histogram of 8 KiB fits into the first-level cache
  constexpr std::size_t kMaxPasses = 6;
  static_assert(kMaxPasses * kDigitBits >= 64, "the longest keys fit");
  if (count == 0 || bits == 0) return;
  const unsigned passes = (bits + kDigitBits - 1) / kDigitBits;
  const unsigned digit_bits = (bits + passes - 1) / passes;
  const std::uint64_t mask = (std::uint64_t{1} << digit_bits) - 1;
  const std::uint64_t compared = ~std::uint64_t{0} >> (64 - bits);
  std::uint32_t places[kMaxPasses][std::size_t{1} << kDigitBits];
  std::uint32_t others[kMaxPasses][std::size_t{1} << kDigitBits];  // counts of every second item
  for (unsigned pass = 0; pass < passes; ++pass) {
    std::fill_n(places[pass], mask + 1, 0);
    std::fill_n(others[pass], mask + 1, 0);
  }
  std::uint64_t* from = items;
  std::uint64_t* to = scratch;
  const std::size_t even = count - count % 2;
  for (std::size_t i = 0; i < even; i += 2) {
    std::uint64_t rest = from[i] >> low_bit & compared;
    std::uint64_t other = from[i + 1] >> low_bit & compared;
    for (unsigned pass = 0; pass < passes; ++pass, rest >>= digit_bits, other >>= digit_bits) {
      ++places[pass][rest & mask];
      ++others[pass][other & mask];
    }
  }
  if (even < count) {
    std::uint64_t rest = from[even] >> low_bit & compared;
    for (unsigned pass = 0; pass < passes; ++pass, rest >>= digit_bits) ++places[pass][rest & mask];
  }
  for (unsigned pass = 0; pass < passes; ++pass) {
    std::uint32_t* const place = places[pass];
    const std::uint32_t* const other = others[pass];
    const unsigned shift = low_bit + pass * digit_bits;
    const std::uint64_t digits = mask & compared >> pass * digit_bits;
    const std::uint64_t first = from[0] >> shift & digits;
    if (place[first] + other[first] == count) continue;  // the same digit in all
    std::uint32_t sum = 0;
    for (std::size_t digit = 0; digit <= digits; ++digit) sum += std::exchange(place[digit], sum) + other[digit];
    for (std::size_t i = 0; i < even; i += 2) {
      const std::uint64_t digit = from[i] >> shift & digits;
      const std::uint64_t other_digit = from[i + 1] >> shift & digits;
      const std::uint32_t at = place[digit];
      const std::uint32_t other_at = place[other_digit] + static_cast<std::uint32_t>(digit == other_digit);
      to[at] = from[i];
      to[other_at] = from[i + 1];
      place[digit] = at + 1;
      place[other_digit] = other_at + 1;
    }
    if (even < count) to[place[from[even] >> shift & digits]] = from[even];
    std::swap(from, to);
  }
  if (from != items) std::copy_n(from, count, to);
}

}  // namespace lisco
