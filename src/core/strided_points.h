// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
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
};

}  // namespace lisco
