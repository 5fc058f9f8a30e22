// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>

#include "io/clusters.h"

namespace lisco_apps {

/// Writes labels.pcd (organized as the input; x y z label), clusters.csv, range_image.png and top_view.png into a
/// folder, and with `cloud_per_cluster` also clusters/cluster_0001.pcd and so on, largest first. All or nothing;
/// replaces the files of an earlier run and refuses to replace any other file of these names, see writeOwnFolder ().
/// \throws std::runtime_error with one line that says what cannot be written, or what would be overwritten
void writeResults(const ClusteredScan& scan, const std::filesystem::path& folder, bool cloud_per_cluster);

}  // namespace lisco_apps
