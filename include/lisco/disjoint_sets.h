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
class DisjointSets {
 public:
  /// Forgets all elements and makes room for so many. Keeps its memory.
  void reset(std::size_t room) {
    if (parents_.size() < room) parents_.resize(room);
  }
  std::size_t room() const { return parents_.size(); }

  /// createH: a new set of one element. There is room for it.
  void create(std::uint32_t element) { parents_[element] = element; }
  /// Makes room for more elements than reset () said.
  void grow(std::size_t room) {
    if (parents_.size() < room) parents_.resize(room + room / 2);
  }

  /// getH: the head of the set that holds the element.
  std::uint32_t head(std::uint32_t element) {
    std::uint32_t parent = parents_[element];
    while (parent != element) {
      const std::uint32_t grandparent = parents_[parent];
      parents_[element] = grandparent;
      element = parent;
      parent = grandparent;
    }
    return element;
  }

  /// merge: joins the sets of two elements. \return their head now
  std::uint32_t merge(std::uint32_t a, std::uint32_t b) {
    a = head(a);
    b = head(b);
    if (a == b) return a;
    if (a > b) std::swap(a, b);
    parents_[b] = a;
    if (log_ != nullptr) log_->push_back({a, b});
    return a;
  }

  /// Two heads of which the first is now the head of both sets.
  struct Merge {
    std::uint32_t head, former_head;
  };
  /// From now on, merge () tells what it has joined; nullptr: to nobody.
  void logTo(std::vector<Merge>* log) { log_ = log; }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<Merge>* log_ = nullptr;
};

}  // namespace lisco
