// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/merge_sorted.h"

#include <algorithm>

namespace lisco {

namespace {

/// A merge step by step.
class Merge {
 public:
  Merge(const SortedItems& a, const SortedItems& b, std::uint64_t* to)
      : a_(a.data), a_end_(a.data + a.count), b_(b.data), b_end_(b.data + b.count), to_(to) {}

  bool hasBoth() const { return a_ != a_end_ && b_ != b_end_; }

  /// Without a branch on what is less, which cannot be predicted.
  void step() {
    const std::uint64_t a = *a_;
    const std::uint64_t b = *b_;
    const bool is_b = b < a;
    *to_++ = is_b ? b : a;
    a_ += is_b ? 0 : 1;
    b_ += is_b ? 1 : 0;
  }

  void finish() {
    while (hasBoth()) step();
    std::copy(b_, b_end_, std::copy(a_, a_end_, to_));
  }

 private:
  const std::uint64_t* a_;
  const std::uint64_t* const a_end_;
  const std::uint64_t* b_;
  const std::uint64_t* const b_end_;
  std::uint64_t* to_;
};

/// How many of the first `count` items of both are a's.
std::size_t shareOf(const SortedItems& a, const SortedItems& b, std::size_t count) {
  std::size_t least = count - std::min(count, b.count);
  std::size_t most = std::min(count, a.count);
  while (least < most) {
    const std::size_t middle = least + (most - least) / 2;
    if (a.data[middle] < b.data[count - middle - 1])
      least = middle + 1;
    else
      most = middle;
  }
  return least;
}

}  // namespace

/// The lower and the upper half in turn: neither waits until the other has found its least item.
void mergeSorted(const SortedItems& a, const SortedItems& b, std::uint64_t* to) {
  const std::size_t half = (a.count + b.count) / 2;
  const std::size_t of_a = shareOf(a, b, half);
  const std::size_t of_b = half - of_a;
  Merge lower({a.data, of_a}, {b.data, of_b}, to);
  Merge upper({a.data + of_a, a.count - of_a}, {b.data + of_b, b.count - of_b}, to + half);
  while (lower.hasBoth() && upper.hasBoth()) {
    lower.step();
    upper.step();
  }
  lower.finish();
  upper.finish();
}

}  // namespace lisco
