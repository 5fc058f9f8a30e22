// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/column_clusterer.h"

#include <algorithm>
#include <stdexcept>

#include "core/parallel.h"
#include "core/partition.h"
#include "core/rotation.h"
#include "core/run_selection.h"
#include "core/runs.h"
#include "core/simd.h"

namespace lisco {

// --- Algorithm 3 ----------------------------------------------------------------------------------------------------

namespace {

// In brackets, the section of benchmarks/suite.sh that shows the effect.

/// Cells of columns that come first and at once, from which on near returns are collected and sorted; of fewer they are
/// put into voxels, as are those of columns that follow (recordings).
constexpr std::size_t kWorthSorting = 256;
/// Columns that are read from their source; fewer are gathered into blocks, which evens out their work (latency).
constexpr std::size_t kWorthReadingAtOnce = 16;
/// Cells from which on several threads take less time than one (threads).
constexpr std::size_t kWorthThreads = 8192;
/// Runs that are requested ahead when all are numbered (stages).
constexpr std::uint32_t kPrefetchedRuns = 64;

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
  far_ = Far::kNone;
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

/// Several columns that are a whole block are read at once; others are gathered into blocks, whose work is spread.
void ColumnClusterer::Rotation::receiveInSequence(std::size_t columns, std::size_t lasers, const CellSource& cells,
                                                  const Return* column) {
  Partition& partition = lastPartition();
  for (std::size_t first = 0; first < columns;) {
    const std::size_t count = std::min(columns - first, scheduler_.columnsLeft());
    const bool is_block = (count > 1 && count == parameters_.block_columns) || count >= kWorthReadingAtOnce;
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
  inParallel(threads, [&](std::size_t thread) {
    for (std::size_t i = thread; i < overlaps_.size(); i += threads) {
      const Overlap& overlap = overlaps_[i];
      partitions_[first + thread].linkOverlap(partitions_[overlap.later], partitions_[overlap.earlier], overlap.ahead,
                                              subclusters_);
    }
    for (std::size_t i = 0; i < partition_count_; ++i) {
      const std::vector<RangeImage::Unplaced>& all = partitions_[i].image().unplaced;
      for (std::size_t k = thread; k < all.size(); k += threads)
        images_.forEachAround(all[k], [&](std::size_t other) {
          if (std::max(i, other) >= first) partitions_[other].linkUnplaced(all[k], subclusters_);
        });
    }
  });
  for (std::size_t i = 0; is_any_full && i < partition_count_; ++i) partitions_[i].stopPlacing();
}

/// Gives all range images with returns the same rows in one order, with elevations that hold for all.
void ColumnClusterer::Rotation::shareRows() {
  Partition* shared = nullptr;
  for (std::size_t i = 0; i < partition_count_; ++i) {
    if (partitions_[i].image().placed == 0) continue;
    if (shared == nullptr) shared = &partitions_[i];
    shared->mergeRows(partitions_[i]);
  }
  if (shared != nullptr) shared->sortLasers();
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
    for (std::uint32_t run = 0; run < count; ++run) {
      __builtin_prefetch(runs + run + kPrefetchedRuns, 1);
      runs[run].subcluster = numbering.numberOf(first + run, runs[run].count, subclusterOf);
    }
  }
  numbering.finish();
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
