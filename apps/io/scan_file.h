// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/PointIndices.h>

#include "io/cloud_file.h"

namespace lisco_apps {

/// A cloud as a file or a message has it and, if its rings are known, arranged in rows of them.
struct Scan {
  Cloud::Ptr cloud;                      ///< in the input's order
  Cloud::Ptr arranged;                   ///< a row for each ring; nullptr: the cloud is clustered as it is
  pcl::Indices point_of_cell;            ///< of `arranged`: number in `cloud`, UNAVAILABLE without a point
  std::vector<std::uint32_t> object_of;  ///< field `label` (uint32) of each point of `cloud`; empty if there is none
  pcl::PCLPointCloud2 fields;            ///< all, of each point of `cloud`; empty if x, y, z are all
  std::string note;                      ///< how it was read and arranged; empty if there is nothing to say

  /// The cloud to be clustered.
  const Cloud::Ptr& clustered() const { return arranged ? arranged : cloud; }
  /// object_of, of the points of clustered ().
  std::vector<std::uint32_t> objectsOfClustered() const;
  /// Converts clusters of clustered () to those of the cloud.
  void toInputOrder(std::vector<pcl::PointIndices>& clusters) const;
};

/// How files are read.
struct ReadOptions {
  unsigned bin_fields = 0;  ///< floats a point of a `.bin`; 0: by their looks
};

/// Reads a scan by the ending of its name: PCD and PLY with fields x, y, z of float or double, KITTI's, nuScenes' and
/// others' `.bin` (float32 x y z and more, unorganized), NumPy's `.npy`, or the paper authors' `.csv` (see
/// authors_csv.cpp). Its cloud is organized as the file is; an unorganized one is arranged by its field `ring`, or by
/// rings that the order of a `.bin` or `.npy` shows.
/// \throws std::runtime_error with one line that names the file and what is wrong with it
Scan readScan(const fs::path& file, const ReadOptions& options = {});

/// Whether a file's name has an ending of readScan ().
bool isCloudFile(const fs::path& file);

/// Arranges a cloud of one row by the rings in its message, see pcl::organizeLiscoCloud (). Leaves it as it is without
/// such a field, or if rings and times make no rows.
void arrange(const pcl::PCLPointCloud2& message, Scan& scan);

/// Arranges a cloud whose points are sorted by ring and, in each, by azimuth: a point goes to the column of its azimuth
/// or, if that is taken, to the next one that is free. Leaves the cloud as it is if that takes far more columns than
/// the rings have points.
/// \param rings of the points, from 0
void arrangeByAzimuth(const std::vector<std::uint16_t>& rings, Scan& scan);

}  // namespace lisco_apps
