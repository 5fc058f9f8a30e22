// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "lisco/box.h"

namespace lisco {

/// Up to four closed patches of a tile side by side, so that one pass tests all their boxes.
struct Shelf {
  static constexpr std::size_t kPlaces = 4;

  /// Four floats in one vector register: GCC's and Clang's vector extension, for any processor.
  using Lanes = float __attribute__((vector_size(16)));

  Lanes lo[3], hi[3];  ///< an empty place has a box that is near nothing
  std::uint32_t patch[kPlaces];
  std::uint32_t used;
  std::uint32_t next_in_tile;  ///< an older shelf, full

  static Shelf empty(std::uint32_t next_in_tile) {
    Shelf shelf;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      shelf.lo[axis] = broadcast(kInfinity);
      shelf.hi[axis] = broadcast(-kInfinity);
    }
    std::fill_n(shelf.patch, kPlaces, 0U);
    shelf.used = 0;
    shelf.next_in_tile = next_in_tile;
    return shelf;
  }

  bool full() const { return used == kPlaces; }

  void add(std::uint32_t patch_number, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis][used] = box.lo[axis];
      hi[axis][used] = box.hi[axis];
    }
    patch[used++] = patch_number;
  }

  /// Bit i is set iff Box::squaredGap (box, box of place i) is below the squared tolerance.
  std::uint32_t placesNear(const Box& box, float squared_tolerance) const {
    const Lanes zero = broadcast(0.0F);
    Lanes gap[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes below = lo[axis] - broadcast(box.hi[axis]);
      const Lanes above = broadcast(box.lo[axis]) - hi[axis];
      const Lanes apart = below > above ? below : above;
      gap[axis] = apart > zero ? apart : zero;
    }
    const Lanes d2 = (gap[0] * gap[0] + gap[1] * gap[1]) + gap[2] * gap[2];  // squaredDistance, four times
    const auto near = d2 < broadcast(squared_tolerance);
    return static_cast<std::uint32_t>((near[0] & 1) | (near[1] & 2) | (near[2] & 4) | (near[3] & 8));
  }

 private:
  static Lanes broadcast(float value) { return Lanes{value, value, value, value}; }
};

}  // namespace lisco
