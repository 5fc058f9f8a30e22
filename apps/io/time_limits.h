// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstdint>

namespace lisco_apps {

/// Nanoseconds before and after 1970, 146 years: sums and differences of two such times do not overflow.
inline constexpr std::int64_t kMaxTimeNs = (std::int64_t{1} << 62) - 1;

/// A time from a file, which may be malformed, within these limits.
inline std::int64_t limitedTime(std::int64_t time_ns) {
  return std::clamp(time_ns, -kMaxTimeNs, kMaxTimeNs);
}

}  // namespace lisco_apps
