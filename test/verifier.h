// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "oracle.h"

namespace lisco_test {

/// Checks the invariants of a clustering, by another algorithm than the oracle's: coverage (every valid point in
/// exactly one cluster, no other point in any), sizes (each cluster as large as reported), connectivity (each cluster
/// connected by neighbours), separation (no neighbours in different clusters).
/// \return one line per violated invariant; empty if the clustering is right
std::vector<std::string> violations(const std::vector<Point>& points, const Clustering& clusters, float tolerance);

}  // namespace lisco_test
