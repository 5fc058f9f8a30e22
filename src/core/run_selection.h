// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/ring_block.h"
#include "lisco/return.h"

namespace lisco {

/// Visits runs, without those of subclusters whose sizes are not wanted, where leaving them out saves time.
class RunSelection {
 public:
  /// \param sizes wanted
  /// \param size_of the size of each subcluster
  /// \param runs number of runs of all subclusters
  RunSelection(const RunVisitor& visit, const SizeRange& sizes, const std::uint32_t* size_of, std::size_t subclusters,
               std::size_t runs)
      : visit_(visit), sizes_(sizes), size_of_(size_of), selects_(sizes.min > 1 && subclusters * kMaxRuns > runs) {}

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
