// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_endless_extraction.h>
#include <pcl/segmentation/impl/lisco_column_stream.hpp>

#include "lisco/export.h"

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

#define PCL_INSTANTIATE_LiscoEndlessExtraction(T) template class LISCO_EXPORT pcl::LiscoEndlessExtraction<T>;
