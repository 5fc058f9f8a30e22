// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstring>

#include "lisco/return.h"

namespace lisco {

/// Points in a caller's memory: three floats each, metres, at any address.
struct StridedPoints {
  const void* x = nullptr;    ///< of the first point
  const void* y = nullptr;    ///< the same
  const void* z = nullptr;    ///< the same
  std::ptrdiff_t stride = 0;  ///< bytes from one point to the next; may be negative

  /// \param xyz the first point, whose x, y and z are side by side
  static StridedPoints sideBySide(const void* xyz, std::ptrdiff_t stride) {
    if (xyz == nullptr) return {};
    const auto* const first = static_cast<const unsigned char*>(xyz);
    return {first, first + sizeof(float), first + 2 * sizeof(float), stride};
  }

  /// \return the point, with source index 0
  Return at(std::size_t point) const {
    const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(point) * stride;
    return Return{valueAt(x, offset), valueAt(y, offset), valueAt(z, offset), 0};
  }

  /// Reads `count` points from point `first` on, as CellSource has it, but without source indices. Points whose x, y
  /// and z are side by side are read as vectors.
  LISCO_EXPORT void read(std::size_t first, std::size_t count, const CellSource::Destination& to) const;

 private:
  static float valueAt(const void* coordinate, std::ptrdiff_t offset) {
    float value = 0.0F;
    std::memcpy(&value, static_cast<const unsigned char*>(coordinate) + offset, sizeof value);
    return value;
  }
};

}  // namespace lisco
