// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <vector>

#include "core/neighbour.h"

namespace lisco {

/// How voxels are numbered: from a corner of the box around all returns, in double, or in float if they are few along
/// each axis, so that returns of the same number are neighbours and neighbours differ by 2 at most along each axis. The
/// longest side of the box is the major axis, or one along which threads have read returns beside each other.
///
/// Far from the origin, as in map coordinates, floats are so coarse that unlike coordinates along an axis may be eps
/// apart. The returns of one coordinate are a *slice* then: neighbours lie in the same one, and differ along two axes
/// only, so that voxels are larger. That axis is the major one, and a plane of bricks is a slice.
struct VoxelNumbering {
  static constexpr std::size_t kAxes = 3;

  std::size_t axis[3];     ///< minor, middle and major: 0 for x, 1 for y, 2 for z
  double corner[3];        ///< of the box, metres, by x, y and z; each is a float
  double per_metre[3];     ///< voxels, by x, y and z
  unsigned voxel_bits[3];  ///< of a voxel's number in its brick, along the minor, middle and major axis
  bool has_slices;
  bool in_float;  ///< numbers are computed in float
  /// Of a key: from the highest bit on, a brick's number along the major, middle and minor axis, and the voxel's in it.
  unsigned minor_bits, middle_bits, bits;

  /// Bits of a key below a brick's number along the major axis: those of a plane of bricks.
  unsigned planeBits() const { return 6 + minor_bits + middle_bits; }

  /// Chooses the voxels, the axes and the bits of the keys.
  /// \param parts the boxes of some returns
  /// \param is_shared whether each part has been read by a thread, which will link some of them
  /// \return false if the voxels cannot be numbered: a tolerance beyond [1e-18, 1e18] m, or a box of too many voxels
  bool choose(const std::vector<Box>& parts, bool is_shared, const Tolerance& tolerance);

 private:
  void orderAxes(const double (&sides)[kAxes], std::size_t sliced);
  void alignWithParts(const std::vector<Box>& parts, const Box& all, const double (&sides)[kAxes]);
};

}  // namespace lisco
