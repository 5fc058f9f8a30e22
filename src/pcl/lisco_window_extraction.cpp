// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/impl/instantiate.hpp>
#include <pcl/segmentation/impl/lisco_window_extraction.hpp>

PCL_INSTANTIATE(LiscoWindowExtraction, PCL_XYZ_POINT_TYPES)
