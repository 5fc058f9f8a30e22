// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cmath>
#include <cstddef>

#include <pcl/console/print.h>
#include <pcl/features/lisco_cluster_features.h>

template <typename PointT>
bool pcl::LiscoClusterFeatures<PointT>::computeOf(const Indices& indices, lisco::ClusterFeatures& features) {
  const Eigen::Vector4f& sensor = input_->sensor_origin_;
  if (!sensor.template head<3>().allFinite()) {
    PCL_ERROR("[pcl::LiscoClusterFeatures::compute] The sensor_origin_ of the cloud is not finite!\n");
    return (false);
  }
  points_.clear();
  for (const auto index : indices) {
    if (index < 0 || static_cast<std::size_t>(index) >= input_->size()) {
      PCL_ERROR("[pcl::LiscoClusterFeatures::compute] Index %lld is not within the cloud of %zu points!\n",
                static_cast<long long>(index), input_->size());
      return (false);
    }
    const PointT& point = (*input_)[static_cast<std::size_t>(index)];
    if (std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z))
      points_.push_back({point.x, point.y, point.z});
  }
  features =
      lisco::clusterFeatures(points_.data(), points_.size(), sizeof(points_[0]), {sensor[0], sensor[1], sensor[2]});
  return (true);
}

template <typename PointT>
void pcl::LiscoClusterFeatures<PointT>::compute(const std::vector<PointIndices>& clusters,
                                                std::vector<lisco::ClusterFeatures>& features) {
  features.clear();
  if (!input_) {
    PCL_ERROR("[pcl::LiscoClusterFeatures::compute] No input cloud!\n");
    return;
  }
  features.reserve(clusters.size());
  for (const PointIndices& cluster : clusters) {
    features.emplace_back();
    if (computeOf(cluster.indices, features.back())) continue;
    features.clear();
    return;
  }
}

template <typename PointT>
void pcl::LiscoClusterFeatures<PointT>::compute() {
  is_valid_ = false;
  if (!initCompute()) {
    PCL_ERROR("[pcl::LiscoClusterFeatures::compute] No input cloud!\n");
    return;
  }
  is_valid_ = computeOf(*indices_, features_);
  deinitCompute();
}

template <typename PointT>
bool pcl::LiscoClusterFeatures<PointT>::getFeatures(lisco::ClusterFeatures& features) const {
  features = features_;
  return (is_valid_);
}

template <typename PointT>
bool pcl::LiscoClusterFeatures<PointT>::getAABB(PointT& min_point, PointT& max_point) const {
  min_point.getVector3fMap() = Eigen::Map<const Eigen::Vector3f>(features_.min.data());
  max_point.getVector3fMap() = Eigen::Map<const Eigen::Vector3f>(features_.max.data());
  return (is_valid_);
}

template <typename PointT>
bool pcl::LiscoClusterFeatures<PointT>::getOBB(PointT& min_point, PointT& max_point, PointT& position,
                                               Eigen::Matrix3f& rotational_matrix) const {
  const lisco::OrientedBox& box = features_.box;
  const Eigen::Vector3f half = Eigen::Vector3d(box.length / 2, box.width / 2, box.height / 2).cast<float>();
  min_point.getVector3fMap() = -half;
  max_point.getVector3fMap() = half;
  position.getVector3fMap() = Eigen::Map<const Eigen::Vector3d>(box.center.data()).template cast<float>();
  const auto cosine = static_cast<float>(std::cos(box.yaw));
  const auto sine = static_cast<float>(std::sin(box.yaw));
  rotational_matrix << cosine, -sine, 0, sine, cosine, 0, 0, 0, 1;
  return (is_valid_);
}

template <typename PointT>
bool pcl::LiscoClusterFeatures<PointT>::getMassCenter(Eigen::Vector3f& mass_center) const {
  mass_center = Eigen::Map<const Eigen::Vector3d>(features_.centroid.data()).template cast<float>();
  return (is_valid_);
}

#define PCL_INSTANTIATE_LiscoClusterFeatures(T) template class LISCO_EXPORT pcl::LiscoClusterFeatures<T>;
