// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/runs.h"

#include <algorithm>

namespace lisco {

void Runs::clear() {
  source_index.clear();
  runs.clear();
  rows.clear();
  returns = 0;
}

void Runs::add(const Row& row, MeasuredRow& measured, std::size_t laser, std::uint32_t first_column,
               std::size_t columns, std::uint32_t first_element, DisjointSets& subclusters) {
  const auto first_run = static_cast<std::uint32_t>(runs.size());
  const auto first_cell = static_cast<std::uint32_t>(source_index.size());
  const std::size_t last_run = first_run + static_cast<std::size_t>(__builtin_popcountll(measured.starts));
  subclusters.grow(first_element + last_run);
  runs.resize(last_run);
  source_index.insert(source_index.end(), row.source_index, row.source_index + columns);
  returns += static_cast<std::size_t>(__builtin_popcountll(measured.returns));
  const std::uint64_t ends = ~measured.returns | measured.starts;
  std::uint32_t number = first_run;
  for (std::uint64_t starts = measured.starts; starts != 0; starts &= starts - 1, ++number) {
    const auto begin = static_cast<std::uint32_t>(__builtin_ctzll(starts));
    const std::uint64_t after = begin == Row::kColumns - 1 ? 0 : ends & ~std::uint64_t{0} << (begin + 1);
    const std::uint32_t end = after != 0 ? static_cast<std::uint32_t>(__builtin_ctzll(after)) : Row::kColumns;
    const std::uint32_t element = first_element + number;
    subclusters.create(element);
    for (std::uint32_t i = begin; i < end; ++i) measured.run[i] = element;
    runs[number] = {first_cell + begin, end - begin, 0};
  }
  rows.push_back({static_cast<std::uint32_t>(laser), first_column, first_cell, first_run, number - first_run});
}

std::uint32_t Runs::runAt(const RowRuns& row, std::uint32_t column) const {
  const std::uint32_t cell = row.first_cell + column;
  const auto begin = runs.begin() + row.first_run;
  const auto after = std::upper_bound(begin, begin + row.count, cell,
                                      [](std::uint32_t wanted, const Run& run) { return wanted < run.first_cell; });
  if (after == begin || cell >= (after - 1)->first_cell + (after - 1)->count) return kNone;
  return static_cast<std::uint32_t>(after - 1 - runs.begin());
}

}  // namespace lisco
