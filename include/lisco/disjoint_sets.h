// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lisco {

/// The paper's subclusters and their heads (section IV, createH / getH / merge) as a disjoint-set
/// forest (Galler and Fischer 1964, Tarjan 1975): the larger set keeps its head, as in the paper, and paths
/// are halved, so that n operations take O(n alpha(n)) instead of the paper's O(n log n). Invariant: a head
/// is its own parent, and weight(head) is the number of returns in its set.
class DisjointSets {
 public:
  void clear() { nodes_.clear(); }
  void reserve(std::size_t n) { nodes_.reserve(n); }
  std::size_t size() const { return nodes_.size(); }

  /// createH and setH: a new set of its own that holds `weight` returns; the new element's number is size() - 1.
  void create(std::uint32_t weight) { nodes_.push_back({static_cast<std::uint32_t>(nodes_.size()), weight}); }

  /// getH: the head of the set that holds `element`.
  std::uint32_t head(std::uint32_t element) {
    while (nodes_[element].parent != element) {
      nodes_[element].parent = nodes_[nodes_[element].parent].parent;
      element = nodes_[element].parent;
    }
    return element;
  }

  /// merge: joins two sets given by their different heads and returns the head that stays.
  std::uint32_t merge(std::uint32_t head_a, std::uint32_t head_b) {
    if (nodes_[head_a].weight < nodes_[head_b].weight) std::swap(head_a, head_b);
    nodes_[head_b].parent = head_a;
    nodes_[head_a].weight += nodes_[head_b].weight;
    return head_a;
  }

  /// Number of returns in the set whose head is `head`.
  std::uint32_t weight(std::uint32_t head) const { return nodes_[head].weight; }

 private:
  struct Node {
    std::uint32_t parent;
    std::uint32_t weight;
  };
  std::vector<Node> nodes_;
};

}  // namespace lisco
