// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/far/segment_linker.h"

#include <algorithm>
#include <cmath>

#include "core/far/constants.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/far/segment_linker.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/far/segment_search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Joins neighbours in the same bin of adjacent lasers' first rows.
void linkSameBins(const RangeImage& image, std::size_t begin, std::size_t end, const RangeImage::Rows& rows,
                  DisjointSets& subclusters) {
  const FloatVector r2 = hn::Set(kFloats, image.tolerance.squared());
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const std::size_t next = image.rowInSameBins(row);
    if (next == RangeImage::kNoRow || !image.rows[row].is_open || !image.rows[next].is_open) continue;
    const RowBins upper = image.at(row, 0);
    const RowBins lower = image.at(next, 0);
    // Pairs of the same two runs need one merge.
    std::uint32_t above = ~std::uint32_t{0};
    std::uint32_t below = ~std::uint32_t{0};
    for (std::size_t k = begin; k < end; k += kLanes) {
      const auto apart = [k](const float* a, const float* b) {
        return hn::Sub(hn::LoadU(kFloats, a + k), hn::LoadU(kFloats, b + k));
      };
      std::uint32_t left = bitsOf(
          areNeighbours(apart(upper.x(), lower.x()), apart(upper.y(), lower.y()), apart(upper.z(), lower.z()), r2));
      while (left != 0) {
        left &= bitsOf(hn::Or(differ(upper.element() + k, hn::Set(kWords, above)),
                              differ(lower.element() + k, hn::Set(kWords, below))));
        if (left == 0) break;
        const auto i = static_cast<std::size_t>(__builtin_ctz(left));
        above = upper.element()[k + i];
        below = lower.element()[k + i];
        subclusters.merge(above, below);
      }
    }
  }
}

void linkBins(const RangeImage& image, SegmentLinkerState& state, std::size_t begin, std::size_t end,
              DisjointSets& subclusters) {
  linkSameBins(image, begin, end, image.allRows(), subclusters);
  SegmentSearch search(image, state, subclusters);
  for (std::size_t bin = begin; bin < end; bin += RangeImage::kSector) {
    const auto sector = static_cast<std::int64_t>(bin / RangeImage::kSector);
    search.prepareSector(sector, image.allRows());
    search.linkSector(sector, 0, 1);
  }
}

/// One of the parts of linkBins for a sector, in order.
void linkPartOfSector(const RangeImage& image, SegmentLinkerState& state, std::size_t bin, std::size_t part,
                      DisjointSets& subclusters) {
  constexpr std::size_t kSame = 8;
  constexpr std::size_t kPrepare = 8;
  constexpr std::size_t kLink = SegmentLinkerState::kParts - kSame - kPrepare;
  const auto sector = static_cast<std::int64_t>(bin / RangeImage::kSector);
  SegmentSearch search(image, state, subclusters);
  if (part < kSame) {
    const RangeImage::Rows rows = image.someRows(part, kSame);
    linkSameBins(image, bin, bin + RangeImage::kSector, rows, subclusters);
    state.work += (rows.end - rows.begin) * kWorkOfSameBins;
  } else if (part < kSame + kPrepare) {
    const RangeImage::Rows rows = image.someRows(part - kSame, kPrepare);
    search.prepareSector(sector, rows);
    state.work += (rows.end - rows.begin) * kWorkOfCutting;
  } else {
    search.linkSector(sector, part - kSame - kPrepare, kLink);
  }
}

void linkAcross(const RangeImage& image, SegmentLinkerState& state, const RangeImage& other, double later,
                DisjointSets& subclusters) {
  SegmentSearch(image, state, subclusters).linkAcross(other, later);
}

/// Calls visit(row) for each open row with returns between two elevations, perhaps.
template <typename Visit>
void forEachRowWithin(const RangeImage& image, float lowest, float highest, Visit&& visit) {
  const auto visitOpen = [&](std::size_t row) {
    if (image.rows[row].is_open) visit(row);
  };
  const std::size_t rows = image.rows.size();
  std::size_t k = 0;
  for (; k + kLanes <= rows; k += kLanes) {
    const FloatMask within = hn::And(hn::Le(hn::LoadU(kFloats, &image.lowest[k]), hn::Set(kFloats, highest)),
                                     hn::Ge(hn::LoadU(kFloats, &image.highest[k]), hn::Set(kFloats, lowest)));
    forEachBit(bitsOf(within), [&](std::size_t i) { visitOpen(k + i); });
  }
  for (; k < rows; ++k)
    if (image.lowest[k] <= highest && image.highest[k] >= lowest) visitOpen(k);
}

/// Compares one return with all bins that may hold its neighbours.
void searchOne(const RangeImage& image, const RangeImage::Unplaced& point, DisjointSets& subclusters) {
  const float east = point.x - image.range.origin[0];
  const float north = point.y - image.range.origin[1];
  const float rho = std::sqrt(east * east + north * north);
  const auto turn = static_cast<std::int64_t>(image.steps);
  const std::int64_t bin = image.binOf(image.fromStart(east, north)) % turn;
  const std::int64_t middle = bin < 0 ? bin + turn : bin;
  const float angle = asinBound(image.reach / rho);
  const auto before = static_cast<std::int64_t>(angle / image.radians_per_bin + (image.deviation + 1.0F));
  const float slope = std::atan(image.heightOf(east, north, point.z - image.range.origin[2]) / rho);
  const float elevation = image.upside_down ? -slope : slope;
  const float around = asinBound(image.slope_reach / rho) + kAngleRounding;
  const FloatVector x = hn::Set(kFloats, point.x);
  const FloatVector y = hn::Set(kFloats, point.y);
  const FloatVector z = hn::Set(kFloats, point.z);
  const FloatVector r2 = hn::Set(kFloats, image.tolerance.squared());
  const auto last = static_cast<std::int64_t>(image.end) - 1;
  for (const std::int64_t center : {middle - turn, middle, middle + turn}) {
    const std::int64_t from = std::max<std::int64_t>(0, center - before);
    const std::int64_t to = std::min(last, center + before);
    if (from > to) continue;
    forEachRowWithin(image, elevation - around, elevation + around, [&](std::size_t row) {
      // Bins behind the last one are free.
      const RowBins bins = image.at(row, from);
      for (std::int64_t k = 0; k <= to - from; k += std::int64_t{kLanes}) {
        const FloatMask near =
            areNeighbours(hn::Sub(hn::LoadU(kFloats, bins.x() + k), x), hn::Sub(hn::LoadU(kFloats, bins.y() + k), y),
                          hn::Sub(hn::LoadU(kFloats, bins.z() + k), z), r2);
        for (std::uint32_t left = bitsOf(near); left != 0; left &= left - 1)
          subclusters.merge(point.element, bins.element()[k + __builtin_ctz(left)]);
      }
    });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(linkBins);
HWY_EXPORT(linkPartOfSector);
HWY_EXPORT(linkAcross);
HWY_EXPORT(searchOne);

}  // namespace

void SegmentLinker::prepare(const RangeImage& image) {
  linked_parts_ = 0;
  work = 0;
  masks.clear();
  fit(image);
}

/// Adapts to the rows of the image, and to their order.
void SegmentLinker::fit(const RangeImage& image) {
  const std::size_t count = image.rows.size();
  if (masks.size() == count && times_reordered_ == image.times_reordered) return;
  times_reordered_ = image.times_reordered;
  linked_parts_ = 0;  // of a sector with other rows
  masks.assign(count, NeighborMask());
  for (Sector& sector : sectors) sector.resize(count);
  beyond.resize(count);
}

void Sector::grow(std::size_t segments) {
  const std::size_t size = withSpare(segments);  // of all arrays, of which the large ones round it up
  for (auto* bound : {&nearest, &farthest, &lowest, &highest, &first, &last}) bound->grow(size);
  root.grow(size);
  place.grow(size);
  count.grow(size);
}

/// Sectors are cut again: returns may have come late, or will come.
void SegmentLinker::forgetSectors() {
  for (Sector& sector : sectors) sector.number = Sector::kNone;
}

void SegmentLinker::schedule(RangeImage& image) {
  if (!image.started) return;
  image.sortLasers();
  fit(image);
  if (image.late.size() > kFewLate) {
    // The next turn of a long scan: linking starts again.
    image.linked = image.scheduled = 0;
    image.late.clear();
    linked_parts_ = 0;
    forgetSectors();
  }
  image.updateElevations();
  image.scheduled = std::max(image.scheduled, image.passed());
}

std::size_t SegmentLinker::linkPart(RangeImage& image, DisjointSets& subclusters) {
  fit(image);
  if (image.lowest.size() < image.rows.size()) image.updateElevations();  // rows were added since schedule ()
  const std::size_t before = work;
  HWY_DYNAMIC_DISPATCH(linkPartOfSector)(image, *this, image.linked, linked_parts_, subclusters);
  if (++linked_parts_ == kParts) {
    linked_parts_ = 0;
    image.linked += RangeImage::kSector;
  }
  return work - before;
}

void SegmentLinker::link(RangeImage& image, DisjointSets& subclusters) {
  schedule(image);
  while (linked_parts_ > 0) linkPart(image, subclusters);
  if (image.linked < image.scheduled)
    HWY_DYNAMIC_DISPATCH(linkBins)(image, *this, image.linked, image.scheduled, subclusters);
  image.linked = image.scheduled;
}

void SegmentLinker::linkRest(RangeImage& image, DisjointSets& subclusters) {
  if (!image.started) return;
  link(image, subclusters);
  if (image.end > image.linked) HWY_DYNAMIC_DISPATCH(linkBins)(image, *this, image.linked, image.end, subclusters);
  if (!image.late.empty()) forgetSectors();
  for (const RangeImage::Unplaced& late : image.late) HWY_DYNAMIC_DISPATCH(searchOne)(image, late, subclusters);
  image.late.clear();
}

void SegmentLinker::linkOverlap(const RangeImage& image, const RangeImage& other, double ahead, bool is_own,
                                DisjointSets& subclusters) {
  if (!is_own) forgetSectors();
  fit(image);
  HWY_DYNAMIC_DISPATCH(linkAcross)(image, *this, other, ahead, subclusters);
  forgetSectors();
}

void SegmentLinker::linkUnplaced(const RangeImage& image, const RangeImage::Unplaced& unplaced,
                                 DisjointSets& subclusters) {
  HWY_DYNAMIC_DISPATCH(searchOne)(image, unplaced, subclusters);
}

}  // namespace lisco
#endif
