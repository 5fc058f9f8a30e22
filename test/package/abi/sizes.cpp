// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Prints the sizes of the public types, as a user's compiler sees them: without the states behind their pointers.
#include <cstddef>
#include <cstdio>

#include <pcl/features/lisco_cluster_features.h>
#include <pcl/filters/lisco_ground_filter.h>
#include <pcl/io/lisco_point_cloud2.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <pcl/segmentation/lisco_endless_extraction.h>
#include <pcl/segmentation/lisco_stream_extraction.h>
#include <pcl/segmentation/lisco_window_extraction.h>

#include "lisco/cluster_features.h"
#include "lisco/cluster_order.h"
#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/ground_filter.h"
#include "lisco/label_clusters.h"
#include "lisco/label_ground.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"
#include "lisco/strided_points.h"
#include "lisco/window_clusterer.h"

#define PRINT(...) std::printf("size %s: %zu\n", #__VA_ARGS__, sizeof(__VA_ARGS__))

int main() {
  PRINT(lisco::CellSource);
  PRINT(lisco::CellSource::Destination);
  PRINT(lisco::ClusterFeatures);
  PRINT(lisco::ClusterLabeller);
  PRINT(lisco::ClusterOrder);
  PRINT(lisco::ColumnClusterer);
  PRINT(lisco::EndlessCluster);
  PRINT(lisco::EndlessClusterer);
  PRINT(lisco::EndlessParameters);
  PRINT(lisco::GroundFilter);
  PRINT(lisco::GroundParameters);
  PRINT(lisco::LabelGroundParameters);
  PRINT(lisco::LabelParameters);
  PRINT(lisco::OrientedBox);
  PRINT(lisco::Parameters);
  PRINT(lisco::Return);
  PRINT(lisco::Run);
  PRINT(lisco::RunBlock);
  PRINT(lisco::RunVisitor);
  PRINT(lisco::SensorHints);
  PRINT(lisco::SingleRunBlock);
  PRINT(lisco::SizeRange);
  PRINT(lisco::StridedPoints);
  PRINT(lisco::WindowClusterer);
  PRINT(lisco::WindowParameters);
  PRINT(pcl::LiscoClusterExtraction<pcl::PointXYZ>);
  PRINT(pcl::LiscoClusterExtraction<pcl::PointXYZI>);
  PRINT(pcl::LiscoClusterFeatures<pcl::PointXYZ>);
  PRINT(pcl::LiscoClusterFeatures<pcl::PointXYZI>);
  PRINT(pcl::LiscoEndlessCluster<pcl::PointXYZ>);
  PRINT(pcl::LiscoEndlessCluster<pcl::PointXYZI>);
  PRINT(pcl::LiscoEndlessExtraction<pcl::PointXYZ>);
  PRINT(pcl::LiscoEndlessExtraction<pcl::PointXYZI>);
  PRINT(pcl::LiscoGroundFilter<pcl::PointXYZ>);
  PRINT(pcl::LiscoGroundFilter<pcl::PointXYZI>);
  PRINT(pcl::LiscoStreamExtraction<pcl::PointXYZ>);
  PRINT(pcl::LiscoStreamExtraction<pcl::PointXYZI>);
  PRINT(pcl::LiscoWindowExtraction<pcl::PointXYZ>);
  PRINT(pcl::LiscoWindowExtraction<pcl::PointXYZI>);
  PRINT(pcl::detail::LiscoCloudClusterer);
  PRINT(pcl::detail::LiscoMessageReader);
  return 0;
}
