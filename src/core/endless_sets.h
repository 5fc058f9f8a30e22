// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/stream_position.h"

namespace lisco {

/// The clusters of an endless stream as a disjoint-set forest of runs. The root of a set holds what is known of its
/// cluster, and the chain of its runs. Runs live in panes, of which the latest kSlots are kept.
///
/// Invariant: a set is open or delivered. Merging never adds a run to a delivered set, so that each run is delivered
/// exactly once.
class EndlessSets {
 public:
  /// A run: the slot of its pane, and its number in the pane.
  using Element = std::uint32_t;
  static constexpr Element kNone = ~Element{0};
  static constexpr std::int64_t kSlots = 16;  ///< panes in memory: more than a cluster and its neighbours span
  static_assert((kSlots & (kSlots - 1)) == 0, "slots of negative panes follow those of positive ones");

  struct Set {
    Element parent;
    Element next_run, last_run;  ///< of the chain
    std::uint32_t size;          ///< returns
    Ticks reach_end;
    double first_position, last_position;  ///< of its columns, turns
    std::int64_t first_pane;
    bool delivered, cut, continued;
  };

  /// Starts a pane in place of the oldest one.
  void startPane(std::int64_t pane) { sets_[slotOf(pane)].clear(); }
  /// Number of runs in a pane.
  std::uint32_t runCount(std::int64_t pane) const { return static_cast<std::uint32_t>(sets_[slotOf(pane)].size()); }

  static Element elementOf(std::int64_t pane, std::uint32_t run) {
    return static_cast<Element>(slotOf(pane)) << kRunBits | run;
  }
  static std::size_t slotOf(std::int64_t pane) {
    return static_cast<std::size_t>(static_cast<std::uint64_t>(pane) % std::uint64_t{kSlots});
  }
  static std::size_t slotOfElement(Element element) { return element >> kRunBits; }
  static std::uint32_t runOf(Element element) { return element & ((Element{1} << kRunBits) - 1); }

  /// createH: an open set of a new run of a pane, without returns.
  Set& create(std::int64_t pane, double position);
  Set& operator[](Element element) { return sets_[slotOfElement(element)][runOf(element)]; }
  bool isRoot(Element element) { return (*this)[element].parent == element; }

  /// getH: the root of the set that holds a run.
  Element find(Element element);

  /// merge: joins the sets of two runs. An open set that meets a delivered one becomes the root of both and is marked
  /// as continued; the delivered returns are not added to it.
  void merge(Element a, Element b);

 private:
  static constexpr int kRunBits = 28;

  std::array<std::vector<Set>, static_cast<std::size_t>(kSlots)> sets_;  ///< one for each run
};

}  // namespace lisco
