// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>

#include "io/clusters.h"
#include "io/text.h"

namespace lisco_apps {

inline constexpr std::size_t kMaxSemanticKittiClusters = 0xFFFF;  ///< the format has 16 bits for an instance

// The labels of a scan's points in several formats; see writeResults (). They throw std::runtime_error with one line if
// the file cannot be written.
void writeLabelledPcd(const ClusteredScan& scan, const fs::path& file);
/// Of at most kMaxSemanticKittiClusters clusters.
void writeSemanticKitti(const ClusteredScan& scan, const fs::path& file);
void writeNpy(const ClusteredScan& scan, const fs::path& file);

}  // namespace lisco_apps
