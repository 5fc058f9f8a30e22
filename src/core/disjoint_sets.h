// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/growing_array.h"

namespace lisco {

/// The paper's subclusters and their heads (section IV: createH, getH, merge) as a disjoint-set forest (Galler and
/// Fischer 1964). The root of a set is its element with the lowest number, whatever the order of the merges; paths are
/// halved on the way (van Leeuwen and van der Weide 1977).
class DisjointSets {
 public:
  /// Provides memory for elements below a number. Other elements stay as they are.
  void reserve(std::size_t capacity, NewPages pages = NewPages::kPopulated) { parents_.grow(capacity, pages); }
  /// The same, for a number that grows step by step.
  void grow(std::size_t capacity) { parents_.growInSteps(capacity); }

  /// createH: makes an element a set of its own, whatever it was before.
  void create(std::uint32_t element) { parents_[element] = element; }
  /// The same for elements first..end-1.
  void create(std::uint32_t first, std::uint32_t end) {
    std::uint32_t* const parents = parents_.data();
    for (std::uint32_t element = first; element < end; ++element) parents[element] = element;
  }

  /// The element itself if it is a root, else a lower one of its set.
  std::uint32_t parentOf(std::uint32_t element) const { return __atomic_load_n(&parents_[element], __ATOMIC_RELAXED); }

  /// getH: the root of the set that holds the element.
  std::uint32_t find(std::uint32_t element) {
    std::uint32_t parent = parentOf(element);
    while (parent != element) {
      const std::uint32_t grandparent = parentOf(parent);
      if (grandparent == parent) return parent;  // without a store, which would take the cache line from other threads
      __atomic_store_n(&parents_[element], grandparent, __ATOMIC_RELAXED);
      element = parent;
      parent = grandparent;
    }
    return element;
  }

  /// Loads what find () of an element reads first.
  void prefetch(std::uint32_t element) const { __builtin_prefetch(&parents_[element], 1); }

  /// merge: joins the sets of two elements. \return the root of the joined set
  std::uint32_t merge(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = find(a);
      b = find(b);
      if (a == b) return a;
      if (a > b) std::swap(a, b);
      if (!is_shared_) break;
      std::uint32_t root = b;
      if (__atomic_compare_exchange_n(&parents_[b], &root, a, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return a;
    }
    parents_[b] = a;
    if (log_ != nullptr) log_->push_back({a, b});
    return a;
  }

  /// The same as merge () of a root and another element, which is usually a set of its own.
  std::uint32_t add(std::uint32_t root, std::uint32_t element) {
    const std::uint32_t parent = parentOf(element);
    if (parent == root) return root;
    if (is_shared_ || root >= element || parent != element || log_ != nullptr) return merge(root, element);
    parents_[element] = root;
    return root;
  }

  /// Whether several threads may call find () and merge () at once. A root changes by compare and swap then (Anderson
  /// and Woll 1991); other elements only move to an ancestor.
  void share(bool is_shared) { is_shared_ = is_shared; }

  /// Two roots, of which the first is now the root of both sets.
  struct Merge {
    std::uint32_t root, former_root;
  };
  /// Makes merge () append what it joins to a log; nullptr: none.
  void logTo(std::vector<Merge>* log) { log_ = log; }

 private:
  GrowingArray<std::uint32_t> parents_;
  bool is_shared_ = false;
  std::vector<Merge>* log_ = nullptr;
};

/// Numbers sets in the order of their roots, and adds up their sizes.
class SetNumbering {
 public:
  /// \param sizes receives those of the sets; finish () gives it its length
  SetNumbering(const DisjointSets& sets, std::vector<std::uint32_t>& sizes) : sets_(sets), sizes_(sizes) {
    sizes.clear();
  }

  /// The number of an element's set. Elements come ascending: a parent, lower than its children, before these.
  /// \param size of the element
  /// \param number_of callable as std::uint32_t (std::uint32_t parent): the number returned for it; of a root, any
  template <typename NumberOf>
  std::uint32_t numberOf(std::uint32_t element, std::uint32_t size, NumberOf&& number_of) {
    if (next_ == sizes_.size()) makeRoom();
    const std::uint32_t parent = sets_.parentOf(element);
    const std::uint32_t of_parent = number_of(parent);
    // Without a branch, as roots come irregularly.
    const std::uint32_t root_mask = std::uint32_t{0} - std::uint32_t{parent == element};
    const std::uint32_t number = (next_ & root_mask) | (of_parent & ~root_mask);
    next_ -= root_mask;
    sizes_[number] += size;
    return number;
  }

  /// After the last element.
  void finish() { sizes_.resize(next_); }

 private:
  /// Counting the roots first would read all elements twice (benchmarks/suite.sh stages).
  [[gnu::noinline]] void makeRoom() {
    constexpr std::size_t kStep = 256;
    const std::size_t size = sizes_.size() + kStep;
    reserveInSteps(sizes_, size);
    sizes_.resize(size);
  }

  const DisjointSets& sets_;
  std::vector<std::uint32_t>& sizes_;
  std::uint32_t next_ = 0;
};

}  // namespace lisco
