// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "core/ring_block.h"
#include "lisco/return.h"

namespace lisco {

/// The ring blocks of several partitions by laser, those of one laser by column: the order in which an organized cloud
/// lies in memory.
class LaserOrder {
 public:
  struct Entry {
    std::uint32_t partition, block;
  };

  /// \param runs_of callable as const Runs& (std::size_t partition), or as another type whose blocks have a laser
  template <typename RunsOf>
  void sort(std::size_t partitions, RunsOf&& runs_of) {
    end_.clear();
    std::size_t blocks = 0;
    for (std::size_t partition = 0; partition < partitions; ++partition)
      for (const auto& block : runs_of(partition).blocks) {
        if (end_.size() < block.laser + std::size_t{2}) end_.resize(block.laser + std::size_t{2}, 0);
        ++end_[block.laser + 1];
        ++blocks;
      }
    for (std::size_t laser = 1; laser < end_.size(); ++laser) end_[laser] += end_[laser - 1];
    entries_.resize(blocks);
    for (std::size_t partition = 0; partition < partitions; ++partition)
      for (std::size_t block = 0; block < runs_of(partition).blocks.size(); ++block)
        entries_[end_[runs_of(partition).blocks[block].laser]++] = {static_cast<std::uint32_t>(partition),
                                                                    static_cast<std::uint32_t>(block)};
  }

  /// Calls visit(from, partition, runs, block) for each ring block in this order, after sort (); from both ends, by a
  /// thread from each until they meet.
  template <typename RunsOf, typename Visit>
  void forEachBlock(bool from_both_ends, RunsOf&& runs_of, Visit&& visit) const {
    const auto visit_entry = [&](RunVisitor::From from, const Entry& entry) {
      const auto& runs = runs_of(entry.partition);
      visit(from, std::size_t{entry.partition}, runs, runs.blocks[entry.block]);
    };
    if (!from_both_ends) {
      for (const Entry& entry : entries_) visit_entry(RunVisitor::From::kFirst, entry);
      return;
    }
    const std::size_t shares = (entries_.size() + kShare - 1) / kShare;
    std::atomic<std::size_t> taken = 0;
    inParallel(2, [&](std::size_t end) {
      for (std::size_t i = 0; taken.fetch_add(1, std::memory_order_relaxed) < shares; ++i) {
        const std::size_t first = (end == 0 ? i : shares - 1 - i) * kShare;
        const std::size_t last = std::min(first + kShare, entries_.size());
        if (end == 0)
          for (std::size_t entry = first; entry < last; ++entry) visit_entry(RunVisitor::From::kFirst, entries_[entry]);
        else
          for (std::size_t entry = last; entry-- > first;) visit_entry(RunVisitor::From::kLast, entries_[entry]);
      }
    });
  }

  /// The block that covers a column of a laser, after sort (). \return false if there is none
  template <typename RunsOf>
  bool find(std::size_t laser, std::size_t column, RunsOf&& runs_of, Entry& found) const {
    const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(laser == 0 ? 0 : endOf(laser - 1));
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(endOf(laser));
    const auto firstColumnOf = [&](const Entry& entry) {
      return std::size_t{runs_of(entry.partition).blocks[entry.block].first_column};
    };
    const auto after = std::upper_bound(
        begin, end, column, [&](std::size_t wanted, const Entry& entry) { return wanted < firstColumnOf(entry); });
    if (after == begin || column - firstColumnOf(*(after - 1)) >= RingBlock::kColumns) return false;
    found = *(after - 1);
    return true;
  }

 private:
  /// Blocks that a thread takes at a time: taking one by one costs more than visiting them where cores are far apart
  /// (benchmarks/suite.sh threads).
  static constexpr std::size_t kShare = 32;

  std::size_t endOf(std::size_t laser) const { return laser < end_.size() ? end_[laser] : entries_.size(); }

  std::vector<std::size_t> end_;  ///< after sort (): behind each laser's last entry
  std::vector<Entry> entries_;
};

}  // namespace lisco
