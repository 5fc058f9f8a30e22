// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <atomic>

#include <pcl/console/print.h>
#include <pcl/impl/instantiate.hpp>
#include <pcl/segmentation/impl/lisco_cluster_extraction.hpp>

void pcl::detail::LiscoSearchMethodWarning::print(Reason reason, const char* caller) {
  static std::atomic<bool> warned[2];
  if (warned[static_cast<int>(reason)].exchange(true)) return;
  if (reason == Reason::kEpsilon)
    PCL_WARN(
        "[%s] The kd-tree's epsilon is above 0: PCL's clusters would be those of approximate neighbours. Lisco ignores "
        "the tree and gives the exact ones.\n",
        caller);
  else
    PCL_WARN(
        "[%s] The kd-tree's point representation is not (x, y, z): PCL's clusters would be those of its distances. "
        "Lisco ignores the tree and takes Euclidean distances of (x, y, z).\n",
        caller);
}

PCL_INSTANTIATE(LiscoClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters_indices, PCL_XYZ_POINT_TYPES)
