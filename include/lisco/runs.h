// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/disjoint_sets.h"
#include "lisco/export.h"
#include "lisco/row.h"

namespace lisco {

/// The returns of some columns as *runs*: chains of neighbours that one laser returned in columns side by side.
struct LISCO_EXPORT Runs {
  struct Run {
    std::uint32_t first_cell;  ///< its cells follow each other
    std::uint32_t count;
    std::uint32_t subcluster;  ///< for whoever numbers the subclusters
  };
  /// What a row left behind; rows without a return leave nothing.
  struct RowRuns {
    std::uint32_t laser;
    std::uint32_t first_column;
    std::uint32_t first_cell;  ///< that of first_column
    std::uint32_t first_run;
    std::uint32_t count;
  };

  std::vector<std::uint32_t> source_index;  ///< of each cell of the rows with returns
  std::vector<Run> runs;
  std::vector<RowRuns> rows;
  std::size_t returns = 0;

  /// Forgets all. Keeps its memory.
  void clear();

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// The run of a cell of a row, kNone if it is no return.
  /// \param column within the row
  std::uint32_t runAt(const RowRuns& row, std::uint32_t column) const;

  /// Cuts a row where measured.starts says so. Each run is a new set of the subclusters, from first_element on.
  /// \param measured receives the run of each return
  void add(const Row& row, MeasuredRow& measured, std::size_t laser, std::uint32_t first_column, std::size_t columns,
           std::uint32_t first_element, DisjointSets& subclusters);
};

/// The rows of several parts by laser, those of one laser as they came, the first part's first: the order in which an
/// organized cloud lies in memory.
class LaserOrder {
 public:
  struct Place {
    std::uint32_t part, row;
  };

  /// \param part_at callable as const Runs& (std::size_t part)
  template <typename PartAt>
  void sort(std::size_t parts, PartAt&& part_at) {
    first_.clear();
    std::size_t rows = 0;
    for (std::size_t part = 0; part < parts; ++part)
      for (const Runs::RowRuns& row : part_at(part).rows) {
        if (first_.size() < row.laser + std::size_t{2}) first_.resize(row.laser + std::size_t{2}, 0);
        ++first_[row.laser + 1];
        ++rows;
      }
    for (std::size_t laser = 1; laser < first_.size(); ++laser) first_[laser] += first_[laser - 1];
    places_.resize(rows);
    for (std::size_t part = 0; part < parts; ++part)
      for (std::size_t row = 0; row < part_at(part).rows.size(); ++row)
        places_[first_[part_at(part).rows[row].laser]++] = {static_cast<std::uint32_t>(part),
                                                            static_cast<std::uint32_t>(row)};
  }

  /// Calls visit(part, runs, run) for each run in this order, after sort ().
  template <typename PartAt, typename Visit>
  void forEachRun(PartAt&& part_at, Visit&& visit) const {
    for (const Place& place : places_) {
      const Runs& part = part_at(place.part);
      const Runs::RowRuns& row = part.rows[place.row];
      for (std::uint32_t run = row.first_run; run < row.first_run + row.count; ++run)
        visit(std::size_t{place.part}, part, part.runs[run]);
    }
  }

  const std::vector<Place>& places() const { return places_; }
  /// Where the rows of a laser are among the places, after sort ().
  std::size_t beginOf(std::size_t laser) const { return laser == 0 ? 0 : endOf(laser - 1); }
  std::size_t endOf(std::size_t laser) const { return laser < first_.size() ? first_[laser] : places_.size(); }

 private:
  std::vector<std::size_t> first_;  ///< place of each laser's next row: when sorted, that after its last
  std::vector<Place> places_;
};

}  // namespace lisco
