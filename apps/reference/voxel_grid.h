// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/neighbour.h"
#include "lisco/return.h"

namespace lisco_reference {

/// Exact Euclidean clustering of a finished scan by a voxel grid, for comparison only; not part of the library.
///
/// Cells have a side of 0.9999 eps / sqrt(3), so that all points of a cell are neighbours and a cell is one component.
/// Points are sorted by cell (radix sort by z, y, x). Points within eps lie at most two cells apart per axis: each row
/// of cells along x is compared with itself and with the rows that follow within two steps of y and z, which are found
/// by cursors that move forward only; two rows are merged like sorted lists. Two cells are compared by root, then by
/// box, then point by point up to the first pair of neighbours. Memory is kept from scan to scan.
class VoxelGrid {
 public:
  /// Finds the connected components of `returns`.
  /// \param returns all valid (lisco::isReturn)
  /// \return component number per return, less than the number of returns; valid until the next call
  /// \throws std::runtime_error if the scan has more than 2^37 cells along an axis, or if 63 bits cannot number its
  ///         cells and returns, or if the tolerance is not 0 and below 1e-18 m or above 1e18 m
  const std::vector<std::uint32_t>& cluster(const std::vector<lisco::Return>& returns, float tolerance);

 private:
  /// Row of the cell (z, y from high to low), its x, and number of the return, from high to low bits.
  using Item = std::uint64_t;
  struct Row {
    std::uint64_t number;
    std::uint32_t first;  ///< of its cells
  };
  struct Cell {
    std::uint32_t first;  ///< of its points
    lisco::Box box;
  };
  struct Point {
    float x, y, z;
  };

  void numberCells(const std::vector<lisco::Return>& returns);
  void sortItems();
  void gatherCells(const std::vector<lisco::Return>& returns);
  void linkRows();
  void linkWithin(const Row& row);
  void linkAcross(const Row& row, const Row& later);
  /// \param root_a of a \return a's root afterwards
  std::uint32_t link(std::uint32_t a, std::uint32_t root_a, std::uint32_t b);
  bool touch(std::uint32_t a, std::uint32_t b) const;

  lisco::Tolerance tolerance_;
  double side_ = 0;
  std::uint64_t rows_per_z_ = 0;
  int number_bits_ = 0, x_bits_ = 0, all_bits_ = 0;  ///< of an item
  std::vector<Item> items_, sorted_;
  std::vector<Point> points_;        ///< cell by cell
  std::vector<std::uint64_t> keys_;  ///< of the cells, ascending: row and x; and one past the end
  std::vector<Cell> cells_;          ///< by key; and one past the end
  std::vector<Row> rows_;            ///< by number; and one past the end
  lisco::DisjointSets components_;
  std::vector<std::uint32_t> component_of_;
};

}  // namespace lisco_reference
