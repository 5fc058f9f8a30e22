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

#include "core/bits.h"
#include "core/disjoint_sets.h"
#include "core/far/constants.h"
#include "core/far/range_image.h"
#include "core/far/segment_linker.h"
#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Cuts the runs in a sector's bins of some rows into segments. Ranges of rows follow each other, from the first on.
/// \param later added to bin numbers
void cutSector(const RangeImage& image, std::int64_t number, float later, const RangeImage::Rows& rows, Sector& sector,
               DisjointSets& subclusters) {
  const std::int64_t first_bin = number * static_cast<std::int64_t>(RangeImage::kSector);
  const float offset = static_cast<float>(first_bin) + later;
  sector.number = Sector::kNone;
  sector.first_bin = first_bin;
  std::uint32_t count = rows.begin == 0 ? 0 : sector.begin[rows.begin];
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    sector.begin[row] = count;
    if (!image.rows[row].is_open) continue;
    const RowBins bins = image.at(row, first_bin);
    ColumnBits returns = 0;  // bit i: bin i of the sector
    for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
      const FloatVector x = hn::LoadU(kFloats, bins.x() + k);
      returns |= ColumnBits{bitsOf(hn::Eq(x, x))} << k;
    }
    if (returns == 0) continue;
    sector.reserveRow(count);
    float rho[RangeImage::kSector];
    ColumnBits starts = 0;
    for (std::size_t k = 0; k < RangeImage::kSector; k += kLanes) {
      const FloatVector x = hn::LoadU(kFloats, bins.x() + k);
      const FloatVector east = hn::Sub(x, hn::Set(kFloats, image.range.origin[0]));
      const FloatVector north = hn::Sub(hn::LoadU(kFloats, bins.y() + k), hn::Set(kFloats, image.range.origin[1]));
      hn::StoreU(hn::Sqrt(hn::Add(hn::Mul(east, east), hn::Mul(north, north))), kFloats, rho + k);
      const FloatMask changes = differ(bins.element() + k - 1, hn::LoadU(kWords, bins.element() + k));
      starts |= ColumnBits{bitsOf(changes)} << k;
    }
    starts = returns & (starts | ~(returns << 1));
    const ColumnBits ends = ~returns | starts;
    for (; starts != 0; starts &= starts - 1) {
      const auto first = static_cast<std::uint32_t>(__builtin_ctzll(starts));
      const auto end = static_cast<std::uint32_t>(endOfChain(ends, first));
      float nearest = rho[first];
      float farthest = rho[first];
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
          const FloatVector rho_here = hn::LoadU(kFloats, rho + k);
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
      sector.nearest[count] = nearest;
      sector.farthest[count] = farthest;
      sector.lowest[count] = lowest;
      sector.highest[count] = highest;
      sector.first[count] = offset + static_cast<float>(first);
      sector.last[count] = offset + static_cast<float>(end - 1);
      sector.root[count] = subclusters.find(bins.element()[first]);
      sector.place[count] = static_cast<std::uint32_t>(row * RangeImage::kSector) + first;
      sector.count[count] = static_cast<std::uint8_t>(end - first);
      ++count;
    }
  }
  sector.begin[rows.end] = count;
  if (rows.end == image.rows.size()) sector.number = number;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#endif
