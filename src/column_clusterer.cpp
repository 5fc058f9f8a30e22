// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/column_clusterer.h"

#include <stdexcept>
#include <utility>

namespace lisco {

void ColumnClusterer::begin(const Parameters& parameters) {
  if (!begun_) *this = ColumnClusterer();
  begun_ = false;
  parameters_ = parameters;
  parameters_.block_columns = std::clamp<std::size_t>(parameters.block_columns, 1, Row::kColumns);
  parameters_.threads = std::min(parameters.threads == 0 ? allThreads() : parameters.threads, Parameters::kMaxThreads);
  tolerance_ = Tolerance(parameters.tolerance);
  threads_ = 0;
  are_linked_ = false;
  subclusters_.reset(0);
  subcluster_sizes_.clear();
  staged_.clear();
  pending_.clear();
  pending_laser_ = columns_since_block_ = 0;
  pace_.begin();
  column_ = 0;
  is_ordered_ = false;
  if (parameters_.threads == 1) readAlone();
  begun_ = true;
}

/// One thread reads whatever comes. It gets ready in begin (), lest the first column take longer than others.
void ColumnClusterer::readAlone() {
  threads_ = 1;
  if (readings_.empty()) readings_.resize(1);
  readings_.front().first_element = 0;
  prepareReading(readings_.front());
}

void ColumnClusterer::checkColumns(std::size_t lasers) const {
  if (!begun_) throw std::logic_error("lisco::ColumnClusterer: a column before begin (), or after an exception");
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::ColumnClusterer: a column of more cells than lasers were declared");
}

std::size_t ColumnClusterer::returnCount() const {
  std::size_t count = 0;
  for (std::size_t thread = 0; thread < threads_; ++thread) count += readings_[thread].runs.returns;
  return count;
}

bool ColumnClusterer::isWorthThreads(std::size_t columns, std::size_t lasers) const {
  constexpr std::size_t kWorthThreads = 8192;  // cells
  return parameters_.threads > 1 && columns * lasers >= kWorthThreads;
}

void ColumnClusterer::prepareReading(Reading& reading) {
  reading.runs.clear();
  reading.runs.source_index.reserve(parameters_.expected_returns / threads_);
  reading.voxels.prepare(tolerance_);
  // Who reads alone does not know how many columns will come.
  reading.strip.prepare(tolerance_, parameters_.view,
                        threads_ == 1 ? ~std::size_t{0} : reading.end_column - reading.first_column);
}

void ColumnClusterer::stagedBlockIsComplete() {
  finishPending();
  std::swap(staged_, pending_);
  columns_since_block_ = 0;
}

/// Does as much of what is left to be done as so many columns are to take: a block of columns is read while the next one
/// comes, and linked while those after it come.
void ColumnClusterer::workOnPending(std::size_t columns) {
  pace_.addColumns(columns);
  ViewStrip& strip = lastReading().strip;
  while (strip.partsLeft() > 0 && pace_.isBehind()) pace_.spend(strip.linkPart(subclusters_));
  readPending(columns);
}

/// Reads as much of the pending block as so many columns are to take.
void ColumnClusterer::readPending(std::size_t columns) {
  if (pending_.columns() == 0) return;
  const std::size_t block = parameters_.block_columns;
  columns_since_block_ = std::min(columns_since_block_ + columns, block);
  for (; pending_laser_ < pending_.lasers() * columns_since_block_ / block; ++pending_laser_)
    readRow(lastReading(), pending_.row(pending_laser_), pending_laser_, column_, pending_.columns());
  if (pending_laser_ < pending_.lasers()) return;
  pending_laser_ = 0;
  column_ += static_cast<std::uint32_t>(pending_.columns());
  pending_.clear();
  lastReading().strip.claim();
  pace_.plan(lastReading().strip.partsLeft());
}

void ColumnClusterer::finishPending() {
  readPending(parameters_.block_columns);
}

/// Chains the returns of one laser into runs: each a neighbour of the one before. Far ones go to their places in the
/// strip, all others, and some far ones that others must find, into voxels.
void ColumnClusterer::readRow(Reading& reading, Row& row, std::size_t laser, std::uint32_t first_column,
                              std::size_t columns) {
  MeasuredRow& measured = reading.measured;
  ViewStrip& strip = reading.strip;
  measureRow(row, columns, tolerance_.squared(), strip.farRange(), measured);
  if (measured.returns == 0) return;

  reading.runs.add(row, measured, laser, first_column, columns, reading.first_element, subclusters_);
  std::uint64_t loose = 0;
  if (measured.far != 0) {
    if (!strip.hasStarted()) {
      const auto first = static_cast<std::size_t>(__builtin_ctzll(measured.far));
      strip.start(row.x[Row::kMargin + first], row.y[Row::kMargin + first],
                  first_column + static_cast<std::uint32_t>(first));
    }
    loose = strip.place(row, measured, laser, first_column);
  }
  const std::uint64_t near = measured.returns & (~measured.only_far | loose);
  if (near != 0) reading.voxels.add(row, measured, near, subclusters_);
}

/// Joins neighbours in the voxels of two readings.
class ColumnClusterer::VoxelJoiner : public Voxels::Joiner {
 public:
  explicit VoxelJoiner(DisjointSets& subclusters) : subclusters_(subclusters) {}
  bool areApart(std::uint32_t own, std::uint32_t others) override {
    return subclusters_.head(own) != subclusters_.head(others);
  }
  void join(std::uint32_t own, std::uint32_t others) override { subclusters_.merge(own, others); }

 private:
  DisjointSets& subclusters_;
};

/// Links each reading with itself, by a thread of its own, and then with those before it.
void ColumnClusterer::linkAll() {
  // Once they are linked with each other, subclusters belong to several of them, and only the last one gets more columns.
  const std::size_t first = are_linked_ ? threads_ - 1 : 0;
  are_linked_ = threads_ > 0;
  inParallel(threads_ - first, [&](std::size_t thread) {
    readings_[first + thread].strip.linkRest(subclusters_);
    readings_[first + thread].voxels.link(subclusters_);
  });
  bool full = false;
  for (std::size_t thread = first; thread < threads_; ++thread) {
    for (std::size_t earlier = 0; earlier < thread; ++earlier) linkReadings(readings_[thread], readings_[earlier]);
    readings_[thread].strip.linkTo(readings_[thread].strip, subclusters_);
    full = full || readings_[thread].strip.isFull();
  }
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    readings_[thread].voxels.settle();
    if (full) readings_[thread].strip.stopPlacing();
  }
}

void ColumnClusterer::linkReadings(Reading& later, Reading& earlier) {
  VoxelJoiner joiner(subclusters_);
  later.strip.linkTo(earlier.strip, subclusters_);
  later.voxels.linkTo(earlier.voxels, Voxels::Part::kNew, joiner);
}

void ColumnClusterer::update() {
  if (!begun_) return;
  begun_ = is_ordered_ = false;
  if (staged_.columns() > 0) {
    stagedBlockIsComplete();
    finishPending();
    std::swap(staged_, pending_);  // back, so that the next rotation finds the same memory
  } else {
    finishPending();
  }
  linkAll();

  // A head is the first element of its set.
  subcluster_sizes_.clear();
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    Reading& reading = readings_[thread];
    for (std::size_t i = 0; i < reading.runs.runs.size(); ++i) {
      Runs::Run& run = reading.runs.runs[i];
      const std::uint32_t element = reading.first_element + static_cast<std::uint32_t>(i);
      const std::uint32_t head = subclusters_.head(element);
      if (head == element) {
        run.subcluster = static_cast<std::uint32_t>(subcluster_sizes_.size());
        subcluster_sizes_.push_back(run.count);
        continue;
      }
      std::size_t owner = thread;
      while (head < readings_[owner].first_element) --owner;
      run.subcluster = readings_[owner].runs.runs[head - readings_[owner].first_element].subcluster;
      subcluster_sizes_[run.subcluster] += run.count;
    }
  }
  begun_ = true;
}

void ColumnClusterer::orderRows() {
  if (is_ordered_) return;
  order_.sort(threads_, [this](std::size_t thread) -> const Runs& { return readings_[thread].runs; });
  is_ordered_ = true;
}

std::uint32_t ColumnClusterer::subclusterAt(std::size_t laser, std::size_t column) {
  if (!begun_) return kNone;
  orderRows();
  const auto begin = order_.places().begin() + static_cast<std::ptrdiff_t>(order_.beginOf(laser));
  const auto end = order_.places().begin() + static_cast<std::ptrdiff_t>(order_.endOf(laser));
  const auto rowOf = [this](const LaserOrder::Place& place) -> const Runs::RowRuns& {
    return readings_[place.part].runs.rows[place.row];
  };
  const auto after = std::upper_bound(begin, end, column, [&](std::size_t wanted, const LaserOrder::Place& place) {
    return wanted < rowOf(place).first_column;
  });
  if (after == begin) return kNone;
  const LaserOrder::Place& place = *(after - 1);
  const std::size_t offset = column - rowOf(place).first_column;
  if (offset >= Row::kColumns) return kNone;
  const Runs& runs = readings_[place.part].runs;
  const std::uint32_t run = runs.runAt(rowOf(place), static_cast<std::uint32_t>(offset));
  return run == Runs::kNone ? kNone : runs.runs[run].subcluster;
}

}  // namespace lisco
