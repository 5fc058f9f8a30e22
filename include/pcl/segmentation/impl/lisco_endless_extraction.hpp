// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_endless_extraction.h>
#include <pcl/segmentation/impl/lisco_column_stream.hpp>

#include "lisco/endless_clusterer.h"

template <typename PointT>
class pcl::LiscoEndlessExtraction<PointT>::State : public detail::LiscoReceivedColumns<PointT> {
 public:
  /** \brief Looks up the points of a cluster and passes them on. */
  void deliver(const lisco::EndlessCluster& delivered) {
    if (!receiver) return;
    points_.clear();
    cells_.clear();
    delivered.forEachRun([this](const std::uint32_t* ids, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        const auto cell = this->store.cellOf(ids[i]);
        points_.push_back(this->store.pointOf(ids[i]));
        cells_.push_back({cell.column, cell.row});
      }
    });
    receiver(delivered, points_.data(), cells_.data());
  }

  double columns_per_turn = 0;  ///< of the stream
  Receiver receiver;
  lisco::EndlessClusterer clusterer;

 private:
  // Of the cluster that is being delivered:
  std::vector<PointT> points_;
  std::vector<typename Cluster::Cell> cells_;
};

template <typename PointT>
pcl::LiscoEndlessExtraction<PointT>::LiscoEndlessExtraction() : state_(std::make_unique<State>()) {}

template <typename PointT>
pcl::LiscoEndlessExtraction<PointT>::~LiscoEndlessExtraction() = default;

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::beginStream() {
  lisco::EndlessParameters parameters;
  parameters.tolerance = static_cast<float>(cluster_tolerance_);
  parameters.min_size = min_pts_per_cluster_;
  parameters.max_size = max_pts_per_cluster_;
  parameters.origin = sensor_origin_;
  parameters.clockwise = clockwise_;
  parameters.start_azimuth = start_azimuth_;
  parameters.stagger = stagger_;
  parameters.columns_per_turn = columns_per_turn_;
  parameters.block_columns = block_columns_;
  const bool begun = state_->begun;
  state_->begun = false;  // stays so after an exception, here and below
  try {
    state_->clusterer.begin(
        parameters, [state = state_.get()](const lisco::EndlessCluster& delivered) { state->deliver(delivered); });
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[pcl::LiscoEndlessExtraction::beginStream] %s.\n", error.what());
    state_->begun = begun;
    return (false);
  }
  state_->columns_per_turn = parameters.columns_per_turn;
  state_->clear();
  state_->begun = true;
  return (true);
}

template <typename PointT>
bool pcl::LiscoEndlessExtraction<PointT>::addColumnAt(const PointT* points, std::size_t count,
                                                      const double* given_position) {
  const char* const caller = "pcl::LiscoEndlessExtraction::addColumn";
  if (!state_->accepts(points, count, state_->store.size() + 1, lasers_, caller)) return (false);
  if (!given_position && !(state_->columns_per_turn > 0)) {
    PCL_ERROR("[%s] A column without a position, and the number of columns of a turn is not known.\n", caller);
    return (false);
  }
  const double position = given_position ? *given_position : state_->clusterer.nextPosition();
  if (!(std::fabs(position) <= lisco::EndlessParameters::kMaxPosition)) {
    PCL_ERROR("[%s] A position of %g turns.\n", caller, position);
    return (false);
  }
  if (state_->store.size() > 0 && position < state_->store.positionOf(state_->store.endColumn() - 1)) {
    PCL_ERROR("[%s] A position of %.17g turns, after one of %.17g.\n", caller, position,
              state_->store.positionOf(state_->store.endColumn() - 1));
    return (false);
  }
  const lisco::Return* const cells = state_->add(points, count, position);
  if (given_position)
    state_->clusterer.addColumn(cells, count, position);
  else
    state_->clusterer.addColumn(cells, count);
  state_->begun = true;
  constexpr double kKept = 1.5;  // turns, within which the engine delivers a cell
  while (state_->store.positionOf(state_->store.firstColumn()) < position - kKept) state_->store.dropFirst();
  return (true);
}

template <typename PointT>
void pcl::LiscoEndlessExtraction<PointT>::update() {
  if (!state_->begun) return;
  state_->begun = false;
  state_->clusterer.update();
  state_->begun = true;
}

template <typename PointT>
void pcl::LiscoEndlessExtraction<PointT>::finish() {
  if (!state_->begun) return;
  state_->begun = false;
  state_->clusterer.finish();
  state_->store.clear();
  state_->begun = true;
}

template <typename PointT>
std::uint64_t pcl::LiscoEndlessExtraction<PointT>::getNumberOfReturns() const {
  return (state_->clusterer.returnCount());
}

template <typename PointT>
std::uint64_t pcl::LiscoEndlessExtraction<PointT>::getNumberOfOutliers() const {
  return (state_->clusterer.outlierCount());
}

template <typename PointT>
std::size_t pcl::LiscoEndlessExtraction<PointT>::getNumberOfColumnsHeld() const {
  return (state_->store.size());
}

template <typename PointT>
void pcl::LiscoEndlessExtraction<PointT>::setReceiver(Receiver receiver) {
  state_->receiver = std::move(receiver);
}

#define PCL_INSTANTIATE_LiscoEndlessExtraction(T) template class LISCO_EXPORT pcl::LiscoEndlessExtraction<T>;
