// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "compare/baselines.h"

namespace lisco_apps {

/// Kd-trees used directly, without PCL's search classes: FLANN's and, if the header was found when this was built,
/// nanoflann's. A breadth-first search takes new points from the tree's leaves as they are found, so that no list of
/// neighbours is made, sorted or copied.
std::vector<Baseline> kdTreeBaselines();

}  // namespace lisco_apps
