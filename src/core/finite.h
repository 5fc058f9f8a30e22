// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace lisco {

inline bool areFinite(const std::array<float, 3>& coordinates) {
  return std::all_of(coordinates.begin(), coordinates.end(), [](float c) { return std::isfinite(c); });
}

}  // namespace lisco
