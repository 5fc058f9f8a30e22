// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/runs.h"

#include <algorithm>
#include <numeric>

#include "core/bits.h"

namespace lisco {

void Runs::clear() {
  source_index.clear();
  run_count = 0;
  blocks.clear();
  returns = 0;
}

void Runs::add(const RingBlock& block, RingBlockInfo& info, std::size_t laser, std::uint32_t first_column,
               std::size_t columns, std::uint32_t first_element, DisjointSets& subclusters) {
  const auto first_run = static_cast<std::uint32_t>(run_count);
  const auto first_cell = static_cast<std::uint32_t>(source_index.size());
  const std::uint32_t end_run = first_run + countBits(info.starts);
  subclusters.grow(first_element + end_run);
  runs.growInSteps(end_run);
  if (keeps_source_indices) source_index.insert(source_index.end(), block.source_index, block.source_index + columns);
  returns += countBits(info.returns);
  std::uint32_t number = first_run;
  if (info.starts == info.returns) {  // runs of one return, as in unordered clouds
    subclusters.create(first_element + first_run, first_element + end_run);
    forEachChain(info.returns & ~(info.returns << 1), info.returns, [&](std::size_t begin, std::size_t end) {
      const auto count = static_cast<std::uint32_t>(end - begin);
      const auto cell = first_cell + static_cast<std::uint32_t>(begin);
      std::iota(info.run + begin, info.run + end, first_element + number);
      Run* const chain = runs.data() + number;
      for (std::uint32_t i = 0; i < count; ++i) chain[i] = {cell + i, 1, 0};
      number += count;
    });
  } else {
    forEachChain(info.starts, info.returns, [&](std::size_t begin, std::size_t end) {
      const std::uint32_t element = first_element + number;
      subclusters.create(element);
      // The next run overwrites what is written behind the end.
      for (std::size_t i = begin; i < end; i += RingBlockInfo::kFillStep)
        std::fill_n(info.run + i, RingBlockInfo::kFillStep, element);
      runs[number++] = {first_cell + static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin), 0};
    });
  }
  run_count = end_run;
  blocks.push_back({static_cast<std::uint32_t>(laser), first_column, first_cell, first_run, end_run - first_run});
}

std::uint32_t Runs::runAt(const Block& block, std::uint32_t column) const {
  const std::uint32_t cell = block.first_cell + column;
  const Run* const begin = runs.data() + block.first_run;
  const Run* const after = std::upper_bound(
      begin, begin + block.count, cell, [](std::uint32_t wanted, const Run& run) { return wanted < run.first_cell; });
  if (after == begin || cell >= (after - 1)->first_cell + (after - 1)->count) return kNone;
  return static_cast<std::uint32_t>(after - 1 - runs.data());
}

}  // namespace lisco
