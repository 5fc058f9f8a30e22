// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "io/text.h"

namespace lisco_apps {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Reads a scan by the ending of its name: PCD and PLY with fields x, y, z of float or double, KITTI's, nuScenes' and
/// others' `.bin` (float32 x y z and more, unorganized), NumPy's `.npy`, or the paper authors' `.csv` (see
/// authors_csv.cpp). Organized as the file is; see readScan () for more.
/// \param object_of if not nullptr, receives the field `label` (uint32) per point, as simulated and annotated scans
///        have it; empty if there is none
/// \throws std::runtime_error with one line that names the file and what is wrong with it
Cloud::Ptr readCloudFile(const fs::path& file, std::vector<std::uint32_t>* object_of = nullptr);

/// The field `label` (uint32) per point, as simulated and annotated scans have it; empty if there is none.
std::vector<std::uint32_t> labelsIn(const pcl::PCLPointCloud2& fields);

/// Whether a file's name has an ending of readCloudFile ().
bool isCloudFile(const fs::path& file);

/// The files in a folder that have an ending of readCloudFile, sorted by name, without results written there by
/// lisco_cluster. Not recursive.
/// \throws std::runtime_error if the folder cannot be read
std::vector<fs::path> cloudFilesIn(const fs::path& folder);

/// Inputs as given on a command line, each folder replaced by the files in it.
/// \param failures receives a line for each folder that holds none or cannot be read
std::vector<fs::path> expandInputs(const std::vector<std::string>& inputs, std::vector<std::string>& failures);

/// A unique name per file, for its results: without folder and ending, numbered where names repeat.
std::vector<std::string> namesOf(const std::vector<fs::path>& files);

/// The points to be clustered: valid returns (see doc/contract.md) with z >= ground_z.
pcl::Indices returnsAbove(const Cloud& cloud, float ground_z);

}  // namespace lisco_apps
