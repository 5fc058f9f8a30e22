// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/features/impl/lisco_cluster_features.hpp>
#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(LiscoClusterFeatures, PCL_XYZ_POINT_TYPES)
