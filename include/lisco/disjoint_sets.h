// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lisco {

/// The paper's subclusters and their heads (section IV, createH / getH / merge) as a disjoint-set forest (Galler and
/// Fischer 1964): the head of a set is its element with the lowest number, so that which element is the head does not
/// depend on the order of the merges, and paths are halved on the way (van Leeuwen and van der Weide 1977).
///
/// While it is shared, any number of threads may call head () and merge () at once: a head becomes another's child by
/// one compare-and-swap (Anderson and Woll 1991), and an element's parent only ever moves towards its head.
class DisjointSets {
 public:
  /// Forgets all elements and makes room for so many. Keeps its memory.
  void reset(std::size_t room) {
    if (parents_.size() < room) parents_.resize(room);
    shared_ = false;
  }
  std::size_t room() const { return parents_.size(); }

  /// createH: a new set of one element. There is room for it.
  void create(std::uint32_t element) { parents_[element] = element; }
  /// Makes room for more elements than reset () said.
  void grow(std::size_t room) {
    if (parents_.size() < room) parents_.resize(room + room / 2);
  }

  /// Whether several threads are at work.
  void share(bool shared) { shared_ = shared; }

  /// getH: the head of the set that holds the element.
  std::uint32_t head(std::uint32_t element) {
    std::uint32_t parent = load(element);
    while (parent != element) {
      const std::uint32_t grandparent = load(parent);
      if (grandparent != parent) store(element, grandparent);
      element = parent;
      parent = grandparent;
    }
    return element;
  }

  /// merge: joins the sets of two elements. \return their head now
  std::uint32_t merge(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = head(a);
      b = head(b);
      if (a == b) return a;
      if (a > b) std::swap(a, b);
      if (!shared_) {
        store(b, a);
        return a;
      }
      std::uint32_t expected = b;
      if (__atomic_compare_exchange_n(&parents_[b], &expected, a, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return a;
    }
  }

 private:
  std::uint32_t load(std::uint32_t element) const { return __atomic_load_n(&parents_[element], __ATOMIC_RELAXED); }
  void store(std::uint32_t element, std::uint32_t parent) {
    __atomic_store_n(&parents_[element], parent, __ATOMIC_RELAXED);
  }

  std::vector<std::uint32_t> parents_;
  bool shared_ = false;
};

}  // namespace lisco
