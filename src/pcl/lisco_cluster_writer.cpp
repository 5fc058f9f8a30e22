// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/segmentation/lisco_cluster_writer.h>

#include <exception>

#include "core/pages.h"

void pcl::detail::LiscoIndexMemory::reserve(Indices& indices, std::size_t count) noexcept {
  try {
    indices.reserve(count);
  } catch (const std::exception&) {
    return;  // reported where they are written
  }
  lisco::populatePages(indices.data(), indices.data() + count);
}
