// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/impl/instantiate.hpp>
#include <pcl/segmentation/impl/lisco_cluster_extraction.hpp>

PCL_INSTANTIATE(LiscoClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(extractLiscoClusters_indices, PCL_XYZ_POINT_TYPES)
