// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

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

using ComparedPoint = pcl::PointXYZI;  ///< the point type of LiDAR drivers
using ComparedCloud = pcl::PointCloud<ComparedPoint>;

/// The input of every baseline.
struct Problem {
  ComparedCloud::ConstPtr cloud;  ///< organized as read; NaN where there is no return, and at the ground
  pcl::IndicesConstPtr returns;   ///< its returns, ascending, for baselines that need indices
  double tolerance = 0;           ///< metres
  unsigned min_size = 10;
  unsigned max_size = std::numeric_limits<int>::max();
};

/// A method of clustering, from a cloud to PCL's vector of clusters.
struct Baseline {
  std::string key;                                         ///< on the command line and in CSV and JSON
  std::string title;                                       ///< in tables and charts
  std::function<void(const Problem&, Clusters&)> extract;  ///< appends clusters; keeps its memory from call to call
  unsigned color = 0;                                      ///< in charts, 0xRRGGBB
  bool timed = true;                                       ///< false: clusters are compared only
  bool needs_rows = false;                                 ///< for organized clouds only
};

/// An extraction to be timed, which gives its clusters back. Refers to both.
inline std::function<void()> runOf(const Baseline& baseline, const Problem& problem) {
  return [&baseline, &problem] {
    Clusters clusters;
    baseline.extract(problem, clusters);
  };
}

/// Key of the reference, PCL with KdTree (false), whose clusters are the right ones.
inline constexpr const char* kReferenceKey = "pcl";
Baseline referenceBaseline();

/// Lisco on a number of threads.
Baseline liscoBaseline(unsigned threads);

/// All baselines, the reference first, each with memory of its own.
std::vector<Baseline> allBaselines();

/// The angles of Algorithm 2: a turn by the steps, and the smallest difference of successive rows' median elevations.
lisco_reference::NominalSensor nominalSensor(const ComparedCloud& cloud);

}  // namespace lisco_apps
