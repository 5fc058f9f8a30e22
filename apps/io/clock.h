// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <chrono>

namespace lisco_apps {

using Clock = std::chrono::steady_clock;

inline double millisecondsOf(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace lisco_apps
