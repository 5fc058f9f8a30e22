// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Columns that come at once, as those of a whole scan: read by several threads, with or without range images.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/far_history.h"
#include "core/far_trial.h"
#include "core/parallel.h"
#include "core/partition.h"
#include "core/rotation.h"
#include "core/unordered_returns.h"

namespace lisco {

namespace {

// In brackets, the section of benchmarks/suite.sh that shows the effect.

/// Columns of these on which the work of far returns is measured. Fewer: a worse estimate; more: a later change
/// (recordings).
constexpr std::size_t kTriedColumns = 128;
static_assert(kTriedColumns % RingBlock::kColumns == 0, "whole blocks are read");
/// Times the work of sorting up to which the trial accepts that of range images: other columns may take less.
/// FarHistory corrects it (recordings, layouts).
constexpr double kMostInTrial = 2.65;
/// The same above which the trial ends before its last column. More: clouds without range images wait for it.
constexpr double kClearlyTooMuch = 6.6;
/// SensorHints::drift above which returns leave their expected bins too often, as in motion-compensated clouds. The
/// first columns do not show it, as the motion grows from there. At rest 0.05; in motion 1 to 20 (recordings).
constexpr float kMaxDrift = 1.25F;
/// What the drift may exceed that by for a slope of 1 of the sensor's horizon: azimuths about another axis grow
/// unevenly, but no more so later in the turn. At a slope of 0.27 the drift is 1.4 to 2.6.
constexpr float kDriftOfTilt = 8.0F;
/// Turns of columns from which on many bins have been taken by the turn before.
constexpr double kMaxTurns = 1.5;

}  // namespace

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
  const float max_drift = kMaxDrift + kDriftOfTilt * std::hypot(sensor.tilt[0], sensor.tilt[1]);
  const bool may_have_far = sensor.steps_per_turn != 0 && !repeats && sensor.drift <= max_drift;
  if (may_have_far && !far_history_.begin({columns, lasers, sensor.steps_per_turn, parameters_.tolerance})) {
    far_ = Far::kLeftOut;
  } else if (may_have_far) {
    if (std::exchange(is_sorter_grown_, false))
      sorter_ = VoxelSorter();  // gives back what images need: readUnordered ()
    if (readFarAndNear(lasers, cells)) return;
  }
  if (UnorderedReturns::isUnordered(columns, lasers, cells, tolerance_))
    readUnordered(lasers, cells);
  else
    readNear(lasers, cells);
}

/// Calls read (i) for each part by a thread of its own. The times of several set their later shares.
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
/// \return false, with part of it read, if there are no far returns, or those of the first columns take more work than
///         the trial accepts
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
    if (far_ == Far::kLeftOut) partition.lendImageMemory();
    preparePart(i, SensorHints(), 0);
    const auto [begin, end] = parts_[i];
    reserveRuns(partition);
    reserveNear(partition, end - begin);
    partition.readLasers(cells, begin, end, lasers, subclusters_);
    if (partition_count_ > 1) balancer_.record(begin, end - begin, (end - begin) * lasers + partition.workDone());
  });
}

/// The same without runs. Where range images are left out, the partitions' memory is given back: an image, runs and
/// sorted returns together take more than 64 bytes per cell.
void ColumnClusterer::Rotation::readUnordered(std::size_t lasers, const CellSource& cells) {
  partitions_.front().takeBackImageMemory();
  partitions_.front().leaveLargerMemory(unordered_.memory());  // which the trial uses
  if (far_ == Far::kLeftOut) {
    is_sorter_grown_ = true;
    if (partitions_.front().runs.runs.size() > 0 || partitions_.front().hasMemory())
      for (Partition& partition : partitions_) partition = Partition();
  }
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
      return partition.runs.returns == 0 || partition.expectedFarWork().isImageWorthwhile(most);
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

/// Adds a rotation that came at once, and whose returns might be far, to the history.
void ColumnClusterer::Rotation::recordFar() {
  if (comes_at_once_ && far_ != Far::kNone) {
    FarHistory::Content content{returnCount(), 0};
    FarWork work;
    for (std::size_t i = 0; i < partition_count_; ++i) {
      content.runs += runsOf(i).run_count;
      work += partitions_[i].farWork();
    }
    const bool is_full = partitions_.front().image().isFull();  // all are once one is: see linkImages ()
    if (far_ == Far::kLeftOut)
      far_history_.recordLeftOut(content);
    else
      far_history_.recordTried(far_ == Far::kInImages && !is_full && work.isImageWorthwhile(1.0), content);
  }
  far_ = Far::kNone;
}

}  // namespace lisco
