// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

// Constants of the range image and the segment linker. "measured" means by benchmarks/suite.sh stages.

// --- Bounds: exactness depends on them (doc/algorithm.md) -----------------------------------------------------------

/// Bins between that of a return and that of its azimuth, at most; half a bin is the least possible. More where
/// azimuths jitter, so that most returns of adjacent columns have adjacent bins, though masks grow.
inline constexpr float kMinDeviation = 0.75F;
inline constexpr float kMaxDeviation = 2.25F;
inline constexpr float kWorthDeviation = 0.5F;  ///< jitter, in steps, above which more is allowed
/// Radians, added to elevation bounds; more than 100 times their rounding.
inline constexpr float kAngleRounding = 1e-4F;
/// Metres; beyond, returns go to the voxels: their squares may overflow.
inline constexpr float kMaxRange = 1e15F;

/// Largest tilt of the sensor's horizon along x and y, metres per metre; larger hints are ignored.
inline constexpr float kMaxTilt = 0.5F;

// --- Limits of the range image --------------------------------------------------------------------------------------

/// Bins that a mask reaches over; nearer returns are not far.
inline constexpr int kMaxReach = 48;
/// All bins are less than two turns, so that there is one seam.
inline constexpr std::size_t kMinSteps = 512;
inline constexpr std::size_t kMaxSteps = 16384;
/// Unplaced returns, and one more for each kPlacedPerUnplaced placed ones, from which on no more are placed: each is
/// searched in all bins of its mask at every update. Fewer: images are given up too early; more: searches dominate.
inline constexpr std::size_t kFewUnplaced = 4096;
inline constexpr std::size_t kPlacedPerUnplaced = 32;
/// Unplaced returns, for each layer of the image, from which on another layer is worth its memory.
inline constexpr std::size_t kFewTaken = 32;
inline constexpr std::size_t kPlacedPerTaken = 1024;
/// Late returns, from which on it takes less to link their sectors again than to search each alone.
inline constexpr std::size_t kFewLate = 2048;
/// Rows are sorted by elevation if more than one in kFewUnsorted lasers has a lower one before or a higher one behind.
/// More: rows of sensors whose rings sway are sorted; fewer: masks span many rows, though few lasers are unsorted.
inline constexpr std::size_t kFewUnsorted = 8;
/// Added to a laser's elevation bounds when they grow, relative: they settle after a few columns.
inline constexpr float kWidening = 1e-3F;

// --- What is far: measured ------------------------------------------------------------------------------------------

/// Returns are far where about this many of a flat surface's lie in a square of the tolerance's size. More: masks grow;
/// fewer: voxels hold few returns each. Rough: the returns of a laser do not form runs, so segments are short.
inline constexpr double kReturnsPerSquare = 100.0;
inline constexpr double kRoughReturnsPerSquare = 60.0;
inline constexpr double kMinRangeInTolerances = 2.5;
inline constexpr double kMinBinInCoarseness = 1;  ///< width of a bin over the resolution of coordinates

// --- Cost of linking: measured --------------------------------------------------------------------------------------

/// Cost of searching one segment's neighbours in a sector, in comparisons of bins: narrower registers slow both down.
inline constexpr std::uint32_t kSegmentCost = 48;
/// Units of work where it is done in parts, about 5 ns each.
inline constexpr std::uint32_t kWorkOfSameBins = 12;       ///< of a laser
inline constexpr std::uint32_t kWorkOfCutting = 20;        ///< of a laser
inline constexpr std::uint32_t kWorkOfWideRegister = 2;    ///< of comparing 16 bins
inline constexpr std::uint32_t kWorkOfNarrowRegister = 1;  ///< of comparing 8 or fewer
inline constexpr std::uint32_t kWorkOfSegment = 10;
inline constexpr std::uint32_t kWorkOfPair = 6;  ///< of segments that are compared
/// Far returns are worth a range image if placing and linking them takes no more work than sorting them would: this
/// much for each return, and for each run, but at most kMaxWorkOfSorted for each return, as clouds of short runs are
/// read without runs. Least regret over the scans at rest, moved, deskewed, with dual returns and with half of the
/// returns missing (benchmarks/suite.sh recordings layouts).
inline constexpr double kWorkOfSortedReturn = 0.9;
inline constexpr double kWorkOfSortedRun = 20;
inline constexpr double kMaxWorkOfSorted = 7.7;
inline constexpr std::uint32_t kWorkOfRealigning = 8;  ///< of placing a return off the expected bin
inline constexpr std::uint32_t kWorkOfUnplaced = 200;
/// Segments that exceed their laser's nearest one by this factor get a mask of their own.
inline constexpr float kWorthNarrowing = 1.25F;

/// An upper bound on asin (ratio), 0 <= ratio < 1.
inline float asinBound(float ratio) {
  return (ratio + 0.5708F * ratio * ratio * ratio) * 1.00001F;
}

}  // namespace lisco
