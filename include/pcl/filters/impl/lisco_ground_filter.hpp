// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/filters/lisco_ground_filter.h>
#include <pcl/filters/impl/filter_indices.hpp>

#include "lisco/return.h"

template <typename PointT>
void pcl::LiscoGroundFilter<PointT>::applyFilter(Indices& indices) {
  const PointCloud& cloud = *this->input_;
  const Indices& selected = *this->indices_;  // may be the output, too
  Indices& removed = *this->removed_indices_;
  removed.clear();
  const auto is_outside = [&](index_t index) { return index < 0 || static_cast<std::size_t>(index) >= cloud.size(); };
  if (!this->fake_indices_ && std::any_of(selected.begin(), selected.end(), is_outside)) {
    PCL_ERROR("[pcl::%s::applyFilter] An index is not within the cloud!\n", this->getClassName().c_str());
    indices.clear();
    return;
  }
  // Coordinates that lie apart in PointT are copied; so are selected points, among no returns.
  const float* xyz = cloud.empty() ? nullptr : &cloud[0].x;
  std::size_t stride = sizeof(PointT);
  if (xyz && (!this->fake_indices_ || &cloud[0].y != xyz + 1 || &cloud[0].z != xyz + 2)) {
    copy_.assign(cloud.size(), {0.0F, 0.0F, 0.0F});
    for (const auto index : selected) {
      const PointT& point = cloud[static_cast<std::size_t>(index)];
      copy_[static_cast<std::size_t>(index)] = {point.x, point.y, point.z};
    }
    xyz = copy_[0].data();
    stride = sizeof copy_[0];
  }
  ground_.resize(cloud.size());
  lisco::LabelGroundParameters parameters;
  parameters.sensor_height = sensor_height_;
  parameters.max_slope = max_slope_;
  const bool is_organized =
      cloud.width > 1 && cloud.height > 1 && static_cast<std::size_t>(cloud.width) * cloud.height == cloud.size();
  parameters.lasers = is_organized ? cloud.height : 1;
  parameters.origin = {cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2]};
  try {
    labeller_.label(xyz, cloud.size(), stride, parameters, ground_.data());
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[pcl::%s::applyFilter] %s\n", this->getClassName().c_str(), error.what());
    indices.clear();
    return;
  }
  // Written always, counted if they belong there.
  indices.resize(selected.size());
  removed.resize(this->extract_removed_indices_ ? selected.size() : 1);
  std::size_t kept = 0, others = 0;
  const std::size_t removes = this->extract_removed_indices_ ? 1 : 0;
  const std::uint8_t is_kept = this->negative_ ? 1 : 0;
  for (const auto index : selected) {
    const PointT& point = cloud[static_cast<std::size_t>(index)];
    const bool is_label_kept = ground_[static_cast<std::size_t>(index)] == is_kept;
    const std::size_t keep = std::size_t{lisco::isReturn(point.x, point.y, point.z)} & std::size_t{is_label_kept};
    indices[kept] = index;
    removed[others] = index;
    kept += keep;
    others += removes & (keep ^ 1U);
  }
  indices.resize(kept);
  removed.resize(others);
}

#define PCL_INSTANTIATE_LiscoGroundFilter(T) template class LISCO_EXPORT pcl::LiscoGroundFilter<T>;
