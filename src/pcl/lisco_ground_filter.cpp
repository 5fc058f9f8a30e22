// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include <pcl/filters/impl/lisco_ground_filter.hpp>

PCL_INSTANTIATE(LiscoGroundFilter, PCL_XYZ_POINT_TYPES)
