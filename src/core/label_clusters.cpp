// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/label_clusters.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "lisco/column_clusterer.h"

namespace lisco {

class ClusterLabeller::State {
 public:
  struct Cluster {
    std::uint32_t size;
    std::uint32_t subcluster;
  };

  ColumnClusterer clusterer;
  std::vector<Cluster> clusters;       ///< of accepted sizes, by first point, then in PCL's order
  std::vector<std::int32_t> label_of;  ///< by subcluster
};

namespace {

constexpr std::int32_t kNoCluster = -1;
constexpr std::int32_t kUnseen = -2;

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
  std::fill_n(labels, count, kNoCluster);
  const std::size_t columns = count / parameters.lasers;
  const auto numbered_cells = [&](std::size_t laser, std::size_t first, std::size_t number,
                                  const CellSource::Destination& to) {
    cells.read(laser, first, number, to);
    const auto first_point = static_cast<std::uint32_t>(laser * columns + first);
    for (std::uint32_t i = 0; i < number; ++i) to.source_index[i] = first_point + i;
  };

  Parameters engine;
  engine.tolerance = parameters.tolerance;
  engine.sensor = estimateSensor(columns, parameters.lasers, parameters.origin, CellSource(numbered_cells));
  engine.expected_returns = count;
  engine.threads = parameters.threads;
  ColumnClusterer& clusterer = state_->clusterer;
  clusterer.begin(engine);
  clusterer.addColumns(columns, parameters.lasers, numbered_cells);
  clusterer.update();

  // PCL's order: by first point, as runs come, then its unstable sort, which moves sizes alone as it moves clusters.
  std::vector<State::Cluster>& clusters = state_->clusters;
  std::vector<std::int32_t>& label_of = state_->label_of;
  clusters.clear();
  label_of.assign(clusterer.subclusterCount(), kUnseen);
  clusterer.forEachRun([&](const std::uint32_t*, std::size_t, std::uint32_t subcluster) {
    if (label_of[subcluster] != kUnseen) return;
    label_of[subcluster] = kNoCluster;
    const std::uint32_t size = clusterer.sizeOf(subcluster);
    if (size >= parameters.min_size && size <= parameters.max_size) clusters.push_back({size, subcluster});
  });
  std::sort(clusters.rbegin(), clusters.rend(),
            [](const State::Cluster& a, const State::Cluster& b) { return a.size < b.size; });
  for (std::size_t label = 0; label < clusters.size(); ++label)
    label_of[clusters[label].subcluster] = static_cast<std::int32_t>(label);
  clusterer.forEachRun([&](const std::uint32_t* points, std::size_t size, std::uint32_t subcluster) {
    const std::int32_t label = label_of[subcluster];
    for (std::size_t i = 0; i < size; ++i) labels[points[i]] = label;
  });
  return clusters.size();
}

std::size_t labelClusters(const void* points, std::size_t count, std::size_t stride, const LabelParameters& parameters,
                          std::int32_t* labels) {
  if (stride < 3 * sizeof(float))
    throw std::invalid_argument("lisco::labelClusters: the stride must be 12 bytes or more");
  check(count, parameters, labels);
  if (count > 0 && points == nullptr) throw std::invalid_argument("lisco::labelClusters: points must not be null");
  const std::size_t columns = count / parameters.lasers;
  const auto* const bytes = static_cast<const unsigned char*>(points);
  const auto cell_at = [=](std::size_t laser, std::size_t column) {
    float xyz[3];
    std::memcpy(xyz, bytes + (laser * columns + column) * stride, sizeof xyz);
    return Return{xyz[0], xyz[1], xyz[2], 0};
  };
  ClusterLabeller labeller;
  return labeller.label(count, cell_at, parameters, labels);
}

}  // namespace lisco
