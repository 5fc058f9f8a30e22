// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/far/constants.h"
#include "core/far/range_image.h"
#include "core/growing_array.h"

namespace lisco {

/// The segments of a sector of sixteen bins, ordered by row and bin: the returns of each run there, with measured
/// bounds. Where bins were compared in a row of the sector before, the row's segments are bounded when they are
/// compared with others: most of them are not, since their bins are.
struct Sector {
  static constexpr std::int64_t kNone = -1;
  static constexpr std::size_t kMaxLanes = 16;  ///< of the vectors that read segments

  /// The returns of a row in the sector; bit i of a set: bin i.
  struct Row {
    float nearest;                  ///< least horizontal distance, if there are any
    std::uint16_t returns, starts;  ///< starts: the first ones of segments
  };
  static_assert(RangeImage::kSector <= 16, "a set of bins fits");

  std::int64_t number = kNone;
  std::int64_t first_bin = 0;
  float later = 0;  ///< added to bin numbers
  std::vector<Row> rows;
  std::vector<std::uint64_t> unbounded;   ///< rows whose segments are not bounded yet: bit i % 64 of word i / 64
  GrowingArray<float> nearest, farthest;  ///< horizontal distance
  GrowingArray<float> lowest, highest;    ///< z
  GrowingArray<float> first, last;        ///< bin
  GrowingArray<std::uint32_t> root;       ///< of its subcluster, perhaps outdated
  GrowingArray<std::uint32_t> place;      ///< of its first return: kSector times its row, and the bin in the sector
  GrowingArray<std::uint8_t> count;       ///< of returns
  std::vector<std::uint32_t> begin;       ///< of each row's segments, and the end

  /// Makes room for another row behind some segments: one for each bin, and what vectors read behind the last.
  void reserveRow(std::size_t segments) {
    constexpr std::size_t kRow = RangeImage::kSector + kMaxLanes;
    if (segments + kRow > std::min(place.size(), count.size())) grow(segments + kRow);
  }
  void grow(std::size_t segments);
  bool hasUnbounded() const {
    return std::any_of(unbounded.begin(), unbounded.end(), [](std::uint64_t word) { return word != 0; });
  }
  /// Adapts to a number of rows; the sector is to be cut again.
  void resize(std::size_t row_count) {
    number = kNone;
    rows.resize(row_count);
    unbounded.resize(row_count / 64 + 1);
    begin.resize(row_count + 1);
  }
};

/// The paper's neighbor mask (Algorithm 2) of one row's returns in a sector, from measured bounds.
struct NeighborMask {
  float nearest = 0;  ///< horizontal distance, metres
  int before = 0;     ///< sigma: bins that it reaches over
  std::uint32_t first_row = 0, last_row = 0;
  std::uint32_t above = 0, below = 0;  ///< lambda: the same rows, counted from this one; where the next search begins
  bool by_bins = false;                ///< comparing bins is cheaper than comparing segments
};

/// What the vectorized code of SegmentLinker works on.
struct SegmentLinkerState {
  static constexpr std::size_t kSectorsKept = 8;
  static constexpr std::size_t kParts = 80;  ///< in which a sector is linked part by part

  std::array<Sector, kSectorsKept> sectors;
  Sector beyond;                    ///< a sector of another image, or of this one a turn later
  std::vector<NeighborMask> masks;  ///< of each row in the sector at hand
  std::size_t work = 0;             ///< done so far, about in comparisons of registers
};

/// Algorithm 4 on range images: joins far returns that are neighbours. Returns in the same bin of adjacent lasers are
/// compared first, several at once, which joins most of what belongs together. Then each segment is compared with the
/// segments in its neighbor mask that are in another subcluster by then: bounds first, returns last.
///
/// Finds all pairs of placed returns; linkUnplaced () finds those with an unplaced one. Serves one image.
class SegmentLinker : private SegmentLinkerState {
 public:
  /// Starts a rotation, or a part of one. Keeps its memory.
  void prepare(const RangeImage& image);

  /// Links what has come since the last call, as far as all lasers have passed it.
  void link(RangeImage& image, DisjointSets& subclusters);

  /// The same part by part: schedule () sets what linkPart () links.
  void schedule(RangeImage& image);
  std::size_t partsLeft(const RangeImage& image) const {
    return (image.scheduled - image.linked) / RangeImage::kSector * kParts - linked_parts_;
  }
  /// \return its work, about in comparisons of registers
  std::size_t linkPart(RangeImage& image, DisjointSets& subclusters);

  /// Links all that has not been linked within the image. More returns may come later.
  void linkRest(RangeImage& image, DisjointSets& subclusters);

  /// Calls visit(ahead) for each way around in which the bins of an image come within reach of those of another one of
  /// the same rotation: bin 0 of the other is bin `ahead` of the image. The other may be the image itself, a turn
  /// before. After linkRest () of both.
  template <typename Visit>
  static void forEachOverlap(const RangeImage& image, const RangeImage& other, Visit&& visit);
  /// Links the returns of two images that overlap so. Threads may link different overlaps at once, each by its own
  /// linker. Both images have the same rows (RangeImage::shareRows), with elevations up to date.
  /// \param is_own whether the image is the one that the linker serves otherwise
  void linkOverlap(const RangeImage& image, const RangeImage& other, double ahead, bool is_own,
                   DisjointSets& subclusters);
  /// Links a return that is unplaced, in this image or another one of the same rotation, with the returns of the image.
  static void linkUnplaced(const RangeImage& image, const RangeImage::Unplaced& unplaced, DisjointSets& subclusters);

  /// Work done since prepare (), about in comparisons of registers.
  std::size_t workDone() const { return work; }

 private:
  void fit(const RangeImage& image);
  void forgetSectors();

  std::size_t linked_parts_ = 0;     ///< of the sector at image.linked
  std::size_t times_reordered_ = 0;  ///< of the image's rows, when the sectors were cut
};

template <typename Visit>
void SegmentLinker::forEachOverlap(const RangeImage& image, const RangeImage& other, Visit&& visit) {
  if (image.placed == 0 || other.placed == 0) return;
  const bool is_seam = &other == &image;
  const auto turn = static_cast<double>(image.steps);
  const double ahead =
      image.direction * (other.start_azimuth - image.start_azimuth) / static_cast<double>(image.radians_per_bin);
  const double least = is_seam ? 1.0 : -static_cast<double>(other.end) - kMaxReach;
  const double most = static_cast<double>(image.end) + kMaxReach;
  const auto first = static_cast<int>(std::ceil((least - ahead) / turn));
  const auto last = static_cast<int>(std::floor((most - ahead) / turn));
  for (int turns = first; turns <= last; ++turns) visit(ahead + turn * turns);
}

}  // namespace lisco
