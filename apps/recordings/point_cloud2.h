// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <pcl/PCLPointCloud2.h>

#include "io/scan_file.h"
#include "recordings/recording.h"

namespace lisco_apps {

/// A sensor_msgs/PointCloud2; header.stamp in microseconds, as PCL has it.
/// \throws Broken if the message is malformed
pcl::PCLPointCloud2 pointCloud2In(const Message& message, const Topic& topic);

/// The points of a message, arranged as readScan () arranges those of a file; a message of several rows keeps them,
/// unless its rows are firings.
/// \throws Broken if the message describes no cloud
Scan scanOf(const pcl::PCLPointCloud2& message);

}  // namespace lisco_apps
