// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/column_clusterer.h"

namespace lisco {

void ColumnClusterer::begin(const Parameters& parameters) {
  parameters_ = parameters;
  parameters_.block_columns = std::clamp<std::size_t>(parameters.block_columns, 1, Row::kColumns);
  if (parameters.threads == 0) parameters_.threads = allThreads();
  tolerance_ = Tolerance(parameters.tolerance);
  threads_ = 1;
  if (readings_.size() < parameters_.threads) readings_.resize(parameters_.threads);
  for (Reading& reading : readings_) {
    reading.first_element = 0;
    reading.source_index.clear();
    reading.runs.clear();
    reading.rows.clear();
    reading.returns = 0;
    reading.voxels.prepare(tolerance_);
  }
  readings_.front().source_index.reserve(parameters.expected_returns / parameters_.threads);
  strip_.prepare(tolerance_, parameters_.view, parameters_.threads);
  if (forests_.size() < parameters_.threads) forests_.resize(parameters_.threads);
  forests_.front().reset(0);
  subcluster_sizes_.clear();
  staged_columns_ = 0;
  column_ = 0;
}

std::size_t ColumnClusterer::returnCount() const {
  std::size_t count = 0;
  for (const Reading& reading : readings_) count += reading.returns;
  return count;
}

bool ColumnClusterer::readsInParallel(std::size_t columns, std::size_t lasers) const {
  constexpr std::size_t kWorthThreads = 8192;  // cells
  return parameters_.threads > 1 && column_ == 0 && staged_columns_ == 0 && lasers > 1 &&
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

void ColumnClusterer::stageLasers(std::size_t lasers) {
  while (staged_.size() < lasers) {
    staged_.emplace_back();
    std::fill_n(staged_.back().x, Row::kMargin + Row::kColumns, kNoReturn.x);
    std::fill_n(staged_.back().y, Row::kMargin + Row::kColumns, kNoReturn.y);
    std::fill_n(staged_.back().z, Row::kMargin + Row::kColumns, kNoReturn.z);
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

/// Reads the columns that have been staged, row by row.
void ColumnClusterer::clusterBlock() {
  for (std::size_t laser = 0; laser < staged_.size(); ++laser)
    readRow(readings_[threads_ - 1], threads_ - 1, staged_[laser], laser, column_, staged_columns_);
  const std::size_t columns = staged_columns_;
  staged_columns_ = 0;
  finishBlock(columns);
}

/// Links what all lasers have passed.
void ColumnClusterer::finishBlock(std::size_t columns) {
  column_ += static_cast<std::uint32_t>(columns);
  if (strip_.inUse()) strip_.link(forests_.front());
}

/// Chains the returns of one laser into runs: each a neighbour of the one before. Far ones go to their places in the
/// strip, all others, and some far ones that others must find, into voxels.
void ColumnClusterer::readRow(Reading& reading, std::size_t thread, Row& row, std::size_t laser,
                              std::uint32_t first_column, std::size_t columns) {
  MeasuredRow& measured = reading.measured;
  measureRow(row, columns, tolerance_.squared(), strip_.farRange(), measured);
  if (measured.returns == 0) return;

  const auto first_run = static_cast<std::uint32_t>(reading.runs.size());
  const auto first_cell = static_cast<std::uint32_t>(reading.source_index.size());
  const std::size_t last_run = first_run + static_cast<std::size_t>(__builtin_popcountll(measured.starts));
  forests_.front().grow(reading.first_element + last_run);
  reading.runs.resize(last_run);
  reading.source_index.insert(reading.source_index.end(), row.source_index, row.source_index + columns);
  reading.returns += static_cast<std::size_t>(__builtin_popcountll(measured.returns));
  const std::uint64_t ends = ~measured.returns | measured.starts;
  std::uint32_t number = first_run;
  for (std::uint64_t starts = measured.starts; starts != 0; starts &= starts - 1, ++number) {
    const auto begin = static_cast<std::uint32_t>(__builtin_ctzll(starts));
    const std::uint64_t after = begin == Row::kColumns - 1 ? 0 : ends & ~std::uint64_t{0} << (begin + 1);
    const std::uint32_t end = after != 0 ? static_cast<std::uint32_t>(__builtin_ctzll(after)) : Row::kColumns;
    const std::uint32_t element = reading.first_element + number;
    forests_.front().create(element);
    for (std::uint32_t i = begin; i < end; ++i) measured.run[i] = element;
    reading.runs[number] = {first_cell + begin, end - begin, 0};
  }
  reading.rows.push_back({static_cast<std::uint32_t>(laser), first_run, number - first_run});

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
      visit(first, first + static_cast<std::uint32_t>(readings_[thread].runs.size()));
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
  if (staged_columns_ > 0) clusterBlock();
  DisjointSets& subclusters = forests_.front();
  if (strip_.inUse()) linkStrip();
  Voxels& voxels = readings_.front().voxels;
  for (std::size_t thread = 1; thread < threads_; ++thread) voxels.absorb(readings_[thread].voxels, subclusters);
  voxels.link(subclusters);

  // A head is the first element of its set.
  subcluster_sizes_.clear();
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    Reading& reading = readings_[thread];
    for (std::size_t i = 0; i < reading.runs.size(); ++i) {
      Run& run = reading.runs[i];
      const std::uint32_t element = reading.first_element + static_cast<std::uint32_t>(i);
      const std::uint32_t head = subclusters.head(element);
      if (head == element) {
        run.subcluster = static_cast<std::uint32_t>(subcluster_sizes_.size());
        subcluster_sizes_.push_back(run.count);
        continue;
      }
      std::size_t owner = thread;
      while (head < readings_[owner].first_element) --owner;
      run.subcluster = readings_[owner].runs[head - readings_[owner].first_element].subcluster;
      subcluster_sizes_[run.subcluster] += run.count;
    }
  }
}

/// Sorts the rows by laser, those of one laser as they came.
void ColumnClusterer::orderRows() {
  std::size_t lasers = 0;
  std::size_t rows = 0;
  for (std::size_t thread = 0; thread < threads_; ++thread) {
    rows += readings_[thread].rows.size();
    for (const RowRuns& row : readings_[thread].rows) lasers = std::max<std::size_t>(lasers, row.laser + 1);
  }
  rows_of_laser_.assign(lasers + 1, 0);
  for (std::size_t thread = 0; thread < threads_; ++thread)
    for (const RowRuns& row : readings_[thread].rows) ++rows_of_laser_[row.laser + 1];
  for (std::size_t laser = 0; laser < lasers; ++laser) rows_of_laser_[laser + 1] += rows_of_laser_[laser];
  ordered_rows_.resize(rows);
  for (std::size_t thread = 0; thread < threads_; ++thread)
    for (std::size_t row = 0; row < readings_[thread].rows.size(); ++row)
      ordered_rows_[rows_of_laser_[readings_[thread].rows[row].laser]++] = {static_cast<std::uint32_t>(thread),
                                                                            static_cast<std::uint32_t>(row)};
}

}  // namespace lisco
