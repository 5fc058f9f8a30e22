// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/filters/lisco_ground_filter.h>
#include <pcl/filters/impl/filter_indices.hpp>

#include "lisco/label_ground.h"
#include "lisco/return.h"

template <typename PointT>
void pcl::LiscoGroundFilter<PointT>::applyFilter(Indices& indices) {
  const PointCloud& cloud = *this->input_;
  indices.clear();
  this->removed_indices_->clear();
  // Copied, since points without an index are no returns here.
  std::vector<std::array<float, 3>> points(cloud.size(), {0.0F, 0.0F, 0.0F});
  std::vector<std::uint8_t> ground(cloud.size());
  for (const auto index : *this->indices_) {
    if (index < 0 || static_cast<std::size_t>(index) >= cloud.size()) {
      PCL_ERROR("[pcl::%s::applyFilter] An index is not within the cloud!\n", this->getClassName().c_str());
      return;
    }
    const PointT& point = cloud[static_cast<std::size_t>(index)];
    points[static_cast<std::size_t>(index)] = {point.x, point.y, point.z};
  }
  lisco::LabelGroundParameters parameters;
  parameters.sensor_height = sensor_height_;
  parameters.max_slope = max_slope_;
  const bool is_organized = cloud.height > 1 && static_cast<std::size_t>(cloud.width) * cloud.height == cloud.size();
  parameters.lasers = is_organized ? cloud.height : 1;
  parameters.origin = {cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2]};
  try {
    lisco::labelGround(points.data(), points.size(), sizeof points[0], parameters, ground.data());
  } catch (const std::exception& error) {
    PCL_ERROR("[pcl::%s::applyFilter] %s\n", this->getClassName().c_str(), error.what());
    return;
  }
  for (const auto index : *this->indices_) {
    const auto i = static_cast<std::size_t>(index);
    const bool is_return = lisco::isReturn(points[i][0], points[i][1], points[i][2]);
    if (is_return && (ground[i] != 0) == this->negative_)
      indices.push_back(index);
    else if (this->extract_removed_indices_)
      this->removed_indices_->push_back(index);
  }
}

#define PCL_INSTANTIATE_LiscoGroundFilter(T) template class LISCO_EXPORT pcl::LiscoGroundFilter<T>;
