// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/view_strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "view_strip.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "lanes-inl.h"

#ifndef LISCO_VIEW_STRIP_CONSTANTS
#define LISCO_VIEW_STRIP_CONSTANTS
namespace lisco {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A return stands at most this many places from where its azimuth is; half a place is the least possible.
constexpr float kDeviation = 0.75F;
constexpr int kMostReach = 48;           // places; far returns never reach further
constexpr float kAngleRounding = 1e-4F;  // radians, on elevations; far more than their rounding
constexpr float kFarEnd = 1e15F;         // what is further away is not far but elsewhere: its squares may overflow
// With more loose returns than this, no more are placed: each loose one is searched for again whenever somebody asks.
constexpr std::size_t kFewLoose = 4096;
constexpr std::size_t kPlacedPerLoose = 32;
constexpr std::size_t kFewestSteps = 512;  // so that all places are less than two turns, and the seam is one
constexpr std::size_t kMostSteps = 16384;

// From where on returns are far: where about this many of a flat surface's lie in a square of the tolerance's size. Fewer
// if the returns of a laser do not form runs: then segments are short, and there are too many in a window.
constexpr double kReturnsPerSquare = 400.0;
constexpr double kRoughReturnsPerSquare = 60.0;
// What it costs to look for a segment's neighbours in a sector, in comparisons of registers of places.
constexpr std::uint32_t kSegmentCost = 2;
// Work, where it is done in parts: about 5 ns each.
constexpr std::uint32_t kWorkOfSamePlaces = 12;  // of a laser
constexpr std::uint32_t kWorkOfCutting = 20;     // of a laser
constexpr std::uint32_t kWorkOfPlaces = 2;       // of comparing a register of places
constexpr std::uint32_t kWorkOfSegment = 10;
constexpr std::uint32_t kWorkOfPair = 6;  // of segments that are compared
constexpr double kLeastNearEnd = 2.5;     // in units of the tolerance

/// An upper bound on asin (ratio), 0 <= ratio < 1.
inline float asinBound(float ratio) {
  return (ratio + 0.5708F * ratio * ratio * ratio) * 1.00001F;
}

/// All bits before the first that is set; all of them if none is.
inline std::uint64_t upTo(std::uint64_t bits) {
  return bits != 0 ? (bits & -bits) - 1 : ~std::uint64_t{0};
}

}  // namespace
}  // namespace lisco
#endif

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Whether a lane's azimuth is the place's, within kDeviation.
HWY_INLINE FloatMask standsAt(const StripData& strip, std::int64_t place, FloatVector u, FloatVector v,
                              FloatVector rho) {
  const auto index = static_cast<std::size_t>(place + static_cast<std::int64_t>(StripData::kMargin));
  const FloatVector cosine = hn::LoadU(kFloats, &strip.cosine[index]);
  const FloatVector sine = hn::LoadU(kFloats, &strip.sine[index]);
  const FloatVector across = hn::Abs(hn::Sub(hn::Mul(u, sine), hn::Mul(v, cosine)));
  const FloatVector along = hn::Add(hn::Mul(u, cosine), hn::Mul(v, sine));
  const FloatVector deviation = hn::Set(kFloats, std::sin(kDeviation * strip.radians_per_place));
  return hn::And(hn::Le(across, hn::Mul(rho, deviation)), hn::Gt(along, hn::Zero(kFloats)));
}

/// Stores some returns of a row, the first cell's place given, where places are free.
/// \return those whose places are taken
std::uint64_t store(StripData& strip, const Row& row, const MeasuredRow& measured, std::size_t laser,
                    std::int64_t first_place, std::uint64_t which) {
  std::uint64_t taken = 0;
  const std::size_t cell = strip.at(laser, first_place);
  for (std::size_t k = 0; k < Row::kColumns; k += kLanes) {
    const std::uint64_t here = which >> k & ((std::uint64_t{1} << kLanes) - 1);
    if (here == 0) continue;
    const FloatVector there = hn::LoadU(kFloats, &strip.x[cell + k]);
    const std::uint64_t is_free = bitsOf(hn::IsNaN(there)) & here;
    taken |= (here & ~is_free) << k;
    std::uint8_t bytes[8];
    std::memcpy(bytes, &is_free, sizeof bytes);
    const FloatMask mask = hn::LoadMaskBits(kFloats, bytes);
    hn::BlendedStore(hn::LoadU(kFloats, row.x + Row::kMargin + k), mask, kFloats, &strip.x[cell + k]);
    hn::BlendedStore(hn::LoadU(kFloats, row.y + Row::kMargin + k), mask, kFloats, &strip.y[cell + k]);
    hn::BlendedStore(hn::LoadU(kFloats, row.z + Row::kMargin + k), mask, kFloats, &strip.z[cell + k]);
    hn::BlendedStore(hn::LoadU(kWords, measured.run + k), hn::RebindMask(kWords, mask), kWords,
                     &strip.element[cell + k]);
  }
  return taken;
}

std::uint64_t placeReturns(StripData& strip, const Row& row, const MeasuredRow& measured, std::size_t laser_number,
                           std::uint32_t first_column) {
  StripData::Placing& placing = strip.placing;
  StripData::Laser& laser = strip.lasers[laser_number];
  const auto places = static_cast<std::int64_t>(strip.places);
  const auto turn = static_cast<std::int64_t>(strip.steps);
  const auto margin = static_cast<std::int64_t>(StripData::kMargin);
  const auto most = margin - 1;  // of places before the first and behind the last that have memory
  float u[Row::kColumns];
  float v[Row::kColumns];
  for (std::size_t k = 0; k < Row::kColumns; k += kLanes) {
    if ((measured.far >> k & ((std::uint64_t{1} << kLanes) - 1)) == 0) continue;
    const FloatVector east =
        hn::Sub(hn::LoadU(kFloats, row.x + Row::kMargin + k), hn::Set(kFloats, strip.range.origin[0]));
    const FloatVector north =
        hn::Sub(hn::LoadU(kFloats, row.y + Row::kMargin + k), hn::Set(kFloats, strip.range.origin[1]));
    const FloatVector cosine = hn::Set(kFloats, strip.start_cosine);
    const FloatVector sine = hn::Set(kFloats, strip.start_sine);
    const FloatVector direction = hn::Set(kFloats, strip.direction);
    hn::StoreU(hn::Add(hn::Mul(east, cosine), hn::Mul(north, sine)), kFloats, u + k);
    hn::StoreU(hn::Mul(direction, hn::Sub(hn::Mul(north, cosine), hn::Mul(east, sine))), kFloats, v + k);
  }

  // Where the row's first cell stands if this laser's returns go on as before.
  std::int64_t first_place = laser.next_place == StripData::kNowhere
                                 ? margin + first_column - std::int64_t{strip.first_column}
                                 : laser.next_place + first_column - std::int64_t{laser.next_column};
  std::uint64_t loose = 0;
  std::uint64_t left = measured.far;
  while (left != 0) {
    // The returns from here on that stand where they are expected go to their places together.
    const auto next = static_cast<std::size_t>(__builtin_ctzll(left));
    std::uint64_t astray = left;
    if (first_place >= -most && first_place <= places - 1 + most) {
      astray = 0;
      for (std::size_t k = next / kLanes * kLanes; k < Row::kColumns && astray == 0; k += kLanes) {
        const std::uint64_t here = left >> k & ((std::uint64_t{1} << kLanes) - 1);
        if (here == 0) continue;
        const FloatMask stands = standsAt(strip, first_place + static_cast<std::int64_t>(k), hn::LoadU(kFloats, u + k),
                                          hn::LoadU(kFloats, v + k), hn::LoadU(kFloats, measured.rho + k));
        astray = (here & ~std::uint64_t{bitsOf(stands)}) << k;
      }
      // Places before the first and behind the last are nobody's.
      if (first_place < 0) {
        const std::uint64_t before = (std::uint64_t{1} << -first_place) - 1;
        loose |= left & before & upTo(astray);
      }
      if (first_place + static_cast<std::int64_t>(Row::kColumns) > places) {
        const std::int64_t inside = places - first_place;
        const std::uint64_t behind = inside <= 0 ? ~std::uint64_t{0} : ~std::uint64_t{0} << inside;
        loose |= left & behind & upTo(astray);
      }
    }
    const std::uint64_t together = left & upTo(astray);
    if (together != 0) {
      const std::uint64_t placed = together & ~loose;
      if (placed != 0) {
        loose |= store(strip, row, measured, laser_number, first_place, placed);
        const auto last = static_cast<std::int64_t>(63 - __builtin_clzll(placed));
        placing.placed += static_cast<std::size_t>(__builtin_popcountll(placed & ~loose));
        placing.begin = std::min(placing.begin, static_cast<std::size_t>(first_place + __builtin_ctzll(placed)));
        placing.end = std::max(placing.end, static_cast<std::size_t>(first_place + last + 1));
        if (first_place + static_cast<std::int64_t>(next) < static_cast<std::int64_t>(strip.claimed))
          for (std::uint64_t some = placed & ~loose; some != 0; some &= some - 1) {
            const auto i = static_cast<std::size_t>(__builtin_ctzll(some));
            if (first_place + static_cast<std::int64_t>(i) >= static_cast<std::int64_t>(strip.claimed)) break;
            placing.late.push_back(
                {row.x[Row::kMargin + i], row.y[Row::kMargin + i], row.z[Row::kMargin + i], measured.run[i]});
          }
      }
      const auto last = static_cast<std::int64_t>(63 - __builtin_clzll(together));
      laser.next_place = first_place + last + 1;
      laser.next_column = first_column + static_cast<std::uint32_t>(last) + 1;
      left &= ~together;
    }
    if (left == 0) break;
    // The next one tells where those behind it are.
    const auto i = static_cast<std::size_t>(__builtin_ctzll(left));
    const std::int64_t measured_place = strip.placeOf({u[i], v[i]});
    const std::int64_t expected = first_place + static_cast<std::int64_t>(i);
    const std::int64_t turns = std::llround(static_cast<double>(expected - measured_place) / static_cast<double>(turn));
    const std::int64_t own_place = measured_place + turn * turns;
    first_place = own_place - static_cast<std::int64_t>(i);
    if (own_place < 0 || own_place >= places) {
      loose |= std::uint64_t{1} << i;
      left &= left - 1;
      laser.next_place = own_place + 1;
      laser.next_column = first_column + static_cast<std::uint32_t>(i) + 1;
    }
  }
  return loose;
}

/// Compares the returns of some lasers with those of the next laser at the same place.
void linkSamePlaces(const StripData& strip, std::size_t begin, std::size_t end, const StripData::Lasers& lasers,
                    DisjointSets& subclusters) {
  const FloatVector r2 = hn::Set(kFloats, strip.tolerance.squared());
  for (std::size_t laser = lasers.begin; laser < lasers.end && laser + 1 < strip.lasers.size(); ++laser) {
    if (strip.lasers[laser].next_place == StripData::kNowhere ||
        strip.lasers[laser + 1].next_place == StripData::kNowhere)
      continue;
    const std::size_t upper = strip.at(laser, 0);
    const std::size_t lower = strip.at(laser + 1, 0);
    // Pairs of the same two runs need one merge.
    std::uint32_t above = ~std::uint32_t{0};
    std::uint32_t below = ~std::uint32_t{0};
    for (std::size_t k = begin; k < end; k += kLanes) {
      const auto apart = [&](const std::vector<float>& coordinate) {
        return hn::Sub(hn::LoadU(kFloats, &coordinate[upper + k]), hn::LoadU(kFloats, &coordinate[lower + k]));
      };
      std::uint32_t left = bitsOf(areNeighbours(apart(strip.x), apart(strip.y), apart(strip.z), r2));
      while (left != 0) {
        left &= bitsOf(hn::Or(differ(&strip.element[upper + k], hn::Set(kWords, above)),
                              differ(&strip.element[lower + k], hn::Set(kWords, below))));
        if (left == 0) break;
        const auto i = static_cast<std::size_t>(__builtin_ctz(left));
        above = strip.element[upper + k + i];
        below = strip.element[lower + k + i];
        subclusters.merge(above, below);
      }
    }
  }
}

/// Cuts the runs in sixteen places of some lasers into segments. The lasers of a sector are to follow each other.
/// \param later places are counted from so many before the strip's
void cutSector(const StripData& strip, std::int64_t number, float later, const StripData::Lasers& lasers,
               StripData::Sector& sector, DisjointSets& subclusters) {
  const std::int64_t first_place = number * static_cast<std::int64_t>(StripData::kSector);
  const float offset = static_cast<float>(first_place) + later;
  constexpr std::uint32_t kWorthVectors = 6;  // returns
  sector.number = StripData::kNoSector;
  std::uint32_t count = lasers.begin == 0 ? 0 : sector.begin[lasers.begin];
  for (std::size_t laser = lasers.begin; laser < lasers.end; ++laser) {
    sector.begin[laser] = count;
    if (strip.lasers[laser].next_place == StripData::kNowhere) continue;
    const std::size_t cell = strip.at(laser, first_place);
    float rho[StripData::kSector];
    std::uint32_t returns = 0;
    std::uint32_t starts = 0;
    for (std::size_t k = 0; k < StripData::kSector; k += kLanes) {
      const FloatVector x = hn::LoadU(kFloats, &strip.x[cell + k]);
      const FloatVector east = hn::Sub(x, hn::Set(kFloats, strip.range.origin[0]));
      const FloatVector north =
          hn::Sub(hn::LoadU(kFloats, &strip.y[cell + k]), hn::Set(kFloats, strip.range.origin[1]));
      hn::StoreU(hn::Sqrt(hn::Add(hn::Mul(east, east), hn::Mul(north, north))), kFloats, rho + k);
      returns |= bitsOf(hn::Eq(x, x)) << k;
      starts |= bitsOf(differ(&strip.element[cell + k - 1], hn::LoadU(kWords, &strip.element[cell + k]))) << k;
    }
    if (returns == 0) continue;
    starts = returns & (starts | ~(returns << 1));
    const std::uint32_t ends = ~returns | starts;  // and the sector's
    while (starts != 0) {
      const auto first = static_cast<std::uint32_t>(__builtin_ctz(starts));
      starts &= starts - 1;
      const std::uint32_t after = ends & ~((2U << first) - 1) & 0xFFFFU;
      const std::uint32_t end = after != 0 ? static_cast<std::uint32_t>(__builtin_ctz(after))
                                           : static_cast<std::uint32_t>(StripData::kSector);
      float nearest = rho[first];
      float farthest = rho[first];
      float lowest = strip.z[cell + first];
      float highest = lowest;
      if (end - first > kWorthVectors) {
        FloatVector low_rho = hn::Set(kFloats, nearest);
        FloatVector high_rho = low_rho;
        FloatVector low_z = hn::Set(kFloats, lowest);
        FloatVector high_z = low_z;
        const std::uint64_t lanes = ((std::uint64_t{1} << end) - 1) & ~((std::uint64_t{1} << first) - 1);
        for (std::size_t k = 0; k < StripData::kSector; k += kLanes) {
          const std::uint64_t here = lanes >> k;
          std::uint8_t bytes[8];
          std::memcpy(bytes, &here, sizeof bytes);
          const FloatMask inside = hn::LoadMaskBits(kFloats, bytes);
          const FloatVector rho_here = hn::LoadU(kFloats, rho + k);
          const FloatVector z_here = hn::LoadU(kFloats, &strip.z[cell + k]);
          low_rho = hn::IfThenElse(inside, hn::Min(low_rho, rho_here), low_rho);
          high_rho = hn::IfThenElse(inside, hn::Max(high_rho, rho_here), high_rho);
          low_z = hn::IfThenElse(inside, hn::Min(low_z, z_here), low_z);
          high_z = hn::IfThenElse(inside, hn::Max(high_z, z_here), high_z);
        }
        nearest = hn::GetLane(hn::MinOfLanes(kFloats, low_rho));
        farthest = hn::GetLane(hn::MaxOfLanes(kFloats, high_rho));
        lowest = hn::GetLane(hn::MinOfLanes(kFloats, low_z));
        highest = hn::GetLane(hn::MaxOfLanes(kFloats, high_z));
      } else {
        for (std::uint32_t i = first + 1; i < end; ++i) {
          nearest = std::min(nearest, rho[i]);
          farthest = std::max(farthest, rho[i]);
          lowest = std::min(lowest, strip.z[cell + i]);
          highest = std::max(highest, strip.z[cell + i]);
        }
      }
      sector.nearest[count] = nearest;
      sector.farthest[count] = farthest;
      sector.lowest[count] = lowest;
      sector.highest[count] = highest;
      sector.first[count] = offset + static_cast<float>(first);
      sector.last[count] = offset + static_cast<float>(end - 1);
      sector.head[count] = subclusters.head(strip.element[cell + first]);
      sector.cell[count] = static_cast<std::uint32_t>(cell) + first;
      sector.count[count] = static_cast<std::uint8_t>(end - first);
      ++count;
    }
  }
  sector.begin[lasers.end] = count;
  if (lasers.end == strip.lasers.size()) sector.number = number;
}

/// The returns of a segment.
struct Returns {
  const StripData* strip;
  std::size_t cell, count;
};

/// Whether any return of one segment is a neighbour of any return of the other.
bool haveNeighbours(Returns a, Returns b) {
  if (a.count > b.count) std::swap(a, b);
  const FloatVector r2 = hn::Set(kFloats, a.strip->tolerance.squared());
  const std::uint32_t lanes = (1U << b.count) - 1;
  for (std::size_t i = a.cell; i < a.cell + a.count; ++i) {
    const FloatVector x = hn::Set(kFloats, a.strip->x[i]);
    const FloatVector y = hn::Set(kFloats, a.strip->y[i]);
    const FloatVector z = hn::Set(kFloats, a.strip->z[i]);
    for (std::size_t k = 0; k < b.count; k += kLanes) {
      const FloatMask near = areNeighbours(hn::Sub(x, hn::LoadU(kFloats, &b.strip->x[b.cell + k])),
                                           hn::Sub(y, hn::LoadU(kFloats, &b.strip->y[b.cell + k])),
                                           hn::Sub(z, hn::LoadU(kFloats, &b.strip->z[b.cell + k])), r2);
      if ((bitsOf(near) & lanes >> k) != 0) return true;
    }
  }
  return false;
}

/// Finds neighbours of a sector's segments in sectors up to its own place.
class Windows {
 public:
  Windows(const StripData& strip, StripData::Linking& linking, DisjointSets& subclusters)
      : strip_(strip),
        linking_(linking),
        subclusters_(subclusters),
        places_per_radian_(1.00001F / strip.radians_per_place) {}

  /// Prepares some lasers of a sector for being linked. The lasers of a sector are to follow each other.
  void prepareSector(std::int64_t number, const StripData::Lasers& lasers) {
    StripData::Sector& sector = sectorOf(number);
    cutSector(strip_, number, 0.0F, lasers, sector, subclusters_);
    for (std::size_t laser = lasers.begin; laser < lasers.end; ++laser) prepareMask(sector, laser);
  }

  /// Links a sector with itself and with those before it: what one in so many of its lasers has to compare.
  void linkSector(std::int64_t number, std::size_t first_laser, std::size_t one_in) {
    StripData::Sector& sector = sectorOf(number);
    for (std::size_t laser = first_laser; laser < strip_.lasers.size(); laser += one_in) {
      if (sector.begin[laser] == sector.begin[laser + 1]) continue;
      if (linking_.masks[laser].by_places)
        comparePlaces(number, laser);
      else
        forEachSegment(strip_, sector, laser, [&](Window& window) {
          const std::int64_t sectors = (window.before + 15) / 16;
          for (std::int64_t other = std::max<std::int64_t>(number - sectors, 0); other < number; ++other)
            search(window, cut(other), ~0U);
          search(window, sector, window.segment);
        });
    }
  }

  /// Links another strip with this one, so many places later: a turn, if it is this one, which joins its end with its beginning.
  /// Both know of all lasers how high and low they have been.
  void linkAcross(const StripData& other, double later) {
    // Places of different strips may be apart by a fraction of one.
    const double reach = placesWithin(asinBound(strip_.reach / strip_.range.near_end)) + 1;
    const auto last = sectorAt(static_cast<double>(strip_.placing.end - 1));
    const auto first_of_other = sectorAt(
        std::max(static_cast<double>(other.placing.begin), static_cast<double>(strip_.placing.begin) - reach - later));
    const auto last_of_other = sectorAt(
        std::min(static_cast<double>(other.placing.end), static_cast<double>(strip_.placing.end) + reach - later));
    for (std::int64_t number = first_of_other; number <= last_of_other; ++number) {
      StripData::Sector& sector = linking_.beyond;
      cutSector(other, number, static_cast<float>(later), strip_.allLasers(), sector, subclusters_);
      for (std::size_t laser = 0; laser < strip_.lasers.size(); ++laser) {
        prepareMask(sector, laser);
        forEachSegment(other, sector, laser, [&](Window& window) {
          window.first -= 1;
          window.last += 1;
          const std::int64_t from = std::max<std::int64_t>(0, sectorAt(static_cast<double>(window.first)));
          const std::int64_t to = std::min(last, sectorAt(static_cast<double>(window.last)));
          for (std::int64_t one = from; one <= to; ++one) search(window, cut(one), ~0U);
        });
      }
    }
  }

 private:
  /// A segment and its mask.
  struct Window {
    std::uint32_t segment;
    std::uint32_t head;
    std::int64_t before;  ///< places that it reaches over
    std::size_t first_laser, last_laser;
    Returns returns;
    float nearest, farthest, lowest, highest, first, last;
  };

  static std::int64_t sectorAt(double place) {
    return static_cast<std::int64_t>(std::floor(place / static_cast<double>(StripData::kSector)));
  }

  StripData::Sector& sectorOf(std::int64_t number) {
    return linking_.sectors[static_cast<std::size_t>(number) % StripData::kSectorsKept];
  }

  StripData::Sector& cut(std::int64_t number) {
    StripData::Sector& sector = sectorOf(number);
    if (sector.number != number) cutSector(strip_, number, 0.0F, strip_.allLasers(), sector, subclusters_);
    return sector;
  }

  /// Finds the mask of a laser's returns in a sector, and what is cheaper: to compare its segments or its places.
  void prepareMask(const StripData::Sector& sector, std::size_t laser) {
    const std::uint32_t begin = sector.begin[laser];
    const std::uint32_t end = sector.begin[laser + 1];
    if (begin == end) return;
    float nearest = sector.nearest[begin];
    for (std::uint32_t segment = begin + 1; segment < end; ++segment)
      nearest = std::min(nearest, sector.nearest[segment]);
    const float angle = asinBound(strip_.reach / nearest);
    StripData::Mask& mask = linking_.masks[laser];
    mask.nearest = nearest;
    mask.before = placesWithin(angle);
    reachLasers(laser, angle, mask);
    const auto registers = static_cast<std::uint32_t>(StripData::kSector / kLanes);
    const std::uint32_t by_places =
        (mask.last_laser - mask.first_laser + 1) * static_cast<std::uint32_t>(mask.before) * registers;
    const std::uint32_t by_segments = (end - begin) * static_cast<std::uint32_t>((mask.before + 15) / 16 + 1);
    mask.by_places = by_places < kSegmentCost * by_segments;
  }

  /// Compares a laser's places in a sector with all places that its mask shows, up to its own, sixteen at a time. Between
  /// two lasers of the sector, one of which is compared by segments, those of both are the lower one's task.
  void comparePlaces(std::int64_t sector, std::size_t laser) {
    const StripData::Mask& mask = linking_.masks[laser];
    const std::int64_t place = sector * static_cast<std::int64_t>(StripData::kSector);
    const std::size_t own = strip_.at(laser, place);
    for (std::uint32_t other = mask.first_laser; other <= mask.last_laser; ++other) {
      const std::size_t same = strip_.at(other, place);
      const bool both_ways = other < laser && !linking_.masks[other].by_places;
      const int first = both_ways ? -mask.before : other > laser + 1 ? 0 : 1;  // the next laser's: linkSamePlaces
      linking_.work +=
          static_cast<std::size_t>(mask.before + 1 - first) * (StripData::kSector / kLanes) * kWorkOfPlaces;
      for (int k = first; k <= mask.before; ++k)
        comparePlacesWith(own, same - static_cast<std::size_t>(static_cast<std::int64_t>(k)));
    }
  }

  HWY_INLINE void comparePlacesWith(std::size_t own, std::size_t other) {
    const FloatVector r2 = hn::Set(kFloats, strip_.tolerance.squared());
    for (std::size_t k = 0; k < StripData::kSector; k += kLanes) {
      const auto apart = [&](const std::vector<float>& coordinate) {
        return hn::Sub(hn::LoadU(kFloats, &coordinate[own + k]), hn::LoadU(kFloats, &coordinate[other + k]));
      };
      const FloatMask near = areNeighbours(apart(strip_.x), apart(strip_.y), apart(strip_.z), r2);
      const FloatMask unlike = differ(&strip_.element[own + k], hn::LoadU(kWords, &strip_.element[other + k]));
      for (std::uint32_t left = bitsOf(hn::And(near, unlike)); left != 0; left &= left - 1) {
        const auto i = k + static_cast<std::size_t>(__builtin_ctz(left));
        const std::uint32_t a = strip_.element[own + i];
        const std::uint32_t b = strip_.element[other + i];
        if (a == last_a_ && b == last_b_) continue;
        last_a_ = a;
        last_b_ = b;
        subclusters_.merge(a, b);
      }
    }
  }

  /// Calls visit with the window of each of a laser's segments. It may change the segment's head.
  template <typename Visit>
  void forEachSegment(const StripData& strip, StripData::Sector& sector, std::size_t laser, Visit&& visit) {
    const StripData::Mask& mask = linking_.masks[laser];
    constexpr float kWorthNarrowing = 1.25F;
    Window window{};
    for (std::uint32_t i = sector.begin[laser]; i < sector.begin[laser + 1]; ++i) {
      const float reach = strip_.reach + 1e-6F * sector.farthest[i];
      window.before = mask.before;
      window.first_laser = mask.first_laser;
      window.last_laser = mask.last_laser;
      if (sector.nearest[i] > kWorthNarrowing * mask.nearest) narrow(laser, sector.nearest[i], window);
      const auto places = static_cast<float>(window.before);
      window.segment = i;
      window.head = subclusters_.head(sector.head[i]);
      window.returns = {&strip, sector.cell[i], sector.count[i]};
      window.nearest = sector.nearest[i] - reach;
      window.farthest = sector.farthest[i] + reach;
      window.lowest = sector.lowest[i] - reach;
      window.highest = sector.highest[i] + reach;
      window.first = sector.first[i] - places;
      window.last = sector.last[i] + places;
      linking_.work += kWorkOfSegment;
      visit(window);
      sector.head[i] = window.head;
    }
  }

  int placesWithin(float angle) const {
    return std::min(kMostReach, static_cast<int>(angle * places_per_radian_ + (2 * kDeviation + 0.02F)));
  }

  /// Narrows the window of a segment that is further away than others of its laser, for which the mask was made.
  void narrow(std::size_t laser, float nearest, Window& window) const {
    const float angle = asinBound(strip_.reach / nearest);
    window.before = placesWithin(angle);
    const float top = strip_.highest[laser] + angle + kAngleRounding;
    const float bottom = strip_.lowest[laser] - angle - kAngleRounding;
    while (window.first_laser < laser && strip_.lowest_above[window.first_laser] > top) ++window.first_laser;
    while (window.last_laser > laser && strip_.highest_below[window.last_laser] < bottom) --window.last_laser;
  }

  /// Sets the lasers whose elevations come within the angle of this one's.
  void reachLasers(std::size_t laser, float angle, StripData::Mask& mask) {
    const float top = strip_.highest[laser] + angle + kAngleRounding;
    const float bottom = strip_.lowest[laser] - angle - kAngleRounding;
    const auto last_of_all = strip_.lasers.size() - 1;
    std::size_t first = laser - std::min<std::size_t>(laser, mask.above);
    while (first > 0 && strip_.lowest_above[first - 1] <= top) --first;
    while (first < laser && strip_.lowest_above[first] > top) ++first;
    std::size_t last = std::min<std::size_t>(last_of_all, laser + mask.below);
    while (last < last_of_all && strip_.highest_below[last + 1] >= bottom) ++last;
    while (last > laser && strip_.highest_below[last] < bottom) --last;
    mask.above = static_cast<std::uint32_t>(laser - first);
    mask.below = static_cast<std::uint32_t>(last - laser);
    mask.first_laser = static_cast<std::uint32_t>(first);
    mask.last_laser = static_cast<std::uint32_t>(last);
  }

  /// Compares a segment with those of a sector that its window shows.
  /// \param limit only with those before this one
  HWY_INLINE void search(Window& window, StripData::Sector& other, std::uint32_t limit) {
    const std::uint32_t begin = other.begin[window.first_laser];
    const std::uint32_t end = std::min(limit, other.begin[window.last_laser + 1]);
    linking_.work += 1 + (end - begin) / kLanes;
    for (std::uint32_t i = begin; i < end; i += std::uint32_t{kLanes}) {
      const auto load = [&](const std::vector<float>& bound) { return hn::LoadU(kFloats, &bound[i]); };
      const auto all = [](float value) { return hn::Set(kFloats, value); };
      const FloatMask range =
          hn::And(hn::Le(load(other.nearest), all(window.farthest)), hn::Ge(load(other.farthest), all(window.nearest)));
      // Most of what is around belongs together already.
      std::uint32_t left = bitsOf(hn::And(range, differ(&other.head[i], hn::Set(kWords, window.head))));
      if (end - i < kLanes) left &= (1U << (end - i)) - 1;
      if (left == 0) continue;
      const FloatMask height =
          hn::And(hn::Le(load(other.lowest), all(window.highest)), hn::Ge(load(other.highest), all(window.lowest)));
      const FloatMask places =
          hn::And(hn::Le(load(other.first), all(window.last)), hn::Ge(load(other.last), all(window.first)));
      left &= bitsOf(hn::And(height, places));
      for (; left != 0; left &= left - 1) {
        const std::uint32_t candidate = i + static_cast<std::uint32_t>(__builtin_ctz(left));
        const std::uint32_t other_head = subclusters_.head(other.head[candidate]);
        other.head[candidate] = other_head;
        if (other_head == window.head) continue;
        linking_.work += kWorkOfPair;
        if (haveNeighbours(window.returns, {&strip_, other.cell[candidate], other.count[candidate]}))
          other.head[candidate] = window.head = subclusters_.merge(window.head, other_head);
      }
    }
  }

  const StripData& strip_;
  StripData::Linking& linking_;
  DisjointSets& subclusters_;
  float places_per_radian_;
  std::uint32_t last_a_ = ~std::uint32_t{0};  ///< the last two that were joined
  std::uint32_t last_b_ = ~std::uint32_t{0};
};

void linkPlaces(StripData& strip, std::size_t begin, std::size_t end, DisjointSets& subclusters) {
  linkSamePlaces(strip, begin, end, strip.allLasers(), subclusters);
  Windows windows(strip, strip.linking, subclusters);
  for (std::size_t place = begin; place < end; place += StripData::kSector) {
    const auto sector = static_cast<std::int64_t>(place / StripData::kSector);
    windows.prepareSector(sector, strip.allLasers());
    windows.linkSector(sector, 0, 1);
  }
}

/// One of the parts of what linkPlaces does for a sector, in their order.
void linkPart(StripData& strip, std::size_t place, std::size_t part, DisjointSets& subclusters) {
  constexpr std::size_t kSame = 8;
  constexpr std::size_t kPrepare = 8;
  constexpr std::size_t kLink = StripData::kParts - kSame - kPrepare;
  const auto sector = static_cast<std::int64_t>(place / StripData::kSector);
  Windows windows(strip, strip.linking, subclusters);
  if (part < kSame) {
    const StripData::Lasers lasers = strip.someLasers(part, kSame);
    linkSamePlaces(strip, place, place + StripData::kSector, lasers, subclusters);
    strip.linking.work += (lasers.end - lasers.begin) * kWorkOfSamePlaces;
  } else if (part < kSame + kPrepare) {
    const StripData::Lasers lasers = strip.someLasers(part - kSame, kPrepare);
    windows.prepareSector(sector, lasers);
    strip.linking.work += (lasers.end - lasers.begin) * kWorkOfCutting;
  } else {
    windows.linkSector(sector, part - kSame - kPrepare, kLink);
  }
}

void linkAcross(StripData& strip, const StripData& other, double later, DisjointSets& subclusters) {
  Windows(strip, strip.linking, subclusters).linkAcross(other, later);
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(placeReturns);
HWY_EXPORT(linkPlaces);
HWY_EXPORT(linkPart);
HWY_EXPORT(linkAcross);

}  // namespace

void ViewStrip::prepare(const Tolerance& new_tolerance, const ViewHints& hints, std::size_t columns) {
  tolerance = new_tolerance;
  started = false;
  linked = claimed = 0;
  linked_parts = 0;
  placing.loose.clear();
  placing.late.clear();
  placing.placed = placing.end = 0;
  placing.full = elevations_changed = false;

  const double turn_steps = std::clamp<double>(hints.steps_per_turn, 0, 1e9);
  const auto new_steps = static_cast<std::size_t>(turn_steps);
  const double step = 2 * kPi / std::max(turn_steps, 1.0);
  const bool rough = static_cast<double>(hints.roughness) > tolerance.reach();
  const double spacing = std::sqrt((rough ? kRoughReturnsPerSquare : kReturnsPerSquare) * step *
                                   static_cast<double>(hints.elevation_step));
  // As near as that, but not so near that a mask has more than kMostReach places.
  const double near_end =
      tolerance.reach() * std::max({1 / spacing, kLeastNearEnd, 1 / std::sin((kMostReach - 3) * step)});
  const bool stands_somewhere = std::all_of(hints.origin.begin(), hints.origin.end(),
                                            [](float coordinate) { return std::fabs(coordinate) <= kFarEnd; });
  const bool useful = stands_somewhere && new_steps >= kFewestSteps && new_steps <= kMostSteps &&
                      tolerance.joinsAnything() && spacing > 1e-5 && spacing < 10 && near_end > 1e-18 &&
                      near_end < 1e15 && near_end < static_cast<double>(hints.far_distance);
  range = FarRange();
  range.origin = hints.origin;
  range.near_end = range.far_enough = kInfinity;
  if (!useful) {
    steps = 0;
    return;
  }
  reach = static_cast<float>(tolerance.reach()) * 1.00001F;
  range.near_end = static_cast<float>(near_end);
  range.far_end = kFarEnd;
  // Distances are rounded, and so are these sums.
  range.far_enough = range.near_end * 1.00001F + reach;
  range.not_too_far = kFarEnd * 0.9999F - reach;
  direction = hints.clockwise ? -1.0F : 1.0F;
  const std::size_t new_places = (std::min(columns, new_steps) + kSector - 1) / kSector * kSector + 4 * kMargin;
  if (new_steps != steps || new_places > places) {
    steps = new_steps;
    radians_per_place = static_cast<float>(step);
    places = new_places;
    stride = kMargin + places + 2 * kMargin;
    cosine.resize(stride + kMargin);
    sine.resize(stride + kMargin);
    for (std::size_t i = 0; i < cosine.size(); ++i) {
      const double angle = step * (static_cast<double>(i) - static_cast<double>(kMargin));
      cosine[i] = static_cast<float>(std::cos(angle));
      sine[i] = static_cast<float>(std::sin(angle));
    }
    lasers.clear();
  }
  placing.begin = places;
  const std::size_t lasers_before = lasers.size();
  lasers.clear();
  addLasers(lasers_before);
}

void ViewStrip::addLasers(std::size_t count) {
  const std::size_t before = lasers.size();
  if (count <= before) return;
  linked_parts = 0;  // of a sector with fewer lasers
  lasers.resize(count, {kInfinity, -kInfinity, kNowhere, 0});
  elevations_changed = true;  // there are more of them
  const std::size_t size = count * stride + kMargin;
  if (x.size() < size) {
    for (auto* coordinate : {&x, &y, &z}) coordinate->resize(size);
    element.resize(size);
  }
  std::fill(x.begin() + static_cast<std::ptrdiff_t>(before * stride),
            x.begin() + static_cast<std::ptrdiff_t>(count * stride + kMargin), kNan);
  const std::size_t segments = count * kSector + kSector;  // vectors are read a little behind the last
  linking.masks.assign(count, Mask());
  const auto prepareSector = [&](Sector& sector) {
    sector.number = kNoSector;
    for (auto* bound :
         {&sector.nearest, &sector.farthest, &sector.lowest, &sector.highest, &sector.first, &sector.last})
      bound->resize(segments);
    sector.head.resize(segments);
    sector.cell.resize(segments);
    sector.count.resize(segments);
    sector.begin.resize(count + 1);
  };
  for (Sector& sector : linking.sectors) prepareSector(sector);
  prepareSector(linking.beyond);
}

void ViewStrip::start(float x_seen, float y_seen, std::uint32_t column) {
  started = true;
  const double azimuth =
      std::atan2(static_cast<double>(y_seen - range.origin[1]), static_cast<double>(x_seen - range.origin[0]));
  start_azimuth = azimuth - static_cast<double>(direction * static_cast<float>(kMargin) * radians_per_place);
  start_cosine = static_cast<float>(std::cos(start_azimuth));
  start_sine = static_cast<float>(std::sin(start_azimuth));
  first_column = column;
}

std::uint64_t ViewStrip::place(const Row& row, const MeasuredRow& measured, std::size_t laser, std::uint32_t column) {
  if (measured.lowest < lasers[laser].lowest || measured.highest > lasers[laser].highest) {
    constexpr float kWidening = 1e-3F;  // so that bounds settle soon
    lasers[laser].lowest =
        std::min(lasers[laser].lowest, measured.lowest - kWidening * (1 + std::fabs(measured.lowest)));
    lasers[laser].highest =
        std::max(lasers[laser].highest, measured.highest + kWidening * (1 + std::fabs(measured.highest)));
    elevations_changed = true;
  }
  const std::uint64_t loose =
      placing.full ? measured.far : HWY_DYNAMIC_DISPATCH(placeReturns)(*this, row, measured, laser, column);
  for (std::uint64_t some = loose; some != 0; some &= some - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctzll(some));
    placing.loose.push_back(
        {row.x[Row::kMargin + i], row.y[Row::kMargin + i], row.z[Row::kMargin + i], measured.run[i]});
  }
  if (placing.loose.size() > kFewLoose + placing.placed / kPlacedPerLoose) placing.full = true;
  return loose;
}

void ViewStrip::updateElevations() {
  if (!elevations_changed) return;
  elevations_changed = false;
  const std::size_t count = lasers.size();
  // Lasers are taken from top to bottom; if they come the other way round, elevations are turned over.
  float first = 0;
  float last = 0;
  bool any_seen = false;
  for (const Laser& laser : lasers) {
    if (laser.lowest > laser.highest) continue;
    if (!any_seen) first = laser.lowest + laser.highest;
    any_seen = true;
    last = laser.lowest + laser.highest;
  }
  upside_down = last > first;
  for (auto* angles : {&lowest, &highest, &lowest_above, &highest_below}) angles->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool seen = lasers[i].lowest <= lasers[i].highest;
    const float low = seen ? std::atan(lasers[i].lowest) : 10.0F;
    const float high = seen ? std::atan(lasers[i].highest) : -10.0F;
    lowest[i] = seen && upside_down ? -high : low;
    highest[i] = seen && upside_down ? -low : high;
  }
  float bound = 10.0F;
  for (std::size_t i = 0; i < count; ++i) lowest_above[i] = bound = std::min(bound, lowest[i]);
  bound = -10.0F;
  for (std::size_t i = count; i-- > 0;) highest_below[i] = bound = std::max(bound, highest[i]);
}

/// The end of the sectors that all lasers have passed.
std::size_t ViewStrip::passed() const {
  std::int64_t front = std::numeric_limits<std::int64_t>::max();
  std::uint32_t column = 0;
  for (const Laser& laser : lasers)
    if (laser.next_place != kNowhere) column = std::max(column, laser.next_column);
  for (const Laser& laser : lasers)
    if (laser.next_place != kNowhere) front = std::min(front, laser.next_place + (column - laser.next_column));
  front = std::clamp<std::int64_t>(front, 0, static_cast<std::int64_t>(places));
  return static_cast<std::size_t>(front) / kSector * kSector;
}

void ViewStrip::link(DisjointSets& subclusters) {
  claim();
  while (linked_parts > 0) linkPart(subclusters);
  if (linked < claimed) HWY_DYNAMIC_DISPATCH(linkPlaces)(*this, linked, claimed, subclusters);
  linked = claimed;
}

void ViewStrip::claim() {
  if (!started) return;
  updateElevations();
  claimed = std::max(claimed, passed());
}

std::size_t ViewStrip::linkPart(DisjointSets& subclusters) {
  if (lowest.size() < lasers.size()) updateElevations();  // some have been added since claim ()
  const std::size_t before = linking.work;
  HWY_DYNAMIC_DISPATCH(linkPart)(*this, linked, linked_parts, subclusters);
  if (++linked_parts == kParts) {
    linked_parts = 0;
    linked += kSector;
  }
  return linking.work - before;
}

void ViewStrip::linkRest(DisjointSets& subclusters) {
  if (!started) return;
  link(subclusters);
  if (placing.end > linked) HWY_DYNAMIC_DISPATCH(linkPlaces)(*this, linked, placing.end, subclusters);
  if (!placing.late.empty()) forgetSectors();
  for (const Loose& late : placing.late) search(late, subclusters);
  placing.late.clear();
}

/// More returns may come there, or have come late.
void ViewStrip::forgetSectors() {
  for (Sector& sector : linking.sectors) sector.number = kNoSector;
}

/// Takes over what another strip has seen of the lasers.
void ViewStrip::shareElevations(const ViewStrip& other) {
  addLasers(other.lasers.size());
  for (std::size_t laser = 0; laser < other.lasers.size(); ++laser) {
    if (other.lasers[laser].lowest >= lasers[laser].lowest && other.lasers[laser].highest <= lasers[laser].highest)
      continue;
    lasers[laser].lowest = std::min(lasers[laser].lowest, other.lasers[laser].lowest);
    lasers[laser].highest = std::max(lasers[laser].highest, other.lasers[laser].highest);
    elevations_changed = true;
  }
}

void ViewStrip::linkTo(ViewStrip& other, DisjointSets& subclusters) {
  if (!started || !other.started) return;
  if (&other != this) {
    shareElevations(other);
    other.shareElevations(*this);
    other.updateElevations();
  }
  updateElevations();
  const auto turn = static_cast<double>(steps);
  const double ahead = direction * (other.start_azimuth - start_azimuth) / static_cast<double>(radians_per_place);
  const double least = &other == this ? 1.0 : -static_cast<double>(other.placing.end) - kMostReach;
  const double most = static_cast<double>(placing.end) + kMostReach;
  if (placing.placed > 0 && other.placing.placed > 0) {
    const auto first = static_cast<int>(std::ceil((least - ahead) / turn));
    const auto last = static_cast<int>(std::floor((most - ahead) / turn));
    for (int turns = first; turns <= last; ++turns)
      HWY_DYNAMIC_DISPATCH(linkAcross)(*this, other, ahead + turn * turns, subclusters);
  }
  forgetSectors();
  for (const Loose& loose : other.placing.loose) search(loose, subclusters);
  if (&other == this) return;
  for (const Loose& loose : placing.loose) other.search(loose, subclusters);
}

void ViewStrip::stopPlacing() {
  placing.full = true;
  placing.loose.clear();
}

/// Compares one return with all places that may hold its neighbours.
void ViewStrip::search(const Loose& loose, DisjointSets& subclusters) const {
  const float east = loose.x - range.origin[0];
  const float north = loose.y - range.origin[1];
  const float rho = std::sqrt(east * east + north * north);
  const auto turn = static_cast<std::int64_t>(steps);
  const std::int64_t measured = placeOf(seenFromStart(east, north)) % turn;
  const std::int64_t middle = measured < 0 ? measured + turn : measured;
  const std::array<std::int64_t, 3> centers{middle - turn, middle, middle + turn};
  const float angle = asinBound(reach / rho);
  const auto before = static_cast<std::int64_t>(angle / radians_per_place + (kDeviation + 1.0F));
  const float slope = std::atan((loose.z - range.origin[2]) / rho);
  const float elevation = upside_down ? -slope : slope;
  const float squared_tolerance = tolerance.squared();
  const auto last = static_cast<std::int64_t>(placing.end) - 1;
  const bool is_seen = std::any_of(centers.begin(), centers.end(), [&](std::int64_t center) {
    return center + before >= 0 && center - before <= last;
  });
  if (!is_seen) return;
  for (std::size_t laser = 0; laser < lasers.size(); ++laser) {
    if (lowest[laser] > elevation + angle + kAngleRounding || highest[laser] < elevation - angle - kAngleRounding)
      continue;
    for (const std::int64_t center : centers) {
      const std::int64_t from = std::max<std::int64_t>(0, center - before);
      const std::int64_t to = std::min(last, center + before);
      for (std::int64_t place = from; place <= to; ++place) {
        const std::size_t cell = at(laser, place);
        if (isFree(cell)) continue;
        if (squaredDistance(x[cell] - loose.x, y[cell] - loose.y, z[cell] - loose.z) < squared_tolerance)
          subclusters.merge(loose.element, element[cell]);
      }
    }
  }
}

}  // namespace lisco
#endif
