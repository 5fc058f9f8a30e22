// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

/** \file
 * The only place that depends on PCL's version. PCL 1.12 to 1.15 have all that Lisco uses, under the same names:
 *   - pcl::index_t, pcl::uindex_t and pcl::Indices (before 1.12, cluster sizes were int);
 *   - PointCloud, PointIndices, PCLBase, search::Search, comparePointClusters (), PCL_ERROR;
 *   - PCL_INSTANTIATE and PCL_XYZ_POINT_TYPES.
 * Lisco avoids what differs: PCL_EXPORTS, which exports nothing on Linux before 1.14 (LISCO_EXPORT instead); and memory
 * of Eigen's allocator that one side allocates and the other frees, of which PCL's headers warn from 1.14 on.
 */

#include <pcl/pcl_config.h>

#if PCL_VERSION < PCL_VERSION_CALC(1, 12, 0)
#error "Lisco needs PCL 1.12 or newer"
#endif
