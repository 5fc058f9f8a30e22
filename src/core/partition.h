// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/bits.h"
#include "core/disjoint_sets.h"
#include "core/far/range_image.h"
#include "core/far/segment_linker.h"
#include "core/near/near_returns.h"
#include "core/near/voxel_grid.h"
#include "core/near/voxel_linker.h"
#include "core/neighbour.h"
#include "core/parallel.h"
#include "core/ring_block.h"
#include "core/runs.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"

namespace lisco {

/// Work of far returns, in units of the segment linker's.
struct FarWork {
  double in_image = 0;  ///< placing them in a range image, and linking them there
  double sorted = 0;    ///< sorting them with the near returns instead, estimated; 0 if none is far

  FarWork& operator+=(const FarWork& other) {
    in_image += other.in_image;
    sorted += other.sorted;
    return *this;
  }
  /// Whether a range image takes at most `most` times as long. False if no return is far.
  bool isImageWorthwhile(double most) const { return sorted > 0 && in_image <= most * sorted; }
};

/// Consecutive columns that are read and linked together: a thread's part of a rotation, or a stream's pane. Linking
/// with other partitions comes later. Run i is element first_element + i of a forest of subclusters.
class alignas(kSeparate) Partition {
 public:
  /// Starts without columns. Keeps its memory.
  /// \param hints if steps_per_turn is 0, all returns are near
  /// \param columns number of columns expected; more than a turn needs no more memory
  /// \param capacity number of columns for which expectColumns () moves no returns, if it is larger
  void prepare(const Tolerance& tolerance, const SensorHints& hints, std::size_t columns, std::size_t capacity = 0);

  /// Lends the range image's memory to the near returns, if it is larger than theirs, for rotations without far
  /// returns; takes it back, as prepare () for far returns does too. All values are lost; prepare () comes next.
  void lendImageMemory() noexcept;
  void takeBackImageMemory() noexcept;
  /// See RangeImage::takeLargerMemory.
  void takeLargerMemory(NearReturns& near) noexcept { image_.takeLargerMemory(near.returns); }
  void leaveLargerMemory(NearReturns& near) noexcept { image_.leaveLargerMemory(near.returns); }

  /// Makes room in the range image for a number of lasers, before their rings are read.
  void addLasers(std::size_t lasers) {
    if (image_.inUse()) image_.addLasers(lasers);
  }

  /// Makes room for more columns than expected before.
  void expectColumns(std::size_t columns) { image_.expectColumns(columns); }
  /// See RangeImage.
  bool hasMemory() const { return image_.hasMemory(); }
  bool hasMemoryFor(std::size_t lasers, std::size_t columns, const SensorHints& hints) const {
    return image_.hasMemoryFor(lasers, columns, hints);
  }
  void shrinkMemory() { image_.shrinkMemory(); }

  /// From now on near returns are collected, to be sorted by VoxelSorter, instead of put into voxels as they come.
  void collectNear() { collects_near_ = true; }
  const NearReturns& nearReturns() const { return near_returns_; }
  /// Makes room for a number of near returns.
  void reserveNear(std::size_t count) { near_returns_.returns.grow(count); }
  /// From now on near returns are put into voxels: first those that a partition of the same rotation, perhaps this one,
  /// has collected.
  void takeCollected(Partition& other, DisjointSets& subclusters);

  /// Reads `count` columns laser by laser, and links the sectors that all lasers have passed.
  /// \param first_cell number of the first column in `cells`
  /// \param first_column number of the same column in the rotation
  void readColumns(const CellSource& cells, std::size_t first_cell, std::size_t count, std::size_t lasers,
                   std::uint32_t first_column, DisjointSets& subclusters);

  /// Reads the columns [first, end), each laser from end to end, which is the order of an organized cloud in memory.
  /// Only without far returns.
  /// \param first number of a column in `cells` and in the rotation
  void readLasers(const CellSource& cells, std::size_t first, std::size_t end, std::size_t lasers,
                  DisjointSets& subclusters);

  /// Reads a ring block; linkWithin () links it.
  void readRing(const RingBlock& block, std::size_t laser, std::uint32_t first_column, std::size_t columns,
                DisjointSets& subclusters) {
    if (hasFar())
      measure(block, columns, tolerance_.squared(), image_.range, info_);
    else
      findRuns(block, columns, tolerance_.squared(), info_);
    if (info_.returns != 0) addRing(block, laser, first_column, columns, info_.returns, subclusters);
  }
  /// \param choose callable as ColumnBits (const RingBlock&, RingBlockInfo&), once runs and distances are measured and
  ///        before runs are cut: returns those of info.returns that may have neighbours, and may add starts of runs to
  ///        info.starts
  template <typename Choose>
  void readRing(const RingBlock& block, std::size_t laser, std::uint32_t first_column, std::size_t columns,
                DisjointSets& subclusters, Choose&& choose) {
    measure(block, columns, tolerance_.squared(), image_.range, info_);
    if (info_.returns != 0) addRing(block, laser, first_column, columns, choose(block, info_), subclusters);
  }

  /// Links all returns read since the last call among themselves and with those before, near and far.
  void linkWithin(DisjointSets& subclusters);
  /// See SegmentLinker::forEachOverlap.
  template <typename Visit>
  void forEachOverlap(const Partition& earlier, Visit&& visit) const {
    SegmentLinker::forEachOverlap(image_, earlier.image_, visit);
  }
  /// See RangeImage.
  void mergeRows(const Partition& other) { image_.mergeRows(other.image_); }
  void shareRows(const Partition& other) { image_.shareRows(other.image_); }
  void sortLasers() { image_.sortLasers(); }
  void updateElevations() { image_.updateElevations(); }
  /// Links the far returns of two partitions that overlap, with this one's memory.
  void linkOverlap(const Partition& later, const Partition& earlier, double ahead, DisjointSets& subclusters) {
    segments_.linkOverlap(later.image_, earlier.image_, ahead, &later == this, subclusters);
  }
  /// Links an unplaced return of the same rotation with the far returns of the partition.
  void linkUnplaced(const RangeImage::Unplaced& unplaced, DisjointSets& subclusters) const {
    SegmentLinker::linkUnplaced(image_, unplaced, subclusters);
  }
  /// Marks all near returns in voxels as linked with each other and with other partitions.
  void markLinked() { VoxelLinker::markLinked(voxels_); }

  /// Linking of far returns part by part: see SegmentLinker.
  void scheduleFar() { segments_.schedule(image_); }
  std::size_t farPartsLeft() const { return segments_.partsLeft(image_); }
  std::size_t linkFarPart(DisjointSets& subclusters) { return segments_.linkPart(image_, subclusters); }
  /// The same for near returns in voxels: see VoxelLinker.
  std::size_t nearBricksLeft() const { return VoxelLinker::bricksLeft(voxels_); }
  std::size_t linkNearPart(DisjointSets& subclusters) { return VoxelLinker::linkPart(voxels_, subclusters); }

  const RangeImage& image() const { return image_; }
  /// Number of returns that are not in the range image.
  std::size_t notPlacedCount() const { return runs.returns - image_.placed; }
  /// False if all returns are near.
  bool hasFar() const { return image_.inUse(); }
  /// The work of far returns so far.
  FarWork farWork() const;
  /// The same, with that of linking all that have been read.
  FarWork expectedFarWork() const;

  /// See RangeImage::isFull.
  void stopPlacing() { image_.stopPlacing(); }

  /// Work done since prepare () beyond that of reading cells, where a cell is 1.
  std::size_t workDone() const;

  /// Links the near returns of this pane, all or new, with those of another one.
  void linkPanes(Partition& other, VoxelLinker::Part part, PairVisitor& visitor) {
    VoxelLinker::linkTo(voxels_, other.voxels_, part, visitor);
  }

  Runs runs;
  std::uint32_t first_element = 0;

 private:
  /// Cuts the runs of a ring block, and hands its returns to the range image and the voxels.
  /// \param chosen returns that may have neighbours
  void addRing(const RingBlock& block, std::size_t laser, std::uint32_t first_column, std::size_t columns,
               ColumnBits chosen, DisjointSets& subclusters);

  Tolerance tolerance_;
  RangeImage image_;  ///< far returns
  SegmentLinker segments_;
  // Near and unplaced returns: collected, or in voxels.
  bool collects_near_ = false;
  bool is_image_memory_lent_ = false;
  NearReturns near_returns_;
  VoxelGrid voxels_;
  VoxelLinker near_;
  RingBlock block_{};
  RingBlockInfo info_{};
};

}  // namespace lisco
