// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/growing_array.h"
#include "core/ring_block.h"
#include "lisco/return.h"

namespace lisco {

/// The returns of some columns as *runs*: chains of neighbours that one laser returned in consecutive columns.
struct Runs {
  /// The runs of a ring block; blocks without a return have no entry.
  struct Block {
    std::uint32_t laser;
    std::uint32_t first_column;
    std::uint32_t first_cell;  ///< that of first_column
    std::uint32_t first_run;
    std::uint32_t count;
  };

  bool keeps_source_indices = true;
  std::vector<std::uint32_t> source_index;  ///< of each cell of the blocks with returns, if it is kept
  /// Run::first_cell counts in source_index, or, if that is not kept, in the run's block; the first run_count are used.
  GrowingArray<Run> runs;
  std::size_t run_count = 0;
  std::vector<Block> blocks;
  std::size_t returns = 0;

  /// Forgets all but whether it keeps source indices. Keeps its memory.
  void clear();

  /// The runs of one of the blocks.
  RunBlock blockOf(const Block& block) const {
    return {runs.data() + block.first_run,
            block.count,
            block.laser,
            block.first_column,
            block.first_cell,
            keeps_source_indices ? source_index.data() : nullptr};
  }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// The run of a cell of a block, kNone if it is no return.
  /// \param column within the block
  std::uint32_t runAt(const Block& block, std::uint32_t column) const;

  /// Cuts a ring block at info.starts. Each run is a new set of the subclusters; run i is element first_element + i.
  /// \param info receives the element of each return's run
  void add(const RingBlock& block, RingBlockInfo& info, std::size_t laser, std::uint32_t first_column,
           std::size_t columns, std::uint32_t first_element, DisjointSets& subclusters);
};

}  // namespace lisco
