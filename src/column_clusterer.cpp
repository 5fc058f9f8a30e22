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
  if (parameters.threads == 0) parameters_.threads = allThreads();
  tolerance_ = Tolerance(parameters.tolerance);
  threads_ = 1;
  if (readings_.size() < parameters_.threads) readings_.resize(parameters_.threads);
  for (Reading& reading : readings_) {
    reading.first_element = 0;
    reading.runs.clear();
    reading.voxels.prepare(tolerance_);
  }
  readings_.front().runs.source_index.reserve(parameters.expected_returns / parameters_.threads);
  strip_.prepare(tolerance_, parameters_.view, parameters_.threads);
  if (forests_.size() < parameters_.threads) forests_.resize(parameters_.threads);
  forests_.front().reset(0);
  subcluster_sizes_.clear();
  staged_.clear();
  pending_.clear();
  pending_laser_ = columns_since_block_ = 0;
  pace_.begin();
  column_ = 0;
  is_ordered_ = false;
  begun_ = true;
}

void ColumnClusterer::checkColumns(std::size_t lasers) const {
  if (!begun_) throw std::logic_error("lisco::ColumnClusterer: a column before begin (), or after an exception");
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::ColumnClusterer: a column of more cells than lasers were declared");
}

std::size_t ColumnClusterer::returnCount() const {
  std::size_t count = 0;
  for (const Reading& reading : readings_) count += reading.runs.returns;
  return count;
}

bool ColumnClusterer::readsInParallel(std::size_t columns, std::size_t lasers) const {
  constexpr std::size_t kWorthThreads = 8192;  // cells
  return parameters_.threads > 1 && column_ == 0 && staged_.columns() == 0 && pending_.columns() == 0 && lasers > 1 &&
         columns * lasers >= kWorthThreads;
}

/// Gives each thread some lasers, of about the same weight, and elements for as many runs as they can have.
void ColumnClusterer::prepareReadings(std::size_t columns, std::size_t lasers) {
  threads_ = std::min(parameters_.threads, lasers);
  forests_.front().reset(lasers * columns + Row::kColumns);
  std::uint64_t all = 0;
  for (const std::uint32_t weight : weights_) all += weight;
  std::uint64_t sum = 0;
  std::size_t laser = 0;
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    readings_[thread].first_laser = laser;
    readings_[thread].first_element = static_cast<std::uint32_t>(laser * columns);
    while (laser < lasers && (thread + 1 == threads_ || sum < all * (thread + 1) / threads_)) sum += weights_[laser++];
    readings_[thread].end_laser = laser;
  }
  if (strip_.inUse()) strip_.addLasers(lasers);
}

/// Lets the strip begin at the first far return of a row.
void ColumnClusterer::startStripAt(const Row& row, const MeasuredRow& measured, std::uint32_t first_column) {
  const auto first = static_cast<std::size_t>(__builtin_ctzll(measured.far));
  strip_.start(row.x[Row::kMargin + first], row.y[Row::kMargin + first],
               first_column + static_cast<std::uint32_t>(first));
}

void ColumnClusterer::startStrip(Reading& reading, Row& row, std::uint32_t first_column, std::size_t columns) {
  measureRow(row, columns, tolerance_.squared(), strip_.farRange(), reading.measured);
  if (reading.measured.far != 0 && !strip_.hasStarted()) startStripAt(row, reading.measured, first_column);
}

void ColumnClusterer::stagedBlockIsComplete() {
  finishPending();
  std::swap(staged_, pending_);
  columns_since_block_ = 0;
}

/// Does as much of what is left to be done as so many columns are to take: a block of columns is read while the next one
/// comes, and linked while those after it come.
void ColumnClusterer::workOnPending(std::size_t columns) {
  const std::size_t block = parameters_.block_columns;
  columns_since_block_ = std::min(columns_since_block_ + columns, block);
  pace_.addColumns(columns);
  while (strip_.partsLeft() > 0 && pace_.isBehind()) pace_.spend(strip_.linkPart(forests_.front()));
  if (pending_.columns() == 0) return;
  for (; pending_laser_ < pending_.lasers() * columns_since_block_ / block; ++pending_laser_)
    readRow(readings_[threads_ - 1], threads_ - 1, pending_.row(pending_laser_), pending_laser_, column_,
            pending_.columns());
  if (pending_laser_ < pending_.lasers()) return;
  pending_laser_ = 0;
  column_ += static_cast<std::uint32_t>(pending_.columns());
  pending_.clear();
  strip_.claim();
  pace_.plan(strip_.partsLeft());
}

/// Reads the rest of the block.
void ColumnClusterer::finishPending() {
  if (pending_.columns() > 0) workOnPending(parameters_.block_columns);
}

/// Chains the returns of one laser into runs: each a neighbour of the one before. Far ones go to their places in the
/// strip, all others, and some far ones that others must find, into voxels.
void ColumnClusterer::readRow(Reading& reading, std::size_t thread, Row& row, std::size_t laser,
                              std::uint32_t first_column, std::size_t columns) {
  MeasuredRow& measured = reading.measured;
  measureRow(row, columns, tolerance_.squared(), strip_.farRange(), measured);
  if (measured.returns == 0) return;

  reading.runs.add(row, measured, laser, first_column, columns, reading.first_element, forests_.front());
  std::uint64_t loose = 0;
  if (measured.far != 0) {
    if (!strip_.hasStarted()) startStripAt(row, measured, first_column);
    loose = strip_.place(row, measured, laser, first_column, thread);
  }
  const std::uint64_t near = measured.returns & (~measured.only_far | loose);
  if (near != 0) reading.voxels.add(row, measured, near, forests_.front());
}

void ColumnClusterer::linkStrip() {
  const auto forEachReading = [this](auto&& visit) {
    for (std::size_t thread = 0; thread < threads_; ++thread) {
      const std::uint32_t first = readings_[thread].first_element;
      visit(first, first + static_cast<std::uint32_t>(readings_[thread].runs.runs.size()));
    }
  };
  if (threads_ > 1)
    inParallel(threads_, [&](std::size_t thread) {
      if (thread == 0) return;
      forests_[thread].reset(forests_.front().room());
      forEachReading([&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t element = first; element < last; ++element) forests_[thread].create(element);
      });
    });
  strip_.linkAll(forests_.data(), threads_);
  for (std::size_t thread = 1; thread < threads_; ++thread)
    forEachReading(
        [&](std::uint32_t first, std::uint32_t last) { forests_.front().absorb(forests_[thread], first, last); });
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
  DisjointSets& subclusters = forests_.front();
  if (strip_.inUse()) linkStrip();
  Voxels& voxels = readings_.front().voxels;
  for (std::size_t thread = 1; thread < threads_; ++thread) voxels.absorb(readings_[thread].voxels, subclusters);
  voxels.link(subclusters);
  voxels.settle();

  // A head is the first element of its set.
  subcluster_sizes_.clear();
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    Reading& reading = readings_[thread];
    for (std::size_t i = 0; i < reading.runs.runs.size(); ++i) {
      Runs::Run& run = reading.runs.runs[i];
      const std::uint32_t element = reading.first_element + static_cast<std::uint32_t>(i);
      const std::uint32_t head = subclusters.head(element);
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
