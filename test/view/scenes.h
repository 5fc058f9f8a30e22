// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "view/view_scan.h"

/// A plane of ground points, 25 noise points, and clusters in the form of posts on a circle: the one of number k, from
/// 1, has 100 - 3 k points.
/// \param clusters at most 30
lisco_apps::ViewScan scanOfPosts(std::size_t clusters, float radius = 12);

/// A simulated rotation of a VLS-128 (about 220,000 returns), clustered at 0.4 m above its ground.
lisco_apps::ViewScan largeScan();

/// The same points, labels and so on in random order.
lisco_apps::ViewScan shuffled(const lisco_apps::ViewScan& scan, std::uint32_t seed);
