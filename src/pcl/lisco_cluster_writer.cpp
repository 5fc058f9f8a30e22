// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/segmentation/lisco_cluster_writer.h>

#include "core/pages.h"

void pcl::detail::reserveLiscoIndices(Indices& indices, std::size_t count) {
  indices.reserve(count);
  lisco::populatePages(indices.data(), indices.data() + count);
}
