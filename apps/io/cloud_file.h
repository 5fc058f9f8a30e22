// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "io/text.h"

namespace lisco_apps {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// The files in a folder that have an ending of readScan (), sorted by name, without results written there by
/// lisco_cluster, and without tables (.csv with names of columns, the first of which is not x). Not recursive.
/// \throws std::runtime_error if the folder cannot be read
std::vector<fs::path> cloudFilesIn(const fs::path& folder);

/// Inputs as given on a command line, each folder replaced by the files in it.
/// \param failures receives a line for each folder that holds none or cannot be read
std::vector<fs::path> expandInputs(const std::vector<std::string>& inputs, std::vector<std::string>& failures);

/// A unique name per file, for a folder of its results: without folder and ending, numbered where names repeat; "scan"
/// where that is no name of a folder.
std::vector<std::string> namesOf(const std::vector<fs::path>& files);

/// The points to be clustered: valid returns (see doc/contract.md) with z >= ground_z.
pcl::Indices returnsAbove(const Cloud& cloud, float ground_z);

}  // namespace lisco_apps
