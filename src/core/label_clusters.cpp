// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/label_clusters.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "lisco/column_clusterer.h"

namespace lisco {

namespace {

struct Cluster {
  std::uint32_t size;
  std::uint32_t subcluster;
};

void check(const void* points, std::size_t count, std::size_t stride, const LabelParameters& parameters,
           const std::int32_t* labels) {
  if (stride < 3 * sizeof(float))
    throw std::invalid_argument("lisco::labelClusters: the stride must be 12 bytes or more");
  if (count >= std::size_t{1} << 31)
    throw std::invalid_argument("lisco::labelClusters: the number of points must be below 2^31");
  if (parameters.lasers == 0 || count % parameters.lasers != 0)
    throw std::invalid_argument("lisco::labelClusters: the number of points must be a multiple of the lasers");
  if (count > 0 && (points == nullptr || labels == nullptr))
    throw std::invalid_argument("lisco::labelClusters: points and labels must not be null");
}

}  // namespace

std::size_t labelClusters(const void* points, std::size_t count, std::size_t stride, const LabelParameters& parameters,
                          std::int32_t* labels) {
  check(points, count, stride, parameters, labels);
  constexpr std::int32_t kNoCluster = -1;
  std::fill_n(labels, count, kNoCluster);
  if (count == 0) return 0;
  const std::size_t columns = count / parameters.lasers;
  const auto* const bytes = static_cast<const unsigned char*>(points);
  const auto cell_at = [=](std::size_t laser, std::size_t column) {
    const std::size_t point = laser * columns + column;
    float xyz[3];
    std::memcpy(xyz, bytes + point * stride, sizeof xyz);
    return Return{xyz[0], xyz[1], xyz[2], static_cast<std::uint32_t>(point)};
  };

  Parameters engine;
  engine.tolerance = parameters.tolerance;
  engine.sensor = estimateSensor(columns, parameters.lasers, parameters.origin, CellSource(cell_at));
  engine.expected_returns = count;
  engine.threads = parameters.threads;
  ColumnClusterer clusterer;
  clusterer.begin(engine);
  clusterer.addColumns(columns, parameters.lasers, cell_at);
  clusterer.update();
  clusterer.forEachRun([&](const std::uint32_t* indices, std::size_t size, std::uint32_t subcluster) {
    for (std::size_t i = 0; i < size; ++i) labels[indices[i]] = static_cast<std::int32_t>(subcluster);
  });

  // PCL's order: by first point, then its unstable sort, which moves sizes alone as it moves clusters.
  std::vector<Cluster> clusters;
  std::vector<std::int32_t> label_of(clusterer.subclusterCount(), kNoCluster);
  std::vector<bool> is_seen(clusterer.subclusterCount(), false);
  for (std::size_t point = 0; point < count; ++point) {
    if (labels[point] == kNoCluster) continue;
    const auto subcluster = static_cast<std::uint32_t>(labels[point]);
    if (is_seen[subcluster]) continue;
    is_seen[subcluster] = true;
    const std::uint32_t size = clusterer.sizeOf(subcluster);
    if (size >= parameters.min_size && size <= parameters.max_size) clusters.push_back({size, subcluster});
  }
  std::sort(clusters.rbegin(), clusters.rend(), [](const Cluster& a, const Cluster& b) { return a.size < b.size; });
  for (std::size_t label = 0; label < clusters.size(); ++label)
    label_of[clusters[label].subcluster] = static_cast<std::int32_t>(label);
  for (std::size_t point = 0; point < count; ++point)
    if (labels[point] != kNoCluster) labels[point] = label_of[static_cast<std::size_t>(labels[point])];
  return clusters.size();
}

}  // namespace lisco
