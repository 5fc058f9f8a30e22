// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Algorithm 4 on the segments of a range image; compiled once for each SIMD level.
#if defined(LISCO_SEGMENT_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_SEGMENT_SEARCH_INL_H
#undef LISCO_SEGMENT_SEARCH_INL_H
#else
#define LISCO_SEGMENT_SEARCH_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/far/sector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

constexpr std::uint32_t kWorkOfRegister = kLanes < 16 ? kWorkOfNarrowRegister : kWorkOfWideRegister;

/// The returns of a segment.
struct Returns {
  RowBins bins;
  std::size_t count;
};

/// Whether any return of one segment is a neighbour of any return of the other.
bool haveNeighbours(Returns a, Returns b, const Tolerance& tolerance) {
  if (a.count > b.count) std::swap(a, b);
  const FloatVector r2 = hn::Set(kFloats, tolerance.squared());
  for (std::size_t i = 0; i < a.count; ++i) {
    const FloatVector x = hn::Set(kFloats, a.bins.x()[i]);
    const FloatVector y = hn::Set(kFloats, a.bins.y()[i]);
    const FloatVector z = hn::Set(kFloats, a.bins.z()[i]);
    for (std::size_t k = 0; k < b.count; k += kLanes) {
      const FloatMask near =
          areNeighbours(hn::Sub(x, hn::LoadU(kFloats, b.bins.x() + k)), hn::Sub(y, hn::LoadU(kFloats, b.bins.y() + k)),
                        hn::Sub(z, hn::LoadU(kFloats, b.bins.z() + k)), r2);
      if ((bitsOf(near) & lanesBelow(b.count - k)) != 0) return true;
    }
  }
  return false;
}

/// Searches the neighbours of a sector's segments in the sectors up to it.
class SegmentSearch {
 public:
  SegmentSearch(const RangeImage& image, SegmentLinkerState& linking, DisjointSets& subclusters)
      : image_(image), state_(linking), subclusters_(subclusters), bins_per_radian_(1.00001F / image.radians_per_bin) {}

  /// Cuts some rows of a sector and makes their masks. Ranges of rows follow each other, from the first on.
  void prepareSector(std::int64_t number, const RangeImage::Rows& rows) {
    Sector& sector = sectorOf(number);
    cutSector(image_, number, 0.0F, rows, state_.masks.data(), sector, subclusters_);
    for (std::size_t row = rows.begin; row < rows.end; ++row) prepareMask(sector, row);
  }

  /// Links a sector with itself and with those before it, for every one_in-th of its rows from first_row on.
  void linkSector(std::int64_t number, std::size_t first_row, std::size_t one_in) {
    Sector& sector = sectorOf(number);
    const bool some_unbounded =
        std::any_of(state_.sectors.begin(), state_.sectors.end(), [](const Sector& one) { return one.hasUnbounded(); });
    for (std::size_t row = first_row; row < image_.rows.size(); row += one_in) {
      if (sector.begin[row] == sector.begin[row + 1]) continue;
      const NeighborMask& mask = state_.masks[row];
      if (mask.by_bins) {
        compareBins(number, row);
        continue;
      }
      if (some_unbounded)
        for (std::int64_t other = firstWithin(number, mask.before); other <= number; ++other)
          boundRows(cut(other), mask.first_row, mask.last_row);
      forEachSegment(image_, sector, row, [&](Segment& segment) {
        for (std::int64_t other = firstWithin(number, segment.before); other < number; ++other)
          search(segment, cut(other), ~0U);
        search(segment, sector, segment.index);
      });
    }
  }

  /// Links another image with this one, whose bin 0 is this one's bin `later`: the image itself a turn later joins its
  /// end with its beginning. Both share the order of rows, and elevations.
  void linkAcross(const RangeImage& other, double later) {
    // Bins of different images differ by a fraction.
    const double reach = binsWithin(asinBound(image_.reach / image_.range.min_range)) + 1;
    const auto last = sectorAt(static_cast<double>(image_.end - 1));
    const auto first_of_other =
        sectorAt(std::max(static_cast<double>(other.begin), static_cast<double>(image_.begin) - reach - later));
    const auto last_of_other =
        sectorAt(std::min(static_cast<double>(other.end), static_cast<double>(image_.end) + reach - later));
    for (std::int64_t number = first_of_other; number <= last_of_other; ++number) {
      Sector& sector = state_.beyond;
      cutSector(other, number, static_cast<float>(later), image_.allRows(), nullptr, sector, subclusters_);
      for (std::size_t row = 0; row < image_.rows.size(); ++row) {
        prepareMask(sector, row);
        forEachSegment(other, sector, row, [&](Segment& segment) {
          segment.first -= 1;
          segment.last += 1;
          const std::int64_t from = std::max<std::int64_t>(0, sectorAt(static_cast<double>(segment.first)));
          const std::int64_t to = std::min(last, sectorAt(static_cast<double>(segment.last)));
          for (std::int64_t one = from; one <= to; ++one) {
            Sector& own = cut(one);
            boundRows(own, segment.first_row, segment.last_row);
            search(segment, own, ~0U);
          }
        });
      }
    }
  }

 private:
  /// A segment and its neighbor mask, as bounds on segments that may hold neighbours.
  struct Segment {
    std::uint32_t index;
    std::uint32_t root;
    std::int64_t before;  ///< bins that the mask reaches over
    std::size_t first_row, last_row;
    Returns returns;
    float nearest, farthest, lowest, highest, first, last;
  };

  /// The first sector within some bins before one.
  static std::int64_t firstWithin(std::int64_t number, std::int64_t bins) {
    return std::max<std::int64_t>(number - sectorsWithin(bins), 0);
  }

  static std::int64_t sectorsWithin(std::int64_t bins) {
    constexpr auto kSector = static_cast<std::int64_t>(RangeImage::kSector);
    return (bins + kSector - 1) / kSector;
  }

  static std::int64_t sectorAt(double bin) {
    return static_cast<std::int64_t>(std::floor(bin / static_cast<double>(RangeImage::kSector)));
  }

  Sector& sectorOf(std::int64_t number) {
    return state_.sectors[static_cast<std::size_t>(number) % SegmentLinkerState::kSectorsKept];
  }

  static Returns returnsOf(const RangeImage& image, const Sector& sector, std::uint32_t segment) {
    constexpr auto kSector = static_cast<std::uint32_t>(RangeImage::kSector);
    const std::uint32_t place = sector.place[segment];
    return {image.at(place / kSector, sector.first_bin + place % kSector), sector.count[segment]};
  }

  /// The sector, cut.
  Sector& cut(std::int64_t number) {
    Sector& sector = sectorOf(number);
    if (sector.number != number) cutSector(image_, number, 0.0F, image_.allRows(), nullptr, sector, subclusters_);
    return sector;
  }

  /// Bounds the segments of some rows of a sector.
  void boundRows(Sector& sector, std::size_t first_row, std::size_t last_row) {
    for (std::size_t word = first_row / 64; word <= last_row / 64; ++word) {
      std::uint64_t rows = sector.unbounded[word];
      if (word == first_row / 64) rows &= bitsFrom(first_row % 64);
      if (word == last_row / 64) rows &= ~bitsFrom(last_row % 64 + 1);
      sector.unbounded[word] &= ~rows;
      forEachBit(rows, [&](std::size_t i) { boundSegments(image_, sector, 64 * word + i, subclusters_); });
    }
  }

  /// getNeighborMask (Algorithm 2) of a row's returns in a sector; chooses what is cheaper to compare, segments or
  /// bins.
  void prepareMask(const Sector& sector, std::size_t row) {
    const std::uint32_t begin = sector.begin[row];
    const std::uint32_t end = sector.begin[row + 1];
    if (begin == end) return;
    const float nearest = sector.rows[row].nearest;
    NeighborMask& mask = state_.masks[row];
    mask.nearest = nearest;
    mask.before = binsWithin(asinBound(image_.reach / nearest));
    reachRows(row, nearest, mask);
    constexpr auto kSector = static_cast<std::uint32_t>(RangeImage::kSector);
    const auto lasers = (mask.last_row - mask.first_row) / static_cast<std::uint32_t>(image_.layers) + 1;
    const std::uint32_t by_bins = lasers * static_cast<std::uint32_t>(mask.before) * kSector;
    const std::uint32_t by_segments = (end - begin) * static_cast<std::uint32_t>(sectorsWithin(mask.before) + 1);
    mask.by_bins = by_bins < kSegmentCost * by_segments;
  }

  /// Compares a row's bins in a sector with all bins of its mask, up to its own, a vector at a time. Where the other
  /// row is compared by segments, this one compares both directions.
  void compareBins(std::int64_t sector, std::size_t row) {
    const NeighborMask& mask = state_.masks[row];
    const std::int64_t bin = sector * static_cast<std::int64_t>(RangeImage::kSector);
    const std::size_t compared = image_.rowInSameBins(row);
    for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
      const Registers own(image_.at(row, bin + static_cast<std::int64_t>(k)));
      for (std::uint32_t other = mask.first_row; other <= mask.last_row; ++other) {
        if (!image_.rows[other].is_open) continue;
        const RowBins same = image_.at(other, bin + static_cast<std::int64_t>(k));
        const bool both_ways = other < row && !state_.masks[other].by_bins;
        const int first = both_ways ? -mask.before : other > row && other != compared ? 0 : 1;
        state_.work += static_cast<std::size_t>(mask.before + 1 - first) * kWorkOfRegister;
        for (int before = first; before <= mask.before; ++before) compareBinsWith(own, same.from(-before));
      }
    }
  }

  /// Consecutive bins of a row.
  struct Registers {
    HWY_INLINE explicit Registers(const RowBins& bins)
        : x(hn::LoadU(kFloats, bins.x())),
          y(hn::LoadU(kFloats, bins.y())),
          z(hn::LoadU(kFloats, bins.z())),
          element(hn::LoadU(kWords, bins.element())) {}
    FloatVector x, y, z;
    hn::Vec<Words> element;
  };

  HWY_INLINE void compareBinsWith(const Registers& own, const RowBins& bins) {
    const Registers others(bins);
    const FloatMask near = areNeighbours(hn::Sub(own.x, others.x), hn::Sub(own.y, others.y), hn::Sub(own.z, others.z),
                                         hn::Set(kFloats, image_.tolerance.squared()));
    const FloatMask unlike = hn::RebindMask(kFloats, hn::Ne(own.element, others.element));
    std::uint32_t left = bitsOf(hn::And(near, unlike));
    if (left == 0) return;
    std::uint32_t elements[kLanes];
    hn::StoreU(own.element, kWords, elements);
    for (; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(__builtin_ctz(left));
      const std::uint32_t a = elements[i];
      const std::uint32_t b = bins.element()[i];
      if (a == last_a_ && b == last_b_) continue;
      last_a_ = a;
      last_b_ = b;
      subclusters_.merge(a, b);
    }
  }

  /// Calls visit with each of a row's segments. It may change the segment's root.
  template <typename Visit>
  void forEachSegment(const RangeImage& image, Sector& sector, std::size_t row, Visit&& visit) {
    const NeighborMask& mask = state_.masks[row];
    Segment segment{};
    for (std::uint32_t i = sector.begin[row]; i < sector.begin[row + 1]; ++i) {
      const float reach = image_.reach + 1e-6F * sector.farthest[i];
      segment.before = mask.before;
      segment.first_row = mask.first_row;
      segment.last_row = mask.last_row;
      if (sector.nearest[i] > kWorthNarrowing * mask.nearest) narrow(row, sector.nearest[i], segment);
      const auto bins = static_cast<float>(segment.before);
      segment.index = i;
      segment.root = subclusters_.find(sector.root[i]);
      segment.returns = returnsOf(image, sector, i);
      segment.nearest = sector.nearest[i] - reach;
      segment.farthest = sector.farthest[i] + reach;
      segment.lowest = sector.lowest[i] - reach;
      segment.highest = sector.highest[i] + reach;
      segment.first = sector.first[i] - bins;
      segment.last = sector.last[i] + bins;
      state_.work += kWorkOfSegment;
      visit(segment);
      sector.root[i] = segment.root;
    }
  }

  int binsWithin(float angle) const {
    return std::min(kMaxReach, static_cast<int>(angle * bins_per_radian_ + (2 * image_.deviation + 0.02F)));
  }

  /// Narrows the mask of a segment that is further away than the nearest of its row, for which the mask was made.
  void narrow(std::size_t row, float nearest, Segment& segment) const {
    segment.before = binsWithin(asinBound(image_.reach / nearest));
    const float top = topOf(row, nearest);
    const float bottom = bottomOf(row, nearest);
    while (segment.first_row < row && image_.lowest_above[segment.first_row] > top) ++segment.first_row;
    while (segment.last_row > row && image_.highest_below[segment.last_row] < bottom) --segment.last_row;
  }

  /// The highest and the lowest elevation of neighbours of a row's returns from a distance on.
  float topOf(std::size_t row, float nearest) const {
    return image_.highest[row] + asinBound(image_.slope_reach / nearest) + kAngleRounding;
  }
  float bottomOf(std::size_t row, float nearest) const {
    return image_.lowest[row] - asinBound(image_.slope_reach / nearest) - kAngleRounding;
  }

  /// Sets the rows whose elevations come within reach of this one's: lambda of Algorithm 2.
  void reachRows(std::size_t row, float nearest, NeighborMask& mask) {
    const float top = topOf(row, nearest);
    const float bottom = bottomOf(row, nearest);
    const auto last_of_all = image_.rows.size() - 1;
    std::size_t first = row - std::min<std::size_t>(row, mask.above);
    while (first > 0 && image_.lowest_above[first - 1] <= top) --first;
    while (first < row && image_.lowest_above[first] > top) ++first;
    std::size_t last = std::min<std::size_t>(last_of_all, row + mask.below);
    while (last < last_of_all && image_.highest_below[last + 1] >= bottom) ++last;
    while (last > row && image_.highest_below[last] < bottom) --last;
    mask.above = static_cast<std::uint32_t>(row - first);
    mask.below = static_cast<std::uint32_t>(last - row);
    mask.first_row = static_cast<std::uint32_t>(first);
    mask.last_row = static_cast<std::uint32_t>(last);
  }

  /// cluster (p) of Algorithm 4 for a segment: compares it with the segments of a sector within its mask.
  /// \param limit only with those before this one
  HWY_INLINE void search(Segment& segment, Sector& other, std::uint32_t limit) {
    const std::uint32_t begin = other.begin[segment.first_row];
    const std::uint32_t end = std::min(limit, other.begin[segment.last_row + 1]);
    state_.work += 1 + (end - begin) / kLanes;
    static_assert(kLanes <= Sector::kMaxLanes, "there is room behind the last segment");
    for (std::uint32_t i = begin; i < end; i += std::uint32_t{kLanes}) {
      const auto load = [&](const GrowingArray<float>& bound) { return hn::LoadU(kFloats, &bound[i]); };
      const auto all = [](float value) { return hn::Set(kFloats, value); };
      const FloatMask range = hn::And(hn::Le(load(other.nearest), all(segment.farthest)),
                                      hn::Ge(load(other.farthest), all(segment.nearest)));
      // Most segments nearby are in the same subcluster already.
      const FloatMask apart = hn::And(range, differ(&other.root[i], hn::Set(kWords, segment.root)));
      std::uint32_t left = bitsOf(apart) & lanesBelow(end - i);
      if (left == 0) continue;
      const FloatMask height =
          hn::And(hn::Le(load(other.lowest), all(segment.highest)), hn::Ge(load(other.highest), all(segment.lowest)));
      const FloatMask bins =
          hn::And(hn::Le(load(other.first), all(segment.last)), hn::Ge(load(other.last), all(segment.first)));
      left &= bitsOf(hn::And(height, bins));
      for (; left != 0; left &= left - 1) {
        const std::uint32_t candidate = i + static_cast<std::uint32_t>(__builtin_ctz(left));
        const std::uint32_t other_root = subclusters_.find(other.root[candidate]);
        other.root[candidate] = other_root;
        if (other_root == segment.root) continue;
        state_.work += kWorkOfPair;
        if (haveNeighbours(segment.returns, returnsOf(image_, other, candidate), image_.tolerance))
          other.root[candidate] = segment.root = subclusters_.merge(segment.root, other_root);
      }
    }
  }

  const RangeImage& image_;
  SegmentLinkerState& state_;
  DisjointSets& subclusters_;
  float bins_per_radian_;
  std::uint32_t last_a_ = ~std::uint32_t{0};  ///< the last two that were joined
  std::uint32_t last_b_ = ~std::uint32_t{0};
};

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#endif
