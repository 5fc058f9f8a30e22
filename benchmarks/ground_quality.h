// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/cloud_file.h"

namespace lisco_benchmarks {

/// How well a scan's ground is removed.
struct GroundQuality {
  std::size_t returns = 0;
  std::size_t removed = 0;   ///< returns called ground
  std::size_t elevated = 0;  ///< returns more than 0.5 m above the local ground
  std::size_t lost = 0;      ///< those of them that are called ground
  std::size_t clusters = 0;  ///< of the rest
  std::size_t flat = 0;      ///< clusters lower than 0.15 m and longer than 1 m
};

/// Height of the local ground at each point, metres; NaN if it is no return. Shares nothing with the filter: squares of
/// 1 m hold the 5th percentile of their returns' heights. One that is more than 0.8 m below the median of the up to 288
/// around it, or holds fewer than three returns while others are within 10 m, is left out (reflections). The
/// local ground is the second least, over the squares within 6 m, of their height plus 0.27 m per metre between the
/// squares' middles beyond the first (15 degrees).
std::vector<float> localGround(const lisco_apps::Cloud& cloud);

/// \param ground a byte for each point, 1: ground
/// \param local as localGround gives it
/// \param labels receives each point's cluster, -1: none; clusters have 10 points or more
/// \param flat_clusters receives a byte for each cluster
GroundQuality measureGround(const lisco_apps::Cloud& cloud, const std::vector<std::uint8_t>& ground,
                            const std::vector<float>& local, double tolerance, std::vector<std::int32_t>& labels,
                            std::vector<std::uint8_t>& flat_clusters);

}  // namespace lisco_benchmarks
