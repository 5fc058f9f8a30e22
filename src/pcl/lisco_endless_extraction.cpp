// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/impl/instantiate.hpp>
#include <pcl/segmentation/impl/lisco_endless_extraction.hpp>

PCL_INSTANTIATE(LiscoEndlessExtraction, PCL_XYZ_POINT_TYPES)
