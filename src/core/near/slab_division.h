// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/near/fragments.h"
#include "core/near/voxel_numbering.h"
#include "core/neighbour.h"
#include "core/parallel.h"
#include "core/work_shares.h"

namespace lisco {

/// Consecutive planes, among the sorted fragments.
struct Planes {
  std::size_t begin, end;

  /// The first plane of them, or the last one.
  Planes outerOne(bool last, const FragmentItems& items) const {
    if (last) return {items.beginOfPlane(end - 1, begin), end};
    return {begin, items.endOfPlane(begin, end)};
  }
};

/// Consecutive planes, merged by one thread, which begins to link them at their first one, or at their last one.
struct alignas(kSeparate) Slab : Planes {
  std::size_t voxels = 0;  ///< of single returns, in the planes that the thread has linked
};

/// Two slabs side by side. Their threads link the planes from the outer ones on, until they meet: so neither waits long
/// for the other, whatever their work.
class alignas(kSeparate) SlabPair {
 public:
  /// \param left the planes that remain to be taken
  void begin(const Planes& left) {
    left_ = inWord(left);
    ended_ = 0;
  }

  /// Takes some of the planes that are left, the first ones or the last ones. \return false if none is left
  bool take(bool last, const FragmentItems& items, Planes& taken);

  /// The planes that are left. Once there are none, it is empty at the place where the threads have met.
  Planes left() const {
    const std::uint64_t word = __atomic_load_n(&left_, __ATOMIC_RELAXED);
    return {word & kMask, word >> kBits};
  }

  /// Each thread calls this once it finds no plane left. \return true for the second one, which sees all that the
  /// first has written
  bool end() { return __atomic_fetch_add(&ended_, 1U, __ATOMIC_ACQ_REL) == 1; }

 private:
  static constexpr unsigned kBits = 32;
  static constexpr std::uint64_t kMask = ~std::uint32_t{0};
  static std::uint64_t inWord(const Planes& planes) { return std::uint64_t{planes.end} << kBits | planes.begin; }

  std::uint64_t left_ = 0;
  std::uint32_t ended_ = 0;  ///< threads
};

/// Divides planes of bricks into slabs, a thread's work each, by the times that threads took for theirs before.
class SlabDivision {
 public:
  std::vector<Slab> slabs;  ///< in the order of their planes; there is at least one

  /// Makes the fragments of all parts one slab.
  void join(const FragmentList& fragments, FragmentItems& items);

  /// Merges the fragments of all parts, which are sorted, into slabs, one for each part, by the threads' shares.
  /// \param boxes of the parts
  void divide(const FragmentList& fragments, const std::vector<Box>& boxes, const VoxelNumbering& numbering,
              FragmentItems& items);

  /// Calls work(slab) for each slab, by the thread that it is assigned to.
  template <typename Work>
  void forEach(Work&& work) {
    if (slabs.size() == 1) return work(std::size_t{0});
    inParallel(slab_of_.size(), [&](std::size_t thread) {
      const std::size_t slab = slab_of_[thread];
      if (slab < slabs.size()) shares_.time(thread, [&] { work(slab); });
    });
  }

  /// Whether a slab's thread links from its last plane on: every second one does.
  static bool descends(std::size_t slab) { return slab % 2 != 0; }
  SlabPair& pairOf(std::size_t slab) { return pairs_[slab / 2]; }
  /// Begins the linking. The outer plane of each slab, where its thread begins, is taken.
  void beginLinking(const FragmentItems& items);
  Planes outerPlane(std::size_t slab, const FragmentItems& items) const {
    return slabs[slab].outerOne(descends(slab), items);
  }
  /// The planes that the thread of a slab has linked, once all are linked.
  Planes linkedBy(std::size_t slab) const {
    const std::size_t meeting = pairs_[slab / 2].left().begin;
    return descends(slab) ? Planes{meeting, slabs[slab].end} : Planes{slabs[slab].begin, meeting};
  }

 private:
  /// Sorted fragments.
  struct Range {
    std::size_t begin, end;
  };

  void assign(std::size_t axis, const std::vector<Box>& boxes);
  void cut(const FragmentList& fragments, const VoxelNumbering& numbering, const FragmentItems& items);

  std::vector<Range> ranges_;           ///< for each slab, those that are to be merged: as many as there are parts
  std::vector<SlabPair> pairs_;         ///< the last one may be of one slab
  std::vector<std::size_t> thread_of_;  ///< by slab, if the work is shared
  std::vector<std::size_t> slab_of_;    ///< by thread
  WorkShares shares_;                   ///< of threads
};

}  // namespace lisco
