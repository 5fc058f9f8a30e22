// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_stream_extraction.h>
#include <pcl/segmentation/impl/lisco_column_stream.hpp>

#include "lisco/column_clusterer.h"
#include "lisco/return.h"
#include "lisco/sensor_hints.h"

template <typename PointT>
class pcl::LiscoStreamExtraction<PointT>::State : public detail::LiscoReceivedColumns<PointT> {
 public:
  /** \brief Estimates the sensor from the rotation in the store. */
  void estimateSensor(const std::array<float, 3>& origin) {
    const auto cell_at = [&store = this->store](std::size_t laser, std::size_t column) {
      if (laser >= store.rowsOf(column)) return (lisco::kNoReturn);
      const PointT& point = store.at(laser, column);
      return (lisco::Return{point.x, point.y, point.z, 0});
    };
    hints = lisco::estimateSensor(this->store.size(), this->maxRows(), origin, lisco::CellSource(cell_at), hints);
  }

  lisco::ColumnClusterer clusterer;
  lisco::SensorHints hints;  ///< of the last rotation that was ended
  bool has_ended = false;    ///< the rotation in the store
  bool is_up_to_date = false;
};

template <typename PointT>
pcl::LiscoStreamExtraction<PointT>::LiscoStreamExtraction() : state_(std::make_unique<State>()) {}

template <typename PointT>
pcl::LiscoStreamExtraction<PointT>::~LiscoStreamExtraction() = default;

template <typename PointT>
pcl::LiscoStreamExtraction<PointT>::LiscoStreamExtraction(const LiscoStreamExtraction& other)
    : Base(other),
      sensor_origin_(other.sensor_origin_),
      block_columns_(other.block_columns_),
      state_(std::make_unique<State>(*other.state_)) {}

template <typename PointT>
pcl::LiscoStreamExtraction<PointT>& pcl::LiscoStreamExtraction<PointT>::operator=(const LiscoStreamExtraction& other) {
  auto state = std::make_unique<State>(*other.state_);  // may throw: nothing has changed
  Base::operator=(other);
  sensor_origin_ = other.sensor_origin_;
  block_columns_ = other.block_columns_;
  state_ = std::move(state);
  return (*this);
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::beginRotation() {
  state_->begun = false;  // stays so after an exception, here and below
  if (state_->has_ended) state_->estimateSensor(sensor_origin_);
  lisco::Parameters parameters;
  parameters.tolerance = static_cast<float>(cluster_tolerance_);
  parameters.sensor = state_->hints;
  parameters.block_columns = block_columns_;
  parameters.keep_source_indices = false;
  state_->clusterer.begin(parameters);
  state_->clear();
  state_->begun = true;
  state_->has_ended = false;
  state_->is_up_to_date = false;
}

template <typename PointT>
bool pcl::LiscoStreamExtraction<PointT>::addColumn(const PointT* points, std::size_t count) {
  if (!state_->accepts(points, count, state_->store.size() + 1, lasers_, "pcl::LiscoStreamExtraction::addColumn"))
    return (false);
  state_->clusterer.addColumn(state_->add(points, count), count);
  state_->is_up_to_date = false;
  state_->begun = true;
  return (true);
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::update() {
  if (state_->is_up_to_date) return;
  const bool begun = state_->begun;
  state_->begun = false;
  state_->clusterer.update();
  state_->begun = begun;
  state_->is_up_to_date = true;
}

template <typename PointT>
std::size_t pcl::LiscoStreamExtraction<PointT>::getNumberOfColumns() const {
  return (state_->store.size());
}

template <typename PointT>
std::size_t pcl::LiscoStreamExtraction<PointT>::numberOfRows() const {
  return (state_->store.heightOf(0, state_->store.endColumn()));
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::copyColumns(PointT* points) const {
  state_->store.copyColumns(0, state_->store.endColumn(), points);
}

template <typename PointT>
std::size_t pcl::LiscoStreamExtraction<PointT>::getNumberOfSubclusters() {
  update();
  return (state_->clusterer.subclusterCount());
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::getSubclusterSizes(std::vector<pcl::uindex_t>& sizes) {
  update();
  sizes.resize(state_->clusterer.subclusterCount());
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = state_->clusterer.sizeOf(static_cast<std::uint32_t>(i));
}

template <typename PointT>
pcl::index_t pcl::LiscoStreamExtraction<PointT>::getSubcluster(std::size_t row, std::size_t column) {
  if (column >= state_->store.size() || row >= state_->store.rowsOf(column)) return (-1);
  update();
  const std::uint32_t subcluster = state_->clusterer.subclusterAt(row, column);
  return (subcluster == lisco::ColumnClusterer::kNone ? -1 : static_cast<pcl::index_t>(subcluster));
}

template <typename PointT>
void pcl::LiscoStreamExtraction<PointT>::getSubclusters(std::vector<PointIndices>& clusters) {
  update();
  clusters.clear();
  state_->appendClusters(state_->clusterer, 0, state_->store.endColumn(), *this, clusters);
}

template <typename PointT>
bool pcl::LiscoStreamExtraction<PointT>::endRotation(std::vector<PointIndices>& clusters) {
  if (!state_->begun) {
    PCL_ERROR("[pcl::LiscoStreamExtraction::endRotation] No rotation has begun, or after an exception.\n");
    clusters.clear();
    return (false);
  }
  update();
  state_->appendClusters(state_->clusterer, 0, state_->store.endColumn(), *this, clusters);
  state_->begun = false;
  state_->has_ended = true;
  return (true);
}

#define PCL_INSTANTIATE_LiscoStreamExtraction(T) template class LISCO_EXPORT pcl::LiscoStreamExtraction<T>;
