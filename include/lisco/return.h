// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace lisco {

/// One cell of a column: what one laser measured in one step of the rotation (the paper's section II-A), in
/// Cartesian coordinates.
struct Return {
  float x;                     ///< metres, in the cloud's own frame
  float y;                     ///< the same
  float z;                     ///< the same
  std::uint32_t source_index;  ///< the caller's name for this cell, handed back with its subcluster
};

/// A cell without a return (the paper's d = 0).
inline constexpr Return kNoReturn{0.0F, 0.0F, 0.0F, 0U};

/// Whether a cell holds a return: all coordinates finite, and not exactly (0, 0, 0), which is the paper's d =
/// 0 and many drivers' way of saying that nothing came back.
inline bool isReturn(float x, float y, float z) {
  constexpr float kMax = std::numeric_limits<float>::max();
  const bool finite = std::fabs(x) <= kMax && std::fabs(y) <= kMax && std::fabs(z) <= kMax;
  return finite && !(x == 0.0F && y == 0.0F && z == 0.0F);
}

}  // namespace lisco
