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

/// Fragments of consecutive planes, the work of one thread.
struct alignas(kSeparate) Slab {
  std::size_t begin, end;  ///< among the sorted fragments
  std::size_t voxels = 0;  ///< of single returns: number of them; voxel i is element begin + i
};

/// Divides planes of bricks into slabs, a thread's work each, by the times that threads took for theirs before.
class SlabDivision {
 public:
  std::vector<Slab> slabs;  ///< in the order of their planes; there is at least one

  /// Makes the fragments of all parts one slab.
  void join(const FragmentList& fragments, FragmentItems& items);

  /// Moves the fragments of each slab together: slabs of about equal work, one for each part.
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

 private:
  struct Planes {
    std::uint32_t fragments;  ///< number of them; then where the next one goes
    std::uint32_t work;       ///< of linking them, about in returns
  };

  void assign(std::size_t axis, const std::vector<Box>& parts);

  std::vector<Planes> histogram_;       ///< of groups of planes, of each part
  std::vector<std::size_t> thread_of_;  ///< by slab, if the work is shared
  std::vector<std::size_t> slab_of_;    ///< by thread
  WorkShares shares_;                   ///< of threads
};

}  // namespace lisco
