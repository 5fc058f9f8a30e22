// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_numbering.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/bits.h"
#include "core/near/constants.h"

namespace lisco {

namespace {

/// The least difference of unlike floats of which all are at least lo and at most hi, and of one sign; else 0.
float leastStep(float lo, float hi) {
  if (lo <= 0 && hi >= 0) return 0;
  const float least = std::min(std::fabs(lo), std::fabs(hi));
  return std::nextafter(least, std::numeric_limits<float>::infinity()) - least;
}

constexpr std::size_t kAxes = VoxelNumbering::kAxes;

/// An axis with slices, and how far they are apart at least, metres.
struct Slices {
  std::size_t axis = kAxes;  ///< kAxes: there are few along any
  float step = 0;
};

/// The axis with most slices.
Slices findSlices(const Box& box, const Tolerance& tolerance) {
  Slices found;
  double most = kMinSlices;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const float step = leastStep(box.lo[axis], box.hi[axis]);
    if (squaredDistance(step, 0, 0) < tolerance.squared()) continue;
    const double slices =
        (static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis])) / static_cast<double>(step);
    if (slices < most) continue;
    found = {axis, step};
    most = slices;
  }
  return found;
}

/// How far the boxes of some parts overlap along an axis: 0 if they lie side by side, 1 for each but one if all span
/// the whole.
double overlapAlong(std::size_t axis, const std::vector<Box>& parts, const Box& all) {
  const auto lengthOf = [axis](const Box& box) {
    return static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis]);
  };
  double sum = 0;
  for (const Box& box : parts) sum += lengthOf(box);
  return sum / lengthOf(all) - 1;
}

}  // namespace

/// Puts the axes into the order of the sides of the box, with a sliced axis last.
/// \param sides in voxels
void VoxelNumbering::orderAxes(const double (&sides)[kAxes], std::size_t sliced) {
  std::iota(axis, axis + kAxes, std::size_t{0});
  if (sliced < kAxes) std::swap(axis[sliced], axis[kAxes - 1]);
  std::sort(axis, axis + (sliced < kAxes ? kAxes - 1 : kAxes),
            [&](std::size_t a, std::size_t b) { return sides[a] < sides[b]; });
}

/// Makes the middle axis the major one if the parts overlap less along it: what other threads have read comes from
/// other caches.
/// \param sides of the box, in voxels
void VoxelNumbering::alignWithParts(const std::vector<Box>& parts, const Box& all, const double (&sides)[kAxes]) {
  const auto threads = static_cast<double>(parts.size());
  if (sides[axis[1]] < kMinSharedSide * threads) return;
  const double gain = overlapAlong(axis[2], parts, all) - overlapAlong(axis[1], parts, all);
  if (gain > kMinOverlapGain * (threads - 1)) std::swap(axis[1], axis[2]);
}

bool VoxelNumbering::choose(const std::vector<Box>& parts, bool is_shared, const Tolerance& tolerance) {
  if (tolerance.reach() < kMinSortedTolerance || tolerance.reach() > kMaxSortedTolerance) return false;
  Box all = parts.front();
  for (const Box& box : parts) all.add(box);
  const Slices slices = findSlices(all, tolerance);
  has_slices = slices.axis < kAxes;
  constexpr unsigned kVoxelBits[2][kAxes] = {{2, 2, 2}, {3, 2, 0}};
  std::copy_n(kVoxelBits[has_slices ? 1 : 0], kAxes, voxel_bits);
  double lengths[kAxes];  // of the box, metres
  for (std::size_t i = 0; i < kAxes; ++i) {
    corner[i] = static_cast<double>(all.lo[i]);
    lengths[i] = static_cast<double>(all.hi[i]) - corner[i];
  }
  const double longest = std::max({lengths[0], lengths[1], lengths[2]});
  in_float = !has_slices && longest < kMaxFloatSide * kFloatVoxelSide * tolerance.reach();
  const double voxel = (has_slices ? kSliceVoxelSide : in_float ? kFloatVoxelSide : kVoxelSide) * tolerance.reach();
  double sides[kAxes];  // of the box, in voxels
  for (std::size_t i = 0; i < kAxes; ++i) {
    per_metre[i] = 1 / (i == slices.axis ? static_cast<double>(slices.step) : voxel);
    sides[i] = lengths[i] * per_metre[i];
    if (!(sides[i] < kMaxVoxelNumber)) return false;
  }
  orderAxes(sides, slices.axis);
  if (is_shared && !has_slices) alignWithParts(parts, all, sides);
  const auto bitsAlong = [&](std::size_t i) {
    constexpr double kRounding = 1 + 1e-6;  // of numbers in float
    const auto last = static_cast<std::uint64_t>(sides[axis[i]] * kRounding);
    return bitsFor((last >> voxel_bits[i]) + 3);
  };
  minor_bits = bitsAlong(0);
  middle_bits = bitsAlong(1);
  bits = planeBits() + bitsAlong(2);
  return true;
}

}  // namespace lisco
