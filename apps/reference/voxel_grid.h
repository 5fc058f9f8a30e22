// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/neighbour.h"
#include "lisco/return.h"

namespace lisco_reference {

/// Exact Euclidean clustering of a finished scan by a voxel grid, for comparison only; not part of the library.
///
/// Cells have a side of 0.9999 eps / sqrt(3), so that all points of a cell are neighbours and a cell is one component.
/// Points are sorted by cell (radix sort by z, y, x). Points within eps lie at most two cells apart per axis: each cell
/// is compared with the two that follow it in its row and with those of 12 rows that follow, each row read by a cursor
/// that moves forward only. Two cells are compared by head, then by box, then point by point up to the first pair of
/// neighbours. Memory is kept from scan to scan.
class VoxelGrid {
 public:
  /// Finds the connected components of `returns`.
  /// \param returns all valid (lisco::isReturn)
  /// \return component number per return; valid until the next call
  /// \throws std::runtime_error if the scan has more than 2^37 cells along an axis, or more than 64 bits can number, or
  ///         if the tolerance is not 0 and below 1e-18 m or above 1e18 m
  const std::vector<std::uint32_t>& cluster(const std::vector<lisco::Return>& returns, float tolerance);

 private:
  struct Item {
    std::uint64_t key;     ///< of the cell: z, y, x from high to low bits
    std::uint32_t number;  ///< of the return
  };
  struct Cell {
    std::uint64_t key;
    std::uint32_t first;  ///< of its points
    lisco::Box box;
  };
  struct Point {
    float x, y, z;
  };

  void numberCells(const std::vector<lisco::Return>& returns);
  void sortItems();
  void gatherCells(const std::vector<lisco::Return>& returns);
  void linkCells();
  void link(std::size_t a, std::size_t b);
  bool touch(const Cell& a, std::size_t a_end, const Cell& b, std::size_t b_end) const;

  lisco::Tolerance tolerance_;
  double side_ = 0;
  int bits_[3] = {0, 0, 0};  ///< of the cell's number, per axis
  std::vector<Item> items_, sorted_;
  std::vector<Point> points_;  ///< cell by cell
  std::vector<Cell> cells_;    ///< by key; and one past the end
  lisco::DisjointSets components_;
  std::vector<std::uint32_t> component_of_;
};

}  // namespace lisco_reference
