// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

// Constants of the voxels. "measured" means by benchmarks/suite.sh recordings.

/// Side of a voxel over eps, a little less than 1 / sqrt (3): the returns of a voxel are neighbours, and neighbours lie
/// in voxels whose numbers differ by 2 at most, whatever rounding does (doc/algorithm.md).
inline constexpr double kVoxelSide = 0.9999 / 1.7320508075688772;

/// Largest voxel number of a hashed voxel. In float, up to 2^20: rounding moves a return by less than an eighth of a
/// voxel, so that neighbours, which are 1.7323 sides apart at most, lie in voxels whose numbers differ by 2 at most. In
/// double, up to 2^51, likewise.
inline constexpr float kMaxFloatNumber = 1 << 20;
inline constexpr double kMaxDoubleNumber = 2251799813685248.0;

/// Elements that vectors may read behind the last.
inline constexpr std::size_t kReadBehind = 16;

/// Returns that are copied at a time, up to kNearStep - 1 of them behind the last: a branch for each costs more.
inline constexpr std::size_t kNearStep = 4;

// --- Sorting --------------------------------------------------------------------------------------------------------

/// Metres: between these, squares in float neither vanish nor overflow.
inline constexpr double kMinSortedTolerance = 1e-18;
inline constexpr double kMaxSortedTolerance = 1e18;
/// Side of a voxel over eps in a slice, whose returns differ along two axes: a little less than 1 / sqrt (2).
inline constexpr double kSliceVoxelSide = 0.9999 / 1.4142135623730951;
/// Side of a voxel over eps where sorted voxels are numbered in float, and the longest side of the box of all returns,
/// in voxels, up to which they are: rounding moves a border by less than the side falls short of 1 / sqrt (3)
/// (doc/algorithm.md). In float, numbering takes half the time.
inline constexpr double kFloatVoxelSide = 0.998 / 1.7320508075688772;
inline constexpr double kMaxFloatSide = 4096;
/// Least number of slices that count as such: threads share out planes, which slices are then. With slices, clouds in
/// UTM coordinates take 0.8 to 0.95 times as long at tolerances below 0.5 m (recordings --cloud UTM).
inline constexpr double kMinSlices = 32;
/// Largest number of a voxel along an axis: fits a signed 32-bit conversion.
inline constexpr double kMaxVoxelNumber = 2147480000.0;
/// Fragments that a thread takes at least when it takes planes that another may take: thin ones, as slices are, would
/// take it more time than their fragments (threads).
inline constexpr std::size_t kLeastTaken = 128;
/// Returns from which on threads share the work: with fewer, synchronizing the threads takes longer than it saves
/// (threads).
inline constexpr std::size_t kMinSharedReturns = 8192;
/// Voxels along the middle axis, for each thread, from which on it may become the major one: fewer planes divide the
/// work less evenly (threads).
inline constexpr double kMinSharedSide = 32;
/// Part of the most overlap possible by which the threads' parts must overlap less along the middle axis than along the
/// major one, for it to become the major one (threads).
inline constexpr double kMinOverlapGain = 0.25;
/// Single returns of a brick that are compared with each other instead of by voxels: one vector, at most.
inline constexpr std::size_t kFewReturns = 16;
/// Fragments between a prefetch and its use, and readable behind the last: measured on shuffled clouds, flat from 16 to
/// 64.
inline constexpr std::size_t kPrefetch = 32;

}  // namespace lisco
