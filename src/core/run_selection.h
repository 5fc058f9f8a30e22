// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ring_block.h"
#include "core/runs.h"
#include "lisco/return.h"

namespace lisco {

/// Visits runs, without those of subclusters whose sizes are not wanted, where leaving them out saves time.
class RunSelection {
 public:
  /// \param sizes wanted
  /// \param size_of the size of each subcluster
  /// \param partitions those that have the runs
  /// \param runsOf callable as const Runs& (std::size_t partition)
  template <typename RunsOf>
  RunSelection(const RunVisitor& visit, const SizeRange& sizes, const std::vector<std::uint32_t>& size_of,
               std::size_t partitions, RunsOf&& runsOf)
      : visit_(visit), sizes_(sizes), size_of_(size_of.data()) {
    std::size_t runs = 0;
    for (std::size_t i = 0; i < partitions; ++i) runs += runsOf(i).run_count;
    selects_ = sizes.min > 1 && size_of.size() * kMaxRuns > runs;
  }

  /// Visits a block's runs that are wanted; perhaps others, too.
  void visit(RunVisitor::From from, RunBlock block) const {
    if (!selects_) return visit_(from, block);
    Run selected[RingBlock::kColumns];
    std::size_t count = 0;
    for (std::size_t i = 0; i < block.count; ++i) {
      const std::uint32_t size = size_of_[block.runs[i].subcluster];
      selected[count] = block.runs[i];
      count += static_cast<std::size_t>(size >= sizes_.min) & static_cast<std::size_t>(size <= sizes_.max);
    }
    block.runs = selected;
    block.count = count;
    visit_(from, block);
  }

 private:
  /// Runs of a subcluster, in the mean, up to which those not wanted are left out: then most subclusters are of one
  /// return (benchmarks/suite.sh latency).
  static constexpr std::size_t kMaxRuns = 3;

  const RunVisitor& visit_;
  const SizeRange& sizes_;
  const std::uint32_t* size_of_;
  bool selects_;
};

}  // namespace lisco
