// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/bits.h"
#include "core/disjoint_sets.h"
#include "core/growing_array.h"
#include "core/laser_order.h"
#include "core/near/near_returns.h"
#include "core/near/voxel_sorter.h"
#include "core/neighbour.h"
#include "core/parallel.h"
#include "core/partition.h"
#include "lisco/return.h"

namespace lisco {

/// A rotation whose returns make hardly any runs, as those of a shuffled or voxel-filtered cloud: read at once, without
/// runs and without a range image, and sorted by voxel. Sets are of voxels.
class UnorderedReturns {
 public:
  /// Estimates from a sample whether a cloud's runs take more time than they save.
  static bool isUnordered(std::size_t columns, std::size_t lasers, const CellSource& cells, const Tolerance& tolerance);

  /// Starts without returns. Keeps its memory.
  void begin(std::size_t parts);
  /// Reads the columns [first, end), laser by laser. Threads may read different parts at once.
  void readPart(std::size_t part, const CellSource& cells, std::size_t first, std::size_t end, std::size_t lasers);

  /// The returns of the first part, whose memory may serve others until begin ().
  NearReturns& memory() {
    if (parts_.empty()) parts_.resize(1);
    return parts_.front().near;
  }

  /// Finds and numbers the sets of neighbours. \param sizes receives the number of returns of each set
  /// \return false if the sorter refuses the returns
  bool link(VoxelSorter& sorter, const Tolerance& tolerance, std::vector<std::uint32_t>& sizes);

  std::size_t count() const;
  /// Visits all returns laser by laser. \param sorter of link (), which holds the numbers of the sets
  void visit(const VoxelSorter& sorter, const RunVisitor& visit, bool from_both_ends);
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// The number of a return's set, kNone if there is no return in the cell. \param sorter as above
  std::uint32_t setAt(const VoxelSorter& sorter, std::size_t laser, std::size_t column);

  /// Puts all returns into a partition without far returns, as if it had read them.
  void moveTo(Partition& partition, DisjointSets& subclusters);

 private:
  /// The returns of a ring block; blocks without a return have no entry.
  struct Block {
    std::uint32_t laser;
    std::uint32_t first_column;
    std::uint32_t first_return;  ///< in its part
    ColumnBits returns;
  };
  struct alignas(kSeparate) Part {
    NearReturns near;
    std::vector<Block> blocks;
  };

  void sortBlocks();

  std::vector<Part> parts_;
  std::size_t part_count_ = 0;
  std::vector<VoxelSorter::SingleReturns> numbered_;  ///< of each part, once linked
  LaserOrder order_;
  bool is_sorted_ = false;  ///< order_, since begin ()
};

}  // namespace lisco
