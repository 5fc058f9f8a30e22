// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/cloud_file.h"

namespace lisco_benchmarks {

/// Draws a scan from above and, below that, height over horizontal distance. Brown: ground; blue to white: the rest, by
/// height; red: called ground though more than 0.5 m above the local ground; magenta: flat clusters.
/// \param radius metres, shown from above
void drawGround(const lisco_apps::Cloud& cloud, const std::vector<std::uint8_t>& ground,
                const std::vector<float>& local, const std::vector<std::int32_t>& labels,
                const std::vector<std::uint8_t>& flat_clusters, double radius, const std::filesystem::path& png);

}  // namespace lisco_benchmarks
