// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <cstddef>
#include <cstdint>

#include "lisco/column_block.h"
#include "lisco/disjoint_sets.h"
#include "lisco/row.h"
#include "lisco/runs.h"
#include "lisco/tolerance.h"
#include "lisco/voxels.h"

namespace lisco {

/// Some columns of a stream, clustered by themselves: run i of the runs is element i of the subclusters. What panes have
/// in common is found by Voxels::linkTo.
struct Pane {
  Runs runs;
  DisjointSets subclusters;
  Voxels voxels;

  /// Forgets all. Keeps its memory.
  void clear(const Tolerance& tolerance) {
    runs.clear();
    voxels.prepare(tolerance);
  }

  /// Reads a block of columns, row by row.
  /// \param range only its origin matters
  /// \param keep callable as std::uint64_t (const Row&, MeasuredRow&): which returns may have neighbours at all
  template <typename Keep>
  void read(ColumnBlock& block, std::uint32_t first_column, const Tolerance& tolerance, const FarRange& range,
            Keep&& keep) {
    MeasuredRow measured;
    for (std::size_t laser = 0; laser < block.lasers(); ++laser) {
      Row& row = block.row(laser);
      measureRow(row, block.columns(), tolerance.squared(), range, measured);
      if (measured.returns == 0) continue;
      const std::uint64_t kept = keep(row, measured);
      runs.add(row, measured, laser, first_column, block.columns(), 0, subclusters);
      if (kept != 0) voxels.add(row, measured, kept, subclusters);
    }
    block.clear();
  }
};

}  // namespace lisco
