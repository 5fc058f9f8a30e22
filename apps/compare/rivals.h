// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "io/clusters.h"
#include "reference/paper_lisco.h"

namespace lisco_apps {

using RivalPoint = pcl::PointXYZI;  ///< what drivers of LiDARs deliver
using RivalCloud = pcl::PointCloud<RivalPoint>;

/// What every rival is given: the same returns.
struct Problem {
  RivalCloud::ConstPtr cloud;    ///< organized as read; NaN where there is no return, and where the ground was
  pcl::IndicesConstPtr returns;  ///< its returns, ascending: for those that cannot tell them apart themselves
  double tolerance = 0;          ///< metres
  unsigned min_size = 10;
  unsigned max_size = std::numeric_limits<int>::max();
};

/// One way of clustering: from a cloud to PCL's vector of clusters.
struct Rival {
  std::string key;    ///< for the command line and for machines
  std::string title;  ///< for people
  /// Appends the clusters of a problem. Keeps its memory from call to call, as its user would.
  std::function<void(const Problem&, Clusters&)> extract;
  unsigned color = 0;       ///< in charts, 0xRRGGBB
  bool timed = true;        ///< false: only shown
  bool needs_rows = false;  ///< works on organized clouds only
};

/// Key of the reference: PCL with KdTree (false), whose clusters all others are to find.
inline constexpr const char* kReferenceKey = "pcl";
Rival referenceRival();

/// All of them, the reference first, each with memory of its own.
std::vector<Rival> allRivals();

/// The smallest angles of the paper's Algorithm 2, as a data sheet would give them: a turn divided by the steps, and
/// the smallest difference of the elevations of two rows that follow each other, a row's being the median of its
/// returns'.
lisco_reference::NominalSensor nominalSensor(const RivalCloud& cloud);

}  // namespace lisco_apps
