// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "io/options.h"

namespace lisco_apps {

/// Heights of the ground by items of --ground-z, metres: minus infinity where no item applies.
inline PerInput<float> groundHeights(const std::vector<std::string>& items) {
  PerInput<float> heights(-std::numeric_limits<float>::infinity());
  for (const std::string& item : items)
    heights.set(item, [](const std::string& text) { return heightOf(text, "--ground-z"); });
  return heights;
}

}  // namespace lisco_apps
