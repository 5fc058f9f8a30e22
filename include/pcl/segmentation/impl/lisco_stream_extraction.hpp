// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_stream_extraction.h>
#include <pcl/segmentation/impl/lisco_column_stream.hpp>

#include "lisco/export.h"
#include "lisco/sensor_hints.h"

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::learn() {
  const std::size_t columns = store_.size();
  const auto cell_at = [this](std::size_t laser, std::size_t column) {
    if (laser >= store_.rowsOf(column)) return (lisco::kNoReturn);
    const PointT& point = store_.at(laser, column);
    return (lisco::Return{point.x, point.y, point.z, 0});
  };
  hints_ = lisco::estimateSensor(columns, most_rows_, sensor_origin_, lisco::CellSource(cell_at));
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::beginRotation() {
  begun_ = false;  // unless nothing is thrown, here and below
  if (has_ended_) learn();
  lisco::Parameters parameters;
  parameters.tolerance = static_cast<float>(cluster_tolerance_);
  parameters.sensor = hints_;
  parameters.block_columns = block_columns_;
  clusterer_.begin(parameters);
  store_.clear();
  most_rows_ = 0;
  begun_ = true;
  has_ended_ = false;
  is_up_to_date_ = false;
}

template <typename PointT>
bool pcl::LiscoStreamExtraction<PointT>::addColumn(const PointT* points, std::size_t count) {
  if (!this->accepts(points, count, store_.size() + 1, "pcl::LiscoStreamExtraction::addColumn")) return (false);
  begun_ = false;
  most_rows_ = std::max(most_rows_, count);
  const std::uint32_t first = store_.add(points, count);
  clusterer_.addColumns(1, count, [&](std::size_t row, std::size_t) {
    return (lisco::Return{points[row].x, points[row].y, points[row].z, first + static_cast<std::uint32_t>(row)});
  });
  is_up_to_date_ = false;
  begun_ = true;
  return (true);
}

template <typename PointT>
bool pcl::LiscoStreamExtraction<PointT>::addColumn(const PointCloud& column) {
  return (addColumn(column.points.data(), column.size()));
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::update() {
  if (is_up_to_date_) return;
  const bool begun = begun_;
  begun_ = false;
  clusterer_.update();
  begun_ = begun;
  is_up_to_date_ = true;
}

template <typename PointT>
std::size_t pcl::LiscoStreamExtraction<PointT>::getNumberOfSubclusters() {
  update();
  return (clusterer_.subclusterCount());
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::getSubclusterSizes(std::vector<pcl::uindex_t>& sizes) {
  update();
  sizes.resize(clusterer_.subclusterCount());
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = clusterer_.sizeOf(static_cast<std::uint32_t>(i));
}

template <typename PointT>
pcl::index_t pcl::LiscoStreamExtraction<PointT>::getSubcluster(std::size_t row, std::size_t column) {
  if (column >= store_.size() || row >= store_.rowsOf(column)) return (-1);
  update();
  const std::uint32_t subcluster = clusterer_.subclusterAt(row, column);
  return (subcluster == lisco::ColumnClusterer::kNone ? -1 : static_cast<pcl::index_t>(subcluster));
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::getSubclusters(std::vector<PointIndices>& clusters) {
  update();
  clusters.clear();
  this->appendClusters(clusterer_, 0, store_.endColumn(), clusters);
}

template <typename PointT>
bool pcl::LiscoStreamExtraction<PointT>::endRotation(std::vector<PointIndices>& clusters) {
  if (!begun_) {
    PCL_ERROR("[pcl::LiscoStreamExtraction::endRotation] No rotation has begun, or after an exception.\n");
    clusters.clear();
    return (false);
  }
  update();
  this->appendClusters(clusterer_, 0, store_.endColumn(), clusters);
  begun_ = false;
  has_ended_ = true;
  return (true);
}

#define PCL_INSTANTIATE_LiscoStreamExtraction(T) template class LISCO_EXPORT pcl::LiscoStreamExtraction<T>;
