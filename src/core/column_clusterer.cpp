// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/column_clusterer.h"

#include <algorithm>
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
#include "core/parallel.h"
#include "core/partition.h"
#include "core/run_selection.h"
#include "core/runs.h"
#include "core/simd.h"
#include "core/unordered_returns.h"

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
  void divide(std::size_t columns, std::size_t lasers, const CellSource& cells);
  void receiveAtOnce(std::size_t columns, std::size_t lasers, const CellSource& cells);
  template <typename Read>
  void readInParallel(Read&& read);
  void preparePart(std::size_t i, const SensorHints& hints, std::size_t columns, std::size_t capacity = 0);
  bool readFarAndNear(std::size_t lasers, const CellSource& cells);
  void readPart(std::size_t i, std::size_t lasers, const CellSource& cells, FarTrial& trial);
  void reserveRuns(Partition& partition);
  void reserveNear(Partition& partition, std::size_t columns);
  void readNear(std::size_t lasers, const CellSource& cells);
  void readUnordered(std::size_t lasers, const CellSource& cells);
  void prepareForColumns();
  void receiveInSequence(std::size_t columns, std::size_t lasers, const CellSource& cells, const Return* column);
  void linkPartitions();
  void recordFar();
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
  enum class Far { kNone, kRefused, kInImages, kRests } far_ = Far::kNone;  ///< see recordFar ()
  FarHistory far_history_;
  LoadBalancer balancer_;
  BlockScheduler scheduler_;
  std::vector<std::uint32_t> sizes_;  ///< of subclusters
  LaserOrder order_;
  bool is_sorted_ = false;  ///< order_, since the last update ()
};

// --- Algorithm 3 ----------------------------------------------------------------------------------------------------

namespace {

// In brackets, the section of benchmarks/suite.sh that shows the effect.

/// Cells of columns that come first and at once, from which on near returns are collected and sorted; of fewer they are
/// put into voxels, as are those of columns that follow (recordings).
constexpr std::size_t kWorthSorting = 256;
/// Columns of these on which the work of far returns is measured. Fewer: a worse estimate; more: a later change
/// (recordings).
constexpr std::size_t kTriedColumns = 128;
static_assert(kTriedColumns % RingBlock::kColumns == 0, "whole blocks are read");
/// Times the worthwhile work of far returns up to which the trial accepts them, as other columns may differ, and from
/// which on it ends before its last column. More: clouds without range images wait for it (recordings, layouts).
constexpr double kMostInTrial = 2.0, kClearlyTooMuch = 6.0;
/// SensorHints::drift from which on returns leave their expected bins too often: of clouds that are motion-compensated.
/// The first columns do not show it, as the motion grows from there. At rest 0.05, up to 0.8 in a vehicle's frame; in
/// motion 1 to 20 (recordings).
constexpr float kMaxDrift = 1.25F;
/// Turns of columns from which on many bins have been taken by the turn before.
constexpr double kMaxTurns = 1.5;
/// Columns that a range image is prepared for when their number is unknown: it needs no more bins than a turn has.
constexpr std::size_t kWholeTurn = ~std::size_t{0};
/// Columns that are read from their source; fewer are gathered into blocks, which evens out their work (latency).
constexpr std::size_t kWorthReadingAtOnce = 16;
/// Cells from which on several threads take less time than one (threads).
constexpr std::size_t kWorthThreads = 8192;

}  // namespace

void ColumnClusterer::Rotation::begin(const Parameters& parameters) {
  if (!usable_) *this = Rotation();
  usable_ = false;
  parameters_ = parameters;
  parameters_.block_columns = std::clamp<std::size_t>(parameters.block_columns, 1, RingBlock::kColumns);
  parameters_.threads = std::min(parameters.threads == 0 ? allThreads() : parameters.threads, Parameters::kMaxThreads);
  tolerance_ = Tolerance(parameters.tolerance);
  cells_ = partition_count_ = 0;
  parts_.clear();
  are_linked_ = is_sorted_ = is_unordered_ = false;
  near_ = Near::kInVoxels;
  sizes_.clear();
  scheduler_.begin(parameters_.block_columns);
  is_prepared_ = false;
  if (parameters_.threads == 1 && !comes_at_once_) {
    usePartitions(1);
    prepareForColumns();  // here, so that the first column costs no more than the rest
  }
  usable_ = true;
}

void ColumnClusterer::Rotation::receive(std::size_t columns, std::size_t lasers, const CellSource& cells,
                                        const Return* column) {
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::ColumnClusterer: a column of more cells than lasers were declared");
  if (columns > kMaxCells || lasers > kMaxCells || columns * lasers > kMaxCells - cells_)
    throw std::invalid_argument("lisco::ColumnClusterer: more than 2^31 - 1 cells since begin ()");
  if (columns == 0) return;
  usable_ = false;
  cells_ += columns * lasers;
  if (partition_count_ == 0) divide(columns, lasers, cells);
  const bool is_whole = columns >= kWorthReadingAtOnce && columns * lasers >= kWorthSorting;
  comes_at_once_ = !scheduler_.hasColumns() && (is_whole || partition_count_ > 1);
  if (comes_at_once_) {
    receiveAtOnce(columns, lasers, cells);
  } else {
    prepareForColumns();
    receiveInSequence(columns, lasers, cells, column);
  }
  usable_ = true;
}

void ColumnClusterer::Rotation::update() {
  usable_ = is_sorted_ = false;
  if (partition_count_ > 0) {
    scheduler_.finish(lastPartition(), subclusters_);
    linkPartitions();
  }
  recordFar();
  numberSubclusters();
  usable_ = true;
}

// --- Its steps ------------------------------------------------------------------------------------------------------

/// Divides the columns among threads, if there are enough of them.
void ColumnClusterer::Rotation::divide(std::size_t columns, std::size_t lasers, const CellSource& cells) {
  if (parameters_.threads > 1 && columns * lasers >= kWorthThreads)
    balancer_.divide(columns, lasers, cells, parameters_.threads, parts_);
  else
    parts_.resize(1);
  usePartitions(parts_.size());
  for (std::size_t i = 1; i < partition_count_; ++i)
    partitions_[i].first_element = static_cast<std::uint32_t>(lasers * parts_[i].first);  // at most a run for each cell
}

/// Columns that come at once are read with their far returns in range images, if these prove worthwhile. If not, or if
/// azimuths drift (SensorHints::drift), or if there are several turns, all returns are near: collected with their runs,
/// or without runs if they are unordered.
void ColumnClusterer::Rotation::receiveAtOnce(std::size_t columns, std::size_t lasers, const CellSource& cells) {
  if (partition_count_ == 1) parts_.assign(1, {0, columns});
  near_ = Near::kCollected;
  is_prepared_ = false;
  tried_near_ = {0, 0};
  scheduler_.skipColumns(columns);
  if (partition_count_ > 1) subclusters_.reserve(lasers * columns + RingBlock::kColumns, NewPages::kUntouched);
  const SensorHints& sensor = parameters_.sensor;
  const bool repeats = static_cast<double>(columns) > kMaxTurns * static_cast<double>(sensor.steps_per_turn);
  const bool may_have_far = sensor.steps_per_turn != 0 && !repeats && sensor.drift <= kMaxDrift;
  far_ = Far::kNone;
  if (may_have_far && !far_history_.begin({columns, lasers, parameters_.tolerance}))
    far_ = Far::kRests;
  else if (may_have_far && readFarAndNear(lasers, cells))
    return;
  if (UnorderedReturns::isUnordered(columns, lasers, cells, tolerance_))
    readUnordered(lasers, cells);
  else
    readNear(lasers, cells);
}

/// Calls read (i) for each part by a thread of its own, and records its time, which sets its later shares.
template <typename Read>
void ColumnClusterer::Rotation::readInParallel(Read&& read) {
  inParallel(partition_count_, [&](std::size_t i) {
    if (partition_count_ == 1) return read(i);
    balancer_.time(i, [&] { read(i); });
  });
}

void ColumnClusterer::Rotation::preparePart(std::size_t i, const SensorHints& hints, std::size_t columns,
                                            std::size_t capacity) {
  partitions_[i].prepare(tolerance_, hints, columns, capacity);
  partitions_[i].collectNear();
}

/// Each thread reads its part of the columns, and links its far returns among themselves. Near returns are collected.
/// \return false, with part of it read, if there are no far returns, or linking those of the first columns takes longer
///         than sorting them
bool ColumnClusterer::Rotation::readFarAndNear(std::size_t lasers, const CellSource& cells) {
  for (std::size_t i = 0; i < partition_count_; ++i) partitions_[i].takeBackImageMemory();
  partitions_.front().takeLargerMemory(unordered_.memory());  // not in use before the trial ends
  const bool is_new = !partitions_.front().hasMemory();
  FarTrial trial;
  readInParallel([&](std::size_t i) {
    try {
      const std::size_t all = parts_[i].end - parts_[i].first;
      const std::size_t expected = partition_count_ > 1 ? all : std::min(kTriedColumns, all);
      // After a refused trial, the next one takes no more memory than it needs. Other columns may follow these.
      const auto has_memory_for = [&](std::size_t columns) {
        return partitions_[i].hasMemoryFor(lasers, columns, parameters_.sensor);
      };
      const std::size_t capacity = has_memory_for(kWholeTurn)      ? kWholeTurn
                                   : is_new || has_memory_for(all) ? all
                                                                   : expected;
      preparePart(i, parameters_.sensor, expected, capacity);
      if (partitions_[i].hasFar())
        readPart(i, lasers, cells, trial);
      else
        trial.decide(false);
    } catch (...) {
      if (i == 0) trial.decide(true);  // the others wait for it
      throw;
    }
  });
  const bool is_worthwhile = trial.await();
  if (partitions_.front().hasFar()) far_ = is_worthwhile ? Far::kInImages : Far::kRefused;
  if (!is_worthwhile && is_new) partitions_.front().shrinkMemory();
  return is_worthwhile;
}

/// Makes room for the near returns of some columns: half of what the trial predicts, as scenes differ around the
/// sensor.
void ColumnClusterer::Rotation::reserveNear(Partition& partition, std::size_t columns) {
  if (tried_near_.columns > 0) partition.reserveNear(tried_near_.expectedIn(columns) / 2 + 2 * RingBlock::kColumns);
}

/// Each thread reads its part of the columns, without far returns.
void ColumnClusterer::Rotation::readNear(std::size_t lasers, const CellSource& cells) {
  readInParallel([&](std::size_t i) {
    Partition& partition = partitions_[i];
    if (far_ == Far::kRests) partition.lendImageMemory();
    preparePart(i, SensorHints(), 0);
    const auto [begin, end] = parts_[i];
    reserveRuns(partition);
    reserveNear(partition, end - begin);
    partition.readLasers(cells, begin, end, lasers, subclusters_);
    if (partition_count_ > 1) balancer_.record(begin, end - begin, (end - begin) * lasers + partition.workDone());
  });
}

/// The same without runs.
void ColumnClusterer::Rotation::readUnordered(std::size_t lasers, const CellSource& cells) {
  partitions_.front().leaveLargerMemory(unordered_.memory());  // which the trial has used
  unordered_.begin(partition_count_);
  readInParallel([&](std::size_t i) {
    const auto [begin, end] = parts_[i];
    unordered_.readPart(i, cells, begin, end, lasers);
    if (partition_count_ > 1) balancer_.record(begin, end - begin, (end - begin) * lasers);
  });
  is_unordered_ = true;
  usePartitions(1);
  lastPartition().prepare(tolerance_, SensorHints(), 0);
}

/// Reads a part block by block, and links its far returns, until the trial refuses them.
void ColumnClusterer::Rotation::readPart(std::size_t i, std::size_t lasers, const CellSource& cells, FarTrial& trial) {
  Partition& partition = partitions_[i];
  const auto [begin, end] = parts_[i];
  const std::size_t middle = begin + (end - begin) / 2;
  const std::size_t tried = std::min(kTriedColumns, end);
  if (i > 0) reserveRuns(partition);  // of the first part after its trial, which may refuse it
  for (std::size_t first = begin; first < end; first += RingBlock::kColumns) {
    if (trial.isRefused()) return;
    const std::size_t count = std::min(end - first, RingBlock::kColumns);
    const std::size_t before = partition.workDone();
    partition.readColumns(cells, first, count, lasers, static_cast<std::uint32_t>(first), subclusters_);
    if (partition_count_ > 1) balancer_.record(first, count, count * lasers + partition.workDone() - before);
    const auto isWorthwhile = [&](double most) {
      return partition.runs.returns == 0 || partition.farWork().isImageWorthwhile(most);
    };
    if (i == 0 && first + count < tried && !isWorthwhile(kClearlyTooMuch)) return trial.decide(false);
    if (i == 0 && first + count == tried) {
      const bool is_worthwhile = isWorthwhile(kMostInTrial);
      trial.decide(is_worthwhile);
      tried_near_ = {is_worthwhile ? partition.nearReturns().count : partition.runs.returns, first + count};
      if (!is_worthwhile) return;
      partition.expectColumns(end - begin);
      reserveRuns(partition);
      reserveNear(partition, end - begin);
    }
    if (first < middle && first + count >= middle && first + count < end) {  // the rest is likely to have as many
      const NearReturnsOf read{partition.nearReturns().count, first + count - begin};
      partition.reserveNear(read.expectedIn(end - begin) + 2 * RingBlock::kColumns);
    }
  }
}

/// Prepares the last partition for columns of which not all are known.
void ColumnClusterer::Rotation::prepareForColumns() {
  if (is_prepared_) return;
  is_prepared_ = true;
  if (scheduler_.hasColumns()) {
    stopCollecting();
    lastPartition().expectColumns(kWholeTurn);
  } else {
    lastPartition().prepare(tolerance_, parameters_.sensor, kWholeTurn);
    reserveRuns(lastPartition());
  }
}

/// Whole blocks of columns are read at once; single columns are gathered into blocks, whose work is spread.
void ColumnClusterer::Rotation::receiveInSequence(std::size_t columns, std::size_t lasers, const CellSource& cells,
                                                  const Return* column) {
  Partition& partition = lastPartition();
  for (std::size_t first = 0; first < columns;) {
    const std::size_t count = std::min(columns - first, scheduler_.columnsLeft());
    const bool is_block = count == parameters_.block_columns || count >= kWorthReadingAtOnce;
    if (scheduler_.isStageEmpty() && is_block) {
      scheduler_.finishPending(partition, subclusters_);
      partition.readColumns(cells, first, count, lasers, scheduler_.columnsRead(), subclusters_);
      scheduler_.skipColumns(count);
    } else if (column != nullptr) {
      scheduler_.add(column, lasers, partition, subclusters_);
    } else {
      scheduler_.add(cells, first, count, lasers, partition, subclusters_);
    }
    first += count;
  }
}

/// Links each partition within, by a thread of its own, then with the others.
void ColumnClusterer::Rotation::linkPartitions() {
  // Partitions share subclusters once they are linked with each other; only the last one receives more columns then.
  linkCollected();
  const std::size_t first = are_linked_ ? partition_count_ - 1 : 0;
  are_linked_ = true;
  subclusters_.share(partition_count_ - first > 1);  // near returns have joined sets of different partitions
  inParallel(partition_count_ - first, [&](std::size_t i) { partitions_[first + i].linkWithin(subclusters_); });
  linkImages(first);
  subclusters_.share(false);
  lastPartition().markLinked();  // the others have no voxels: see stopCollecting ()
}

/// Adds a rotation that came at once, and whose returns might be far, to the history.
void ColumnClusterer::Rotation::recordFar() {
  if (comes_at_once_ && far_ != Far::kNone) {
    FarHistory::Content content{returnCount(), 0};
    FarWork work;
    for (std::size_t i = 0; i < partition_count_; ++i) {
      content.runs += runsOf(i).run_count;
      work += partitions_[i].farWork();
    }
    if (far_ == Far::kRests)
      far_history_.recordRest(content);
    else
      far_history_.recordImages(far_ == Far::kInImages && work.isImageWorthwhile(), content);
  }
  far_ = Far::kNone;
}

/// Links far returns of different partitions and across the seam, of pairs with a partition from `first` on. As many
/// threads share the overlaps of images in each other's reach, and the unplaced returns, each of which is compared with
/// the images around it.
void ColumnClusterer::Rotation::linkImages(std::size_t first) {
  images_.assign(partition_count_, [&](std::size_t i) -> const RangeImage& { return partitions_[i].image(); });
  overlaps_.clear();
  const auto addOverlaps = [&](std::size_t later, std::size_t earlier) {
    if (later < first) return;
    partitions_[later].forEachOverlap(partitions_[earlier], [&](double ahead) {
      overlaps_.push_back({later, earlier, ahead});
    });
  };
  images_.forEachPair(addOverlaps);
  for (std::size_t i = first; i < partition_count_; ++i) addOverlaps(i, i);
  shareRows();
  bool is_any_full = false;
  bool is_any_unplaced = false;
  for (std::size_t i = 0; i < partition_count_; ++i) {
    is_any_full = is_any_full || partitions_[i].image().isFull();
    is_any_unplaced = is_any_unplaced || !partitions_[i].image().unplaced.empty();
  }
  const std::size_t threads = overlaps_.empty() && !is_any_unplaced ? 0 : partition_count_ - first;
  const std::size_t parts = threads > 1 ? 2 : 1;  // of each overlap: their work differs
  inParallel(threads, [&](std::size_t thread) {
    for (std::size_t i = thread; i < overlaps_.size() * parts; i += threads) {
      const Overlap& overlap = overlaps_[i / parts];
      partitions_[first + thread].linkOverlap(partitions_[overlap.later], partitions_[overlap.earlier], overlap.ahead,
                                              i % parts, parts, subclusters_);
    }
    for (std::size_t i = thread; i < partition_count_; i += threads)
      for (const RangeImage::Unplaced& unplaced : partitions_[i].image().unplaced)
        images_.forEachAround(unplaced, [&](std::size_t other) {
          if (std::max(i, other) >= first) partitions_[other].linkUnplaced(unplaced, subclusters_);
        });
  });
  for (std::size_t i = 0; is_any_full && i < partition_count_; ++i) partitions_[i].stopPlacing();
}

/// Gives all range images with returns the same rows, with elevations that hold for all.
void ColumnClusterer::Rotation::shareRows() {
  Partition* shared = nullptr;
  for (std::size_t i = 0; i < partition_count_; ++i) {
    if (partitions_[i].image().placed == 0) continue;
    if (shared == nullptr) shared = &partitions_[i];
    shared->shareRows(partitions_[i]);
  }
  for (std::size_t i = 0; i < partition_count_; ++i) {
    if (partitions_[i].image().placed == 0) continue;
    partitions_[i].shareRows(*shared);
    partitions_[i].updateElevations();
  }
}

/// Links collected near returns, of all partitions at once; in voxels, if they cannot be sorted.
void ColumnClusterer::Rotation::linkCollected() {
  if (near_ != Near::kCollected) return;
  if (is_unordered_) {
    if (unordered_.link(sorter_, tolerance_, sizes_))
      near_ = Near::kSorted;
    else
      stopCollecting();
    return;
  }
  near_returns_.clear();
  for (std::size_t i = 0; i < partition_count_; ++i) near_returns_.push_back(&partitions_[i].nearReturns());
  if (sorter_.link(near_returns_, tolerance_, subclusters_))
    near_ = Near::kSorted;
  else
    stopCollecting();
}

/// Puts all near returns into the voxels of the last partition, which receives the columns that follow.
void ColumnClusterer::Rotation::stopCollecting() {
  if (near_ == Near::kInVoxels) return;
  if (is_unordered_) {
    is_unordered_ = false;
    unordered_.moveTo(lastPartition(), subclusters_);
    near_ = Near::kInVoxels;
    return;
  }
  for (std::size_t i = 0; i < partition_count_; ++i) lastPartition().takeCollected(partitions_[i], subclusters_);
  if (near_ == Near::kSorted) lastPartition().markLinked();
  near_ = Near::kInVoxels;
}

/// Numbers the subclusters by their first runs.
void ColumnClusterer::Rotation::numberSubclusters() {
  if (is_unordered_) return;  // numbered when they were linked
  SetNumbering numbering(subclusters_, sizes_);
  for (std::size_t i = 0; i < partition_count_; ++i)
    numbering.addRoots(partitions_[i].first_element, runsOf(i).run_count);
  for (std::size_t i = 0; i < partition_count_; ++i) {
    Run* const runs = partitions_[i].runs.runs.data();
    const std::size_t count = partitions_[i].runs.run_count;
    const std::uint32_t first = partitions_[i].first_element;
    const auto subclusterOf = [&](std::uint32_t parent) {
      if (parent >= first) return runs[parent - first].subcluster;
      std::size_t owner = i - 1;
      while (parent < partitions_[owner].first_element) --owner;
      return runsOf(owner).runs[parent - partitions_[owner].first_element].subcluster;
    };
    for (std::uint32_t run = 0; run < count; ++run)
      runs[run].subcluster = numbering.numberOf(first + run, runs[run].count, subclusterOf);
  }
}

void ColumnClusterer::Rotation::usePartitions(std::size_t count) {
  if (partitions_.size() < count) partitions_.resize(count);
  partition_count_ = count;
  for (std::size_t i = 0; i < count; ++i) partitions_[i].runs.keeps_source_indices = parameters_.keep_source_indices;
}

/// Makes room for the runs of one of the partitions, which get equal shares of the returns expected.
void ColumnClusterer::Rotation::reserveRuns(Partition& partition) {
  if (parameters_.keep_source_indices)
    partition.runs.source_index.reserve(parameters_.expected_returns / partition_count_);
}

// --- Results --------------------------------------------------------------------------------------------------------

std::size_t ColumnClusterer::Rotation::returnCount() const {
  std::size_t count = is_unordered_ ? unordered_.count() : 0;
  for (std::size_t i = 0; i < partition_count_; ++i) count += runsOf(i).returns;
  return count;
}

void ColumnClusterer::Rotation::sortRuns() {
  if (is_sorted_) return;
  order_.sort(partition_count_, [this](std::size_t i) -> const Runs& { return runsOf(i); });
  is_sorted_ = true;
}

void ColumnClusterer::Rotation::visitRuns(const RunVisitor& visit, const SizeRange& sizes, bool from_both_ends) {
  if (!visit.takesPlaces() && !parameters_.keep_source_indices)
    throw std::logic_error("lisco::ColumnClusterer: source indices are not kept");
  if (is_unordered_) {
    unordered_.visit(sorter_, visit, from_both_ends);
    return;
  }
  sortRuns();
  const auto runs_of = [this](std::size_t i) -> const Runs& { return runsOf(i); };
  const RunSelection selection(visit, sizes, sizes_, partition_count_, runs_of);
  const auto visitBlock = [&](RunVisitor::From from, std::size_t, const Runs& runs, const Runs::Block& block) {
    selection.visit(from, runs.blockOf(block));
  };
  order_.forEachBlock(from_both_ends, runs_of, visitBlock);
}

std::uint32_t ColumnClusterer::Rotation::subclusterAt(std::size_t laser, std::size_t column) {
  if (is_unordered_) return unordered_.setAt(sorter_, laser, column);
  sortRuns();
  LaserOrder::Entry entry{};
  if (!order_.find(
          laser, column, [this](std::size_t i) -> const Runs& { return runsOf(i); }, entry))
    return kNone;
  const Runs& runs = runsOf(entry.partition);
  const Runs::Block& block = runs.blocks[entry.block];
  const std::uint32_t run = runs.runAt(block, static_cast<std::uint32_t>(column - block.first_column));
  return run == Runs::kNone ? kNone : runs.runs[run].subcluster;
}

// --- The public face ------------------------------------------------------------------------------------------------

ColumnClusterer::ColumnClusterer() : rotation_(std::make_unique<Rotation>()) {
  chooseSimdLevel();
}
ColumnClusterer::~ColumnClusterer() = default;
ColumnClusterer::ColumnClusterer(const ColumnClusterer& other)
    : rotation_(std::make_unique<Rotation>(*other.rotation_)) {}
ColumnClusterer& ColumnClusterer::operator=(const ColumnClusterer& other) {
  rotation_ = std::make_unique<Rotation>(*other.rotation_);  // first, so that it changes nothing if it fails
  return *this;
}

void ColumnClusterer::begin(const Parameters& parameters) {
  rotation_->begin(parameters);
}

void ColumnClusterer::addColumn(const Return* cells, std::size_t lasers) {
  const auto cell_at = [cells](std::size_t laser, std::size_t) { return cells[laser]; };
  rotation_->checkUsable();
  rotation_->receive(1, lasers, CellSource(cell_at), cells);
}

void ColumnClusterer::receive(std::size_t columns, std::size_t lasers, const CellSource& cells) {
  rotation_->checkUsable();
  rotation_->receive(columns, lasers, cells);
}

void ColumnClusterer::update() {
  if (rotation_->isUsable()) rotation_->update();
}

std::size_t ColumnClusterer::subclusterCount() const {
  return rotation_->subclusterCount();
}
const std::uint32_t* ColumnClusterer::sizes() const {
  return rotation_->sizes();
}
std::size_t ColumnClusterer::returnCount() const {
  return rotation_->returnCount();
}

std::uint32_t ColumnClusterer::subclusterAt(std::size_t laser, std::size_t column) {
  return rotation_->isUsable() ? rotation_->subclusterAt(laser, column) : kNone;
}

std::size_t ColumnClusterer::threadCount() const {
  return rotation_->threadCount();
}

void ColumnClusterer::visitRuns(const RunVisitor& visit, const SizeRange& sizes, bool from_both_ends) {
  if (rotation_->isUsable()) rotation_->visitRuns(visit, sizes, from_both_ends);
}

}  // namespace lisco
