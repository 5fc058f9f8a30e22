// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "lisco/label_clusters.h"
#include "simulation/scanner.h"
#include "simulation/scenes.h"
#include "simulation/sensor.h"

using lisco_apps::ViewCluster;
using lisco_apps::ViewScan;

namespace {

void add(ViewScan& scan, std::array<float, 3> point, std::uint32_t label, bool is_ground) {
  const auto number = static_cast<float>(scan.points.size());
  scan.points.push_back(point);
  scan.labellings.front().labels.push_back(label);
  scan.is_ground.push_back(is_ground ? 1 : 0);
  scan.intensity.push_back(std::fmod(number, 256.0F));
  scan.ring.push_back(static_cast<std::uint16_t>(scan.points.size() % 32));
}

}  // namespace

ViewScan scanOfPosts(std::size_t clusters, float radius) {
  ViewScan scan;
  scan.name = "posts.pcd";
  scan.labellings.push_back({"posts", 0.4, {}, {}});
  for (int x = -20; x <= 20; ++x)
    for (int y = -20; y <= 20; ++y) add(scan, {static_cast<float>(x), static_cast<float>(y), -2}, 0, true);
  for (int i = 0; i < 25; ++i) add(scan, {-5.0F + 0.4F * static_cast<float>(i), 17, 0}, 0, false);
  for (std::size_t k = 1; k <= clusters; ++k) {
    const float angle = 6.2831853F * static_cast<float>(k - 1) / static_cast<float>(clusters);
    const float x = radius * std::cos(angle);
    const float y = radius * std::sin(angle);
    const std::size_t size = 100 - 3 * k;
    const float height = 0.02F * static_cast<float>(size - 1);
    for (std::size_t i = 0; i < size; ++i)
      add(scan, {x, y, -1.9F + 0.02F * static_cast<float>(i)}, static_cast<std::uint32_t>(k), false);
    ViewCluster cluster;
    cluster.size = size;
    cluster.center = {static_cast<double>(x), static_cast<double>(y), -1.9 + static_cast<double>(height) / 2};
    cluster.length = cluster.width = 0.2;
    cluster.height = static_cast<double>(height);
    cluster.nearest_range = static_cast<double>(radius);
    scan.labellings.front().clusters.push_back(cluster);
  }
  return scan;
}

ViewScan largeScan() {
  const lisco_simulation::Scene scene = lisco_simulation::makeScene(5, 1);
  const lisco_simulation::SimulatedScan simulated =
      lisco_simulation::scan(scene, lisco_simulation::makeSensor("vls128"), lisco_simulation::Disturbance{});
  ViewScan scan;
  scan.name = "room.pcd";
  std::vector<std::array<float, 3>> clustered;
  for (std::size_t i = 0; i < simulated.cells.size(); ++i) {
    const lisco_simulation::SimulatedCell& cell = simulated.cells[i];
    const bool is_ground = cell.z < scene.ground_z;
    scan.points.push_back({cell.x, cell.y, cell.z});
    clustered.push_back(is_ground ? std::array<float, 3>{} : scan.points.back());
    scan.is_ground.push_back(is_ground ? 1 : 0);
    scan.ring.push_back(static_cast<std::uint16_t>(i / simulated.steps));
    scan.intensity.push_back(static_cast<float>((cell.object * 37 + i % 11) % 256));
  }
  lisco::LabelParameters parameters;
  parameters.tolerance = 0.4F;
  parameters.min_size = 10;
  parameters.lasers = simulated.lasers;
  std::vector<std::int32_t> labels(clustered.size());
  lisco::labelClusters(clustered.data(), clustered.size(), 3 * sizeof(float), parameters, labels.data());
  scan.labellings.push_back({"0.4 m", 0.4, {}, {}});
  for (const std::int32_t label : labels) scan.labellings[0].labels.push_back(static_cast<std::uint32_t>(label + 1));
  return scan;
}

ViewScan shuffled(const ViewScan& scan, std::uint32_t seed) {
  std::vector<std::size_t> order(scan.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  ViewScan result = scan;
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.points[i] = scan.points[order[i]];
    result.is_ground[i] = scan.is_ground[order[i]];
    result.ring[i] = scan.ring[order[i]];
    result.intensity[i] = scan.intensity[order[i]];
    for (std::size_t k = 0; k < scan.labellings.size(); ++k)
      result.labellings[k].labels[i] = scan.labellings[k].labels[order[i]];
  }
  return result;
}
