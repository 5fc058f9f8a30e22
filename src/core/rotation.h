// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/block_scheduler.h"
#include "core/disjoint_sets.h"
#include "core/far/image_circle.h"
#include "core/far_history.h"
#include "core/far_trial.h"
#include "core/laser_order.h"
#include "core/load_balancer.h"
#include "core/near/voxel_sorter.h"
#include "core/partition.h"
#include "core/runs.h"
#include "core/unordered_returns.h"
#include "lisco/column_clusterer.h"

namespace lisco {

/// One rotation: Algorithm 3 of the paper, with a partition of the columns for each thread. All partitions share one
/// forest of subclusters.
class ColumnClusterer::Rotation {
 public:
  /// subclusters = {}
  void begin(const Parameters& parameters);
  /// Event "reception of step s", for several steps.
  /// \param column if there is one column: its cells, contiguous; else nullptr
  void receive(std::size_t columns, std::size_t lasers, const CellSource& cells, const Return* column = nullptr);
  /// Event "all steps processed".
  void update();

  bool isUsable() const { return usable_; }
  void checkUsable() const {
    if (!usable_) throw std::logic_error("lisco::ColumnClusterer: a column before begin (), or after an exception");
  }
  std::size_t subclusterCount() const { return sizes_.size(); }
  const std::uint32_t* sizes() const { return sizes_.data(); }
  std::size_t returnCount() const;
  std::uint32_t subclusterAt(std::size_t laser, std::size_t column);
  std::size_t threadCount() const { return parts_.empty() ? 1 : parts_.size(); }
  void visitRuns(const RunVisitor& visit, const SizeRange& sizes, bool from_both_ends);

 private:
  // Columns that come at once: columns_at_once.cpp.
  void receiveAtOnce(std::size_t columns, std::size_t lasers, const CellSource& cells);
  template <typename Read>
  void readInParallel(Read&& read);
  void preparePart(std::size_t i, const SensorHints& hints, std::size_t columns, std::size_t capacity = 0);
  bool readFarAndNear(std::size_t lasers, const CellSource& cells);
  void readPart(std::size_t i, std::size_t lasers, const CellSource& cells, FarTrial& trial);
  void reserveNear(Partition& partition, std::size_t columns);
  void readNear(std::size_t lasers, const CellSource& cells);
  void readUnordered(std::size_t lasers, const CellSource& cells);
  void recordFar();

  // The other steps: column_clusterer.cpp.
  void divide(std::size_t columns, std::size_t lasers, const CellSource& cells);
  void prepareForColumns();
  void reserveRuns(Partition& partition);
  void receiveInSequence(std::size_t columns, std::size_t lasers, const CellSource& cells, const Return* column);
  void linkPartitions();
  void linkImages(std::size_t first);
  void shareRows();
  void linkCollected();
  void stopCollecting();
  void numberSubclusters();
  void sortRuns();
  void usePartitions(std::size_t count);
  /// The partition that columns are added to one by one.
  Partition& lastPartition() { return partitions_[partition_count_ - 1]; }
  const Runs& runsOf(std::size_t partition) const { return partitions_[partition].runs; }

  /// Columns that a range image is prepared for when their number is unknown: it needs no more bins than a turn has.
  static constexpr std::size_t kWholeTurn = ~std::size_t{0};

  Parameters parameters_;
  Tolerance tolerance_;
  bool usable_ = false;       ///< begun, and left by no exception since
  std::size_t cells_ = 0;     ///< received since begin ()
  DisjointSets subclusters_;  ///< of runs
  std::vector<Partition> partitions_;
  std::size_t partition_count_ = 0;        ///< in use; 0: not divided yet
  std::vector<LoadBalancer::Part> parts_;  ///< of the threads
  bool comes_at_once_ = false;             ///< the latest columns, of this rotation or the one before
  bool is_prepared_ = false;               ///< the last partition, for columns that follow
  struct NearReturnsOf {                   ///< some columns
    std::size_t returns, columns;
    std::size_t expectedIn(std::size_t other_columns) const { return returns * other_columns / columns; }
  };
  NearReturnsOf tried_near_{};  ///< of this rotation's trial; {0, 0}: none
  bool are_linked_ = false;     ///< all partitions but the last, with each other
  enum class Near { kCollected, kSorted, kInVoxels } near_ = Near::kInVoxels;  ///< state of the near returns
  bool is_unordered_ = false;  ///< all returns are in unordered_, near and collected or sorted; partitions are empty
  UnorderedReturns unordered_;
  ImageCircle images_;
  struct Overlap {
    std::size_t later, earlier;  ///< partitions
    double ahead;                ///< see SegmentLinker::forEachOverlap
  };
  std::vector<Overlap> overlaps_;  ///< of range images
  VoxelSorter sorter_;
  std::vector<const NearReturns*> near_returns_;
  /// How the far returns of this rotation are read, until recordFar ().
  enum class Far {
    kNone,      ///< they cannot be worth range images
    kRefused,   ///< the trial has refused range images
    kInImages,  ///< in range images
    kLeftOut    ///< without range images or a trial, as those of the rotations before were not worth it
  } far_ = Far::kNone;
  FarHistory far_history_;
  bool is_sorter_grown_ = false;  ///< by rotations without range images, since some had them
  LoadBalancer balancer_;
  BlockScheduler scheduler_;
  std::vector<std::uint32_t> sizes_;  ///< of subclusters
  LaserOrder order_;
  bool is_sorted_ = false;  ///< order_, since the last update ()
};

}  // namespace lisco
