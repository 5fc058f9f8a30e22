// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/kd_tree_baselines.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <flann/algorithms/kdtree_single_index.h>
#include <flann/flann.hpp>
#ifdef LISCO_HAS_NANOFLANN
#include <nanoflann.hpp>
#endif

#include "compare/components.h"

namespace lisco_apps {
namespace {

using Coordinates = std::vector<float>;  // x, y, z of each return

constexpr int kLeafSize = 15;  // points, as in PCL's tree

/// What a tree's search finds: unseen points are given the component at hand and join the queue.
class Flood {
 public:
  void start(std::size_t count, float squared_radius) {
    component_of_.assign(count, kUnseen);
    queue_.clear();
    queue_.reserve(count);
    squared_radius_ = squared_radius;
  }
  void see(std::size_t point) {
    if (component_of_[point] != kUnseen) return;
    component_of_[point] = component_;
    queue_.push_back(static_cast<std::uint32_t>(point));
  }
  /// Calls search (point) once for each point, component by component.
  template <typename Search>
  void spreadFromAll(Search&& search) {
    std::size_t next = 0;
    for (std::size_t seed = 0; seed < component_of_.size(); ++seed) {
      component_ = static_cast<std::uint32_t>(seed);
      see(seed);
      while (next < queue_.size()) search(queue_[next++]);
    }
  }
  float squaredRadius() const { return squared_radius_; }
  const std::vector<std::uint32_t>& components() const { return component_of_; }

 private:
  static constexpr std::uint32_t kUnseen = ~std::uint32_t{0};
  std::vector<std::uint32_t> component_of_, queue_;
  std::uint32_t component_ = 0;
  float squared_radius_ = 0;
};

class FlannResults final : public flann::ResultSet<float> {
 public:
  explicit FlannResults(Flood& flood) : flood_(flood) {}
  bool full() const override { return true; }
  void addPoint(float, std::size_t point) override { flood_.see(point); }
  float worstDist() const override { return flood_.squaredRadius(); }

 private:
  Flood& flood_;
};

void searchByFlann(Coordinates& coordinates, Flood& flood) {
  const std::size_t count = coordinates.size() / 3;
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> tree(flann::Matrix<float>(coordinates.data(), count, 3),
                                                         flann::KDTreeSingleIndexParams(kLeafSize));
  tree.buildIndex();
  FlannResults results(flood);
  const flann::SearchParams parameters(-1, 0, false);
  flood.spreadFromAll([&](std::uint32_t point) { tree.findNeighbors(results, &coordinates[3UL * point], parameters); });
}

#ifdef LISCO_HAS_NANOFLANN
/// The coordinates, as nanoflann asks for them.
struct PointSource {
  const Coordinates& coordinates;
  std::size_t kdtree_get_point_count() const { return coordinates.size() / 3; }
  float kdtree_get_pt(std::size_t point, std::size_t axis) const { return coordinates[3 * point + axis]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

struct NanoflannResults {
  using DistanceType = float;
  using IndexType = std::uint32_t;
  Flood& flood;
  std::size_t size() const { return 0; }
  bool full() const { return true; }
  bool addPoint(float, std::uint32_t point) {
    flood.see(point);
    return true;
  }
  float worstDist() const { return flood.squaredRadius(); }
};

void searchByNanoflann(Coordinates& coordinates, Flood& flood) {
  const PointSource source{coordinates};
  using Metric = nanoflann::L2_Simple_Adaptor<float, PointSource>;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, PointSource, 3, std::uint32_t> tree(
      3, source, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  tree.buildIndex();
  NanoflannResults results{flood};
  const nanoflann::SearchParams parameters(0, 0, false);
  flood.spreadFromAll([&](std::uint32_t point) { tree.findNeighbors(results, &coordinates[3UL * point], parameters); });
}
#endif

using SearchAll = void (*)(Coordinates&, Flood&);

class ByKdTree {
 public:
  explicit ByKdTree(SearchAll search_all) : search_all_(search_all) {}

  void operator()(const Problem& problem, Clusters& clusters) {
    coordinates_.clear();
    for (const auto index : *problem.returns) {
      const ComparedPoint& p = (*problem.cloud)[static_cast<std::size_t>(index)];
      coordinates_.insert(coordinates_.end(), {p.x, p.y, p.z});
    }
    // PCL's squared radius.
    const auto radius = static_cast<double>(static_cast<float>(problem.tolerance));
    flood_.start(problem.returns->size(), static_cast<float>(radius * radius));
    search_all_(coordinates_, flood_);
    output_.append(flood_.components(), problem.returns->size(), problem, clusters);
  }

 private:
  SearchAll search_all_;
  Coordinates coordinates_;
  Flood flood_;
  ComponentsToClusters output_;
};

}  // namespace

std::vector<Baseline> kdTreeBaselines() {
  std::vector<Baseline> baselines;
  baselines.push_back({"flann", "FLANN's tree, directly", ByKdTree(searchByFlann), 0x009E73});
#ifdef LISCO_HAS_NANOFLANN
  baselines.push_back({"nanoflann", "nanoflann's tree", ByKdTree(searchByNanoflann), 0xCC79A7});
#endif
  return baselines;
}

}  // namespace lisco_apps
