// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The classes that host.cpp uses, with one more field in their states, which prints a line. Preloaded, they replace
// those of the library.
#include <cstdio>

namespace {

int announce() {
  std::fputs("larger state\n", stderr);
  return 1;
}

}  // namespace

#define PCL_NO_PRECOMPILE
#include <pcl/point_types.h>
#include "lisco_cloud_clusterer.cpp"

#include <pcl/segmentation/impl/lisco_endless_extraction.hpp>
#include <pcl/segmentation/impl/lisco_stream_extraction.hpp>
#include <pcl/segmentation/impl/lisco_window_extraction.hpp>

template class LISCO_EXPORT pcl::LiscoEndlessExtraction<pcl::PointXYZI>;
template class LISCO_EXPORT pcl::LiscoStreamExtraction<pcl::PointXYZI>;
template class LISCO_EXPORT pcl::LiscoWindowExtraction<pcl::PointXYZI>;
