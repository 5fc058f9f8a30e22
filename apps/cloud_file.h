// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace lisco_apps {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Reads a scan: any format PCL reads with x, y, z fields of float or double (PCD, PLY), KITTI's `.bin`
/// (float32 x y z intensity, unorganized), or the paper authors' `.csv` (see readAuthorsCsv). Organized as the
/// file is.
/// \param object_of if not nullptr, receives the file's field `label` (an unsigned integer of 32 bits) per point, as
///        simulated and annotated scans have it, or nothing if there is none
/// \throws std::runtime_error with one line that names the file and what is wrong with it
Cloud::Ptr readCloudFile(const std::filesystem::path& file, std::vector<std::uint32_t>* object_of = nullptr);

/// Files of the folder, sorted by name, that readCloudFile knows by their ending, but for results written there. Not
/// recursive.
/// \throws std::runtime_error if it cannot be read
std::vector<std::filesystem::path> cloudFilesIn(const std::filesystem::path& folder);

/// Inputs as given on a command line, each folder replaced by the files in it.
/// \param failures receives a line for each folder that holds none or cannot be read
std::vector<std::filesystem::path> expandInputs(const std::vector<std::string>& inputs,
                                                std::vector<std::string>& failures);

/// A name for each file, for its results: without folder and ending, numbered where names repeat.
std::vector<std::string> namesOf(const std::vector<std::filesystem::path>& files);

/// The points that are to be clustered: valid returns (see doc/contract.md) with z >= ground_z.
pcl::Indices returnsAbove(const Cloud& cloud, float ground_z);

}  // namespace lisco_apps
