// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Cuts sectors of a range image into segments; compiled once for each SIMD level.
#if defined(LISCO_SECTOR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LISCO_SECTOR_INL_H
#undef LISCO_SECTOR_INL_H
#else
#define LISCO_SECTOR_INL_H
#endif

#include <algorithm>
#include <limits>

#include "core/bits.h"
#include "core/disjoint_sets.h"
#include "core/far/constants.h"
#include "core/far/range_image.h"
#include "core/far/segment_linker.h"
#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Horizontal distances in the bins of a row in a sector; NaN where there is no return.
struct SectorRho {
  HWY_INLINE SectorRho(const RangeImage& image, const RowBins& bins) {
    for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
      const FloatVector east = hn::Sub(hn::LoadU(kFloats, bins.x() + k), hn::Set(kFloats, image.range.origin[0]));
      const FloatVector north = hn::Sub(hn::LoadU(kFloats, bins.y() + k), hn::Set(kFloats, image.range.origin[1]));
      hn::StoreU(hn::Sqrt(hn::Add(hn::Mul(east, east), hn::Mul(north, north))), kFloats, of + k);
    }
  }
  float of[RangeImage::kSector];
};

/// Bounds the segments of a row.
/// \param returns bit i: bin i of the sector
/// \param starts the first ones of segments
/// \param segment number of the row's first one
/// \return the least distance in the row
HWY_INLINE float boundRow(Sector& sector, std::size_t row, const RowBins& bins, const SectorRho& rho,
                          ColumnBits returns, ColumnBits starts, std::uint32_t segment, DisjointSets& subclusters) {
  const float offset = static_cast<float>(sector.first_bin) + sector.later;
  const ColumnBits ends = ~returns | starts;
  float nearest_of_all = std::numeric_limits<float>::infinity();
  for (; starts != 0; starts &= starts - 1, ++segment) {
    const auto first = static_cast<std::uint32_t>(__builtin_ctzll(starts));
    const auto end = static_cast<std::uint32_t>(endOfChain(ends, first));
    float nearest = rho.of[first];
    float farthest = nearest;
    float lowest = bins.z()[first];
    float highest = lowest;
    if (end - first > 1) {
      FloatVector low_rho = hn::Set(kFloats, nearest);
      FloatVector high_rho = low_rho;
      FloatVector low_z = hn::Set(kFloats, lowest);
      FloatVector high_z = low_z;
      const ColumnBits lanes = bitsFrom(first) & ~bitsFrom(end);
      for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
        const FloatMask inside = lanesOf(lanes >> k);
        const FloatVector rho_here = hn::LoadU(kFloats, rho.of + k);
        const FloatVector z_here = hn::LoadU(kFloats, bins.z() + k);
        low_rho = hn::IfThenElse(inside, hn::Min(low_rho, rho_here), low_rho);
        high_rho = hn::IfThenElse(inside, hn::Max(high_rho, rho_here), high_rho);
        low_z = hn::IfThenElse(inside, hn::Min(low_z, z_here), low_z);
        high_z = hn::IfThenElse(inside, hn::Max(high_z, z_here), high_z);
      }
      nearest = hn::GetLane(hn::MinOfLanes(kFloats, low_rho));
      farthest = hn::GetLane(hn::MaxOfLanes(kFloats, high_rho));
      lowest = hn::GetLane(hn::MinOfLanes(kFloats, low_z));
      highest = hn::GetLane(hn::MaxOfLanes(kFloats, high_z));
    }
    nearest_of_all = std::min(nearest_of_all, nearest);
    sector.nearest[segment] = nearest;
    sector.farthest[segment] = farthest;
    sector.lowest[segment] = lowest;
    sector.highest[segment] = highest;
    sector.first[segment] = offset + static_cast<float>(first);
    sector.last[segment] = offset + static_cast<float>(end - 1);
    sector.root[segment] = subclusters.find(bins.element()[first]);
    sector.place[segment] = static_cast<std::uint32_t>(row * RangeImage::kSector) + first;
    sector.count[segment] = static_cast<std::uint8_t>(end - first);
  }
  return nearest_of_all;
}

/// Cuts the runs in a sector's bins of some rows into segments. Ranges of rows follow each other, from the first on.
/// \param later see Sector
/// \param masks nullptr, or of the rows in the sector before: where bins were compared, segments are not bounded yet
void cutSector(const RangeImage& image, std::int64_t number, float later, const RangeImage::Rows& rows,
               const NeighborMask* masks, Sector& sector, DisjointSets& subclusters) {
  const std::int64_t first_bin = number * static_cast<std::int64_t>(RangeImage::kSector);
  sector.number = Sector::kNone;
  sector.first_bin = first_bin;
  sector.later = later;
  if (rows.begin == 0) std::fill(sector.unbounded.begin(), sector.unbounded.end(), 0);
  std::uint32_t count = rows.begin == 0 ? 0 : sector.begin[rows.begin];
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    sector.begin[row] = count;
    if (!image.rows[row].is_open) continue;
    const RowBins bins = image.at(row, first_bin);
    ColumnBits returns = 0;
    for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
      const FloatVector x = hn::LoadU(kFloats, bins.x() + k);
      returns |= ColumnBits{bitsOf(hn::Eq(x, x))} << k;
    }
    if (returns == 0) continue;
    sector.reserveRow(count);
    const SectorRho rho(image, bins);
    ColumnBits starts = 0;
    for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
      const FloatMask changes = differ(bins.element() + k - 1, hn::LoadU(kWords, bins.element() + k));
      starts |= ColumnBits{bitsOf(changes)} << k;
    }
    starts = returns & (starts | ~(returns << 1));
    Sector::Row& found = sector.rows[row];
    if (masks != nullptr && masks[row].by_bins) {
      FloatVector nearest = hn::Set(kFloats, std::numeric_limits<float>::infinity());
      for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
        const FloatVector here = hn::LoadU(kFloats, rho.of + k);
        nearest = hn::IfThenElse(hn::Lt(here, nearest), here, nearest);
      }
      found = {hn::GetLane(hn::MinOfLanes(kFloats, nearest)), static_cast<std::uint16_t>(returns),
               static_cast<std::uint16_t>(starts)};
      sector.unbounded[row / 64] |= std::uint64_t{1} << row % 64;
    } else {
      found.nearest = boundRow(sector, row, bins, rho, returns, starts, count, subclusters);
    }
    count += countBits(starts);
  }
  sector.begin[rows.end] = count;
  if (rows.end == image.rows.size()) sector.number = number;
}

/// Bounds the segments of a row that cutSector () has left unbounded.
void boundSegments(const RangeImage& image, Sector& sector, std::size_t row, DisjointSets& subclusters) {
  const RowBins bins = image.at(row, sector.first_bin);
  const Sector::Row& found = sector.rows[row];
  boundRow(sector, row, bins, SectorRho(image, bins), found.returns, found.starts, sector.begin[row], subclusters);
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#endif
