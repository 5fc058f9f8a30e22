// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_window_extraction.h>
#include <pcl/segmentation/impl/lisco_column_stream.hpp>

#include "lisco/window_clusterer.h"

template <typename PointT>
class pcl::LiscoWindowExtraction<PointT>::State : public detail::LiscoReceivedColumns<PointT> {
 public:
  std::size_t columns_kept = 0;  ///< at the most
  std::uint64_t window_first = 0, window_end = 0;
  lisco::WindowClusterer clusterer;
};

template <typename PointT>
pcl::LiscoWindowExtraction<PointT>::LiscoWindowExtraction() : state_(std::make_unique<State>()) {}

template <typename PointT>
pcl::LiscoWindowExtraction<PointT>::~LiscoWindowExtraction() = default;

template <typename PointT>
pcl::LiscoWindowExtraction<PointT>::LiscoWindowExtraction(const LiscoWindowExtraction& other)
    : Base(other), window_size_(other.window_size_), hop_(other.hop_), state_(std::make_unique<State>(*other.state_)) {}

template <typename PointT>
pcl::LiscoWindowExtraction<PointT>& pcl::LiscoWindowExtraction<PointT>::operator=(const LiscoWindowExtraction& other) {
  auto state = std::make_unique<State>(*other.state_);  // may throw: nothing has changed
  Base::operator=(other);
  window_size_ = other.window_size_;
  hop_ = other.hop_;
  state_ = std::move(state);
  return (*this);
}

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::beginStream() {
  if (!detail::LiscoCloudClusterer::fitsIndexType(window_size_)) {
    PCL_ERROR("[pcl::LiscoWindowExtraction::beginStream] A window of %zu columns.\n", window_size_);
    return (false);
  }
  const bool begun = state_->begun;
  state_->begun = false;  // stays so after an exception, here and below
  lisco::WindowParameters parameters;
  parameters.tolerance = static_cast<float>(cluster_tolerance_);
  parameters.window_columns = window_size_;
  parameters.hop_columns = hop_;
  parameters.keep_source_indices = false;
  try {
    state_->clusterer.begin(parameters);
  } catch (const std::invalid_argument&) {
    PCL_ERROR("[pcl::LiscoWindowExtraction::beginStream] A window of %zu columns is no multiple of a hop of %zu.\n",
              window_size_, hop_);
    state_->begun = begun;
    return (false);
  }
  state_->clear();
  state_->window_first = state_->window_end = 0;
  state_->columns_kept = window_size_ + hop_;
  state_->begun = true;
  return (true);
}

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::addColumn(const PointT* points, std::size_t count) {
  if (!state_->accepts(points, count, state_->columns_kept, lasers_, "pcl::LiscoWindowExtraction::addColumn"))
    return (false);
  const bool window_ends = state_->clusterer.addColumn(state_->add(points, count), count);
  state_->begun = true;
  if (!window_ends) return (false);
  state_->window_end = state_->store.endColumn();
  state_->window_first = state_->window_end - state_->clusterer.columnCount();
  while (state_->store.firstColumn() < state_->window_first) state_->store.dropFirst();
  return (true);
}

template <typename PointT>
bool pcl::LiscoWindowExtraction<PointT>::extract(std::vector<PointIndices>& clusters) {
  if (!state_->begun || state_->window_first == state_->window_end) {
    PCL_ERROR("[pcl::LiscoWindowExtraction::extract] No window has ended, or after an exception.\n");
    clusters.clear();
    return (false);
  }
  state_->appendClusters(state_->clusterer, state_->window_first, state_->window_end, *this, clusters);
  return (true);
}

template <typename PointT>
std::size_t pcl::LiscoWindowExtraction<PointT>::getNumberOfColumns() const {
  return (static_cast<std::size_t>(state_->window_end - state_->window_first));
}

template <typename PointT>
std::size_t pcl::LiscoWindowExtraction<PointT>::numberOfRows() const {
  return (state_->store.heightOf(state_->window_first, state_->window_end));
}

template <typename PointT>
void pcl::LiscoWindowExtraction<PointT>::copyColumns(PointT* points) const {
  state_->store.copyColumns(state_->window_first, state_->window_end, points);
}

#define PCL_INSTANTIATE_LiscoWindowExtraction(T) template class LISCO_EXPORT pcl::LiscoWindowExtraction<T>;
