// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/segmentation/lisco_search_method.h>

#include <atomic>

#include <pcl/console/print.h>

void pcl::detail::LiscoSearchMethodCheck::warnOfEpsilon(const char* caller) {
  static std::atomic_flag warned = ATOMIC_FLAG_INIT;
  if (warned.test_and_set()) return;
  PCL_WARN(
      "[%s] The kd-tree's epsilon is above 0: PCL's clusters would be those of approximate neighbours. Lisco ignores "
      "the "
      "tree and gives the exact ones.\n",
      caller);
}

void pcl::detail::LiscoSearchMethodCheck::warnOfRepresentation(const char* caller) {
  static std::atomic_flag warned = ATOMIC_FLAG_INIT;
  if (warned.test_and_set()) return;
  PCL_WARN(
      "[%s] The kd-tree's point representation is not (x, y, z): PCL's clusters would be those of its distances. Lisco "
      "ignores the tree and takes Euclidean distances of (x, y, z).\n",
      caller);
}
