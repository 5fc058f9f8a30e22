// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/label_clusters.h"

#include <algorithm>
#include <stdexcept>

#include "core/parallel.h"
#include "lisco/cluster_order.h"
#include "lisco/column_clusterer.h"
#include "lisco/strided_points.h"

namespace lisco {

class ClusterLabeller::State {
 public:
  ColumnClusterer clusterer;
  ClusterOrder order;
};

namespace {

void check(std::size_t count, const LabelParameters& parameters, const std::int32_t* labels) {
  if (count >= std::size_t{1} << 31)
    throw std::invalid_argument("lisco::labelClusters: the number of points must be below 2^31");
  if (parameters.lasers == 0 || count % parameters.lasers != 0)
    throw std::invalid_argument("lisco::labelClusters: the number of points must be a multiple of the lasers");
  if (count > 0 && labels == nullptr) throw std::invalid_argument("lisco::labelClusters: labels must not be null");
}

}  // namespace

ClusterLabeller::ClusterLabeller() : state_(std::make_unique<State>()) {}
ClusterLabeller::~ClusterLabeller() = default;

std::size_t ClusterLabeller::labelAll(std::size_t count, const CellSource& cells, const LabelParameters& parameters,
                                      std::int32_t* labels) {
  check(count, parameters, labels);
  if (count == 0) return 0;
  std::fill_n(labels, count, ClusterOrder::kNoCluster);
  const std::size_t columns = count / parameters.lasers;

  Parameters engine;
  engine.tolerance = parameters.tolerance;
  engine.sensor = estimateSensor(columns, parameters.lasers, parameters.origin, cells);
  engine.expected_returns = count;
  engine.threads = std::min(parameters.threads, allThreads());
  engine.keep_source_indices = false;
  ColumnClusterer& clusterer = state_->clusterer;
  clusterer.begin(engine);
  clusterer.addColumns(columns, parameters.lasers, cells);
  clusterer.update();

  ClusterOrder& order = state_->order;
  order.assign(clusterer, parameters.min_size, parameters.max_size);
  clusterer.forEachRun([&](std::uint32_t laser, std::uint32_t column, std::size_t size, std::uint32_t subcluster) {
    std::fill_n(labels + laser * columns + column, size, order.labelOf(subcluster));
  });
  return order.count();
}

std::size_t labelClusters(const void* points, std::size_t count, std::size_t stride, const LabelParameters& parameters,
                          std::int32_t* labels) {
  if (stride < 3 * sizeof(float))
    throw std::invalid_argument("lisco::labelClusters: the stride must be 12 bytes or more");
  check(count, parameters, labels);
  if (count > 0 && points == nullptr) throw std::invalid_argument("lisco::labelClusters: points must not be null");
  const std::size_t columns = count / parameters.lasers;
  const StridedPoints all = StridedPoints::sideBySide(points, static_cast<std::ptrdiff_t>(stride));
  const auto cells = [=](std::size_t laser, std::size_t first, std::size_t number, const CellSource::Destination& to) {
    all.read(laser * columns + first, number, to);
  };
  ClusterLabeller labeller;
  return labeller.label(count, cells, parameters, labels);
}

}  // namespace lisco
