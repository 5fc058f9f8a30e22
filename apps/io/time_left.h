// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <string>

#include "io/text.h"

namespace lisco_apps {

/// "1:05 left, "; empty at the beginning, where it is unknown.
/// \param seconds since the beginning
/// \param share of the work that is done, 0 to 1
inline std::string timeLeft(double seconds, double share) {
  constexpr double kMinTime = 1;
  if (seconds <= kMinTime || share <= 0) return {};
  const auto left = static_cast<long>(std::ceil(seconds / share - seconds));
  return formatted("%ld:%02ld left, ", left / 60, left % 60);
}

}  // namespace lisco_apps
