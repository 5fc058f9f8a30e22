// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "lisco/return.h"

namespace lisco {

/// Points in a caller's memory: x, y and z as floats, each point `stride` bytes behind the one before, aligned or not.
struct StridedPoints {
  const unsigned char* bytes;
  std::size_t stride;

  /// \return the point, with source index 0
  Return at(std::size_t point) const {
    float xyz[3];
    std::memcpy(xyz, bytes + point * stride, sizeof xyz);
    return Return{xyz[0], xyz[1], xyz[2], 0};
  }
  /// Reads `count` points from point `first` on; their source indices are their numbers.
  void read(std::size_t first, std::size_t count, const CellSource::Destination& to) const {
    // Strides known to the compiler, which makes vectors of their loops: of three, four and eight floats.
    switch (stride) {
      case 12:
        return readEach<12>(first, count, to.x, to.y, to.z, to.source_index);
      case 16:
        return readEach<16>(first, count, to.x, to.y, to.z, to.source_index);
      case 32:
        return readEach<32>(first, count, to.x, to.y, to.z, to.source_index);
      default:
        return readEach<0>(first, count, to.x, to.y, to.z, to.source_index);
    }
  }

 private:
  /// \tparam kStride 0: that of the points
  template <std::size_t kStride>
  void readEach(std::size_t first, std::size_t count, float* __restrict x, float* __restrict y, float* __restrict z,
                std::uint32_t* __restrict source_index) const {
    const std::size_t step = kStride != 0 ? kStride : stride;
    const unsigned char* const from = bytes + first * step;
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(x + i, from + i * step, sizeof *x);
      std::memcpy(y + i, from + i * step + sizeof *x, sizeof *y);
      std::memcpy(z + i, from + i * step + 2 * sizeof *x, sizeof *z);
      source_index[i] = static_cast<std::uint32_t>(first + i);
    }
  }
};

}  // namespace lisco
