// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <stdexcept>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_window_extraction.h>
#include <pcl/segmentation/impl/lisco_column_stream.hpp>

#include "lisco/export.h"

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::beginStream() {
  const bool begun = begun_;
  begun_ = false;  // unless nothing is thrown, here and below
  try {
    clusterer_.begin({static_cast<float>(cluster_tolerance_), window_size_, hop_, 0});
  } catch (const std::invalid_argument&) {
    PCL_ERROR("[pcl::LiscoWindowExtraction::beginStream] A window of %zu columns is no multiple of a hop of %zu.\n",
              window_size_, hop_);
    begun_ = begun;
    return (false);
  }
  store_.clear();
  most_rows_ = 0;
  window_first_ = window_end_ = 0;
  columns_kept_ = window_size_ + hop_;
  begun_ = true;
  return (true);
}

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::addColumn(const PointT* points, std::size_t count) {
  if (!this->accepts(points, count, columns_kept_, "pcl::LiscoWindowExtraction::addColumn")) return (false);
  begun_ = false;
  most_rows_ = std::max(most_rows_, count);
  const std::uint32_t first = store_.add(points, count);
  const bool window_ends = clusterer_.addColumn(this->namedColumn(points, count, first), count);
  begun_ = true;
  if (!window_ends) return (false);
  window_end_ = store_.endColumn();
  window_first_ = window_end_ - clusterer_.columnCount();
  while (store_.firstColumn() < window_first_) store_.dropFirst();
  return (true);
}

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::addColumn(const PointCloud& column) {
  return (addColumn(column.points.data(), column.size()));
}

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::extract(std::vector<PointIndices>& clusters) {
  if (!begun_ || window_first_ == window_end_) {
    PCL_ERROR("[pcl::LiscoWindowExtraction::extract] No window has ended, or after an exception.\n");
    clusters.clear();
    return (false);
  }
  this->appendClusters(clusterer_, window_first_, window_end_, clusters);
  return (true);
}

#define PCL_INSTANTIATE_LiscoWindowExtraction(T) template class LISCO_EXPORT pcl::LiscoWindowExtraction<T>;
