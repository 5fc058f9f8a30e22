// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lisco_apps {

/// The row of each point of an organized cloud; empty for an unorganized one, and for more than 65536 rows.
inline std::vector<std::uint16_t> rowsOf(std::size_t width, std::size_t height) {
  std::vector<std::uint16_t> rows;
  if (height < 2 || height > std::numeric_limits<std::uint16_t>::max() + std::size_t{1}) return rows;
  for (std::size_t i = 0; i < width * height; ++i) rows.push_back(static_cast<std::uint16_t>(i / width));
  return rows;
}

}  // namespace lisco_apps
