// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <pcl/console/print.h>
#include <pcl/segmentation/extract_clusters.h>          // comparePointClusters
#include <pcl/segmentation/lisco_cluster_extraction.h>  // fitsIndexType
#include <pcl/segmentation/lisco_stream_extraction.h>

#include "lisco/sensor_hints.h"

// --- All streams ----------------------------------------------------------------------------------------------------

template <typename PointT>
bool pcl::detail::LiscoColumnStream<PointT>::accepts(const PointT* points, std::size_t count, std::size_t columns,
                                                     const char* caller) {
  const std::size_t rows = std::max(count, most_rows_);
  if (!begun_)
    PCL_ERROR("[%s] A column before beginRotation () or beginStream (), or after an exception.\n", caller);
  else if (!points && count > 0)
    PCL_ERROR("[%s] A column without points.\n", caller);
  else if (lasers_ != 0 && count > lasers_)
    PCL_ERROR("[%s] A column of %zu rows, and only %zu lasers were declared.\n", caller, count, lasers_);
  else if (!LiscoCloudClusterer::fitsIndexType(rows) || !LiscoCloudClusterer::fitsIndexType(columns) ||
           !LiscoCloudClusterer::fitsIndexType(columns * rows))
    PCL_ERROR("[%s] %zu columns of %zu rows are more points than pcl::index_t can number.\n", caller, columns, rows);
  else
    return (true);
  return (false);
}

template <typename PointT>
const lisco::Return* pcl::detail::LiscoColumnStream<PointT>::namedColumn(const PointT* points, std::size_t count,
                                                                         std::uint32_t first_name) {
  named_column_.resize(count);
  for (std::size_t row = 0; row < count; ++row)
    named_column_[row] = {points[row].x, points[row].y, points[row].z, first_name + static_cast<std::uint32_t>(row)};
  return (named_column_.data());
}

template <typename PointT>
template <typename Clusterer>
void pcl::detail::LiscoColumnStream<PointT>::appendClusters(Clusterer& clusterer, std::uint64_t first_column,
                                                            std::uint64_t end_column,
                                                            std::vector<PointIndices>& clusters) {
  if (store_.heightOf(first_column, end_column) == 0) {  // an empty cloud
    clusters.clear();
    return;
  }
  const std::uint64_t width = end_column - first_column;
  writer_.start(clusterer.subclusterCount(), header_, min_pts_per_cluster_, max_pts_per_cluster_, clusters);
  clusterer.forEachRun([&](const std::uint32_t* names, std::size_t count, std::uint32_t subcluster) {
    Indices* const members = writer_.indicesOf(subcluster, clusterer.sizeOf(subcluster));
    if (!members) return;
    const auto cell = store_.cellOf(names[0]);  // the others lie beside it
    auto index = static_cast<index_t>(cell.row * width + (cell.column - first_column));
    for (std::size_t i = 0; i < count; ++i) members->push_back(index++);  // there is room
  });
  // Not a stable sort: only PCL's own call on PCL's own sequence gives PCL's order among clusters of one size.
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
}

// --- Rotation by rotation -------------------------------------------------------------------------------------------

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

// --- Sliding windows ------------------------------------------------------------------------------------------------

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

// --- Without end ----------------------------------------------------------------------------------------------------

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::beginStream() {
  lisco::EndlessParameters parameters = parameters_;
  parameters.tolerance = static_cast<float>(cluster_tolerance_);
  parameters.min_size = min_pts_per_cluster_;
  parameters.max_size = max_pts_per_cluster_;
  const bool begun = begun_;
  begun_ = false;  // unless nothing is thrown, here and below
  try {
    clusterer_.begin(parameters, [this](const lisco::EndlessCluster& delivered) { deliver(delivered); });
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[pcl::LiscoEndlessExtraction::beginStream] %s.\n", error.what());
    begun_ = begun;
    return (false);
  }
  columns_per_turn_ = parameters.columns_per_turn;
  store_.clear();
  most_rows_ = 0;
  begun_ = true;
  return (true);
}

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::addColumnAt(const PointT* points, std::size_t count,
                                                      const double* given_position) {
  const char* const caller = "pcl::LiscoEndlessExtraction::addColumn";
  if (!this->accepts(points, count, store_.size() + 1, caller)) return (false);
  const double position = given_position ? *given_position : clusterer_.nextPosition();
  if (!(std::fabs(position) <= lisco::EndlessParameters::kMaxPosition)) {
    PCL_ERROR("[%s] A position of %g turns.\n", caller, position);
    return (false);
  }
  if (store_.size() > 0 && position < store_.positionOf(store_.endColumn() - 1)) {
    PCL_ERROR("[%s] A position of %.17g turns, after one of %.17g.\n", caller, position,
              store_.positionOf(store_.endColumn() - 1));
    return (false);
  }
  begun_ = false;
  most_rows_ = std::max(most_rows_, count);
  const std::uint32_t first = store_.add(points, count, position);
  const lisco::Return* const cells = this->namedColumn(points, count, first);
  if (given_position)
    clusterer_.addColumn(cells, count, position);
  else
    clusterer_.addColumn(cells, count);
  begun_ = true;
  constexpr double kKept = 1.5;  // turns, within which the engine names a cell again
  while (store_.positionOf(store_.firstColumn()) < position - kKept) store_.dropFirst();
  return (true);
}

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::addColumn(const PointT* points, std::size_t count, double position) {
  return (addColumnAt(points, count, &position));
}

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::addColumn(const PointT* points, std::size_t count) {
  if (begun_ && !(columns_per_turn_ > 0)) {
    PCL_ERROR(
        "[pcl::LiscoEndlessExtraction::addColumn] A column without a position, and the number of columns of a turn is "
        "not known.\n");
    return (false);
  }
  return (addColumnAt(points, count, nullptr));
}

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::addColumn(const PointCloud& column, double position) {
  return (addColumn(column.points.data(), column.size(), position));
}

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::addColumn(const PointCloud& column) {
  return (addColumn(column.points.data(), column.size()));
}

template <typename PointT>
void pcl::LiscoEndlessExtraction<PointT>::update() {
  if (!begun_) return;
  begun_ = false;
  clusterer_.update();
  begun_ = true;
}

template <typename PointT>
void pcl::LiscoEndlessExtraction<PointT>::finish() {
  if (!begun_) return;
  begun_ = false;
  clusterer_.finish();
  store_.clear();
  begun_ = true;
}

template <typename PointT>
void pcl::LiscoEndlessExtraction<PointT>::deliver(const lisco::EndlessCluster& delivered) {
  if (!callback_) return;
  delivered_points_.clear();
  delivered_cells_.clear();
  delivered.forEachRun([this](const std::uint32_t* names, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto cell = store_.cellOf(names[i]);
      delivered_points_.push_back(store_.pointOf(names[i]));
      delivered_cells_.push_back({cell.column, cell.row});
    }
  });
  callback_(*this, delivered);
}

#define PCL_INSTANTIATE_LiscoStreamExtraction(T) template class LISCO_EXPORT pcl::LiscoStreamExtraction<T>;
#define PCL_INSTANTIATE_LiscoWindowExtraction(T) template class LISCO_EXPORT pcl::LiscoWindowExtraction<T>;
#define PCL_INSTANTIATE_LiscoEndlessExtraction(T) template class LISCO_EXPORT pcl::LiscoEndlessExtraction<T>;
