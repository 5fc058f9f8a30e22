// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/baselines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "compare/components.h"
#include "compare/kd_tree_baselines.h"
#include "core/sorted_element.h"
#include "io/point_geometry.h"
#include "lisco/return.h"
#include "reference/voxel_grid.h"

namespace lisco_apps {
namespace {

using Search = pcl::search::Search<ComparedPoint>;

template <typename Extraction>
void extractBy(Extraction& extraction, const Problem& problem, Clusters& clusters) {
  extraction.setInputCloud(problem.cloud);
  extraction.setClusterTolerance(problem.tolerance);
  extraction.setMinClusterSize(problem.min_size);
  extraction.setMaxClusterSize(problem.max_size);
  extraction.extract(clusters);
}

/// PCL with a search method that is made for each problem, as its tutorial does; nullptr: PCL's own choice.
template <typename MakeSearch>
auto byPcl(MakeSearch make_search) {
  return [make_search](const Problem& problem, Clusters& clusters) {
    pcl::EuclideanClusterExtraction<ComparedPoint> extraction;
    const Search::Ptr search = make_search(problem);
    if (search != nullptr) extraction.setSearchMethod(search);
    extraction.setIndices(problem.returns);
    extractBy(extraction, problem, clusters);
  };
}

/// Refuses problems at which PCL's octree ends the program: with too many levels, or cells of 1.2e-7 m or less.
void checkOctreeHolds(const Problem& problem) {
  constexpr float kMinCell = 1e-5F;     // metres
  constexpr float kMaxCells = 1 << 28;  // from the origin to the farthest return
  const auto cell = static_cast<float>(std::fabs(problem.tolerance));
  if (!(cell >= kMinCell)) throw std::runtime_error("the tolerance is too small for an octree");
  for (const auto index : *problem.returns) {
    const ComparedPoint& p = (*problem.cloud)[static_cast<std::size_t>(index)];
    if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) / cell > kMaxCells)
      throw std::runtime_error("the scan has too many cells for an octree");
  }
}

lisco::Return returnAt(const Problem& problem, pcl::index_t index) {
  const ComparedPoint& p = (*problem.cloud)[static_cast<std::size_t>(index)];
  return {p.x, p.y, p.z, static_cast<std::uint32_t>(index)};
}

class ByVoxelGrid {
 public:
  void operator()(const Problem& problem, Clusters& clusters) {
    // As Lisco does, it finds the returns in the cloud; the reference takes indices.
    const ComparedCloud& cloud = *problem.cloud;
    returns_.resize(cloud.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      returns_[count] = {cloud[i].x, cloud[i].y, cloud[i].z, static_cast<std::uint32_t>(i)};
      count += isReturn(cloud[i]) ? 1 : 0;
    }
    returns_.resize(count);
    const auto& component_of = grid_.cluster(returns_, static_cast<float>(problem.tolerance));
    output_.append(component_of, returns_.size(), problem, clusters);
  }

 private:
  std::vector<lisco::Return> returns_;
  lisco_reference::VoxelGrid grid_;
  ComponentsToClusters output_;
};

class ByThePaper {
 public:
  void operator()(const Problem& problem, Clusters& clusters) {
    const ComparedCloud& cloud = *problem.cloud;
    if (cloud_ != problem.cloud) {  // the sensor is known beforehand
      sensor_ = nominalSensor(cloud);
      cloud_ = problem.cloud;
    }
    matrix_.resize(cloud.size());
    for (std::size_t row = 0; row < cloud.height; ++row)
      for (std::size_t column = 0; column < cloud.width; ++column)
        matrix_[column * cloud.height + row] = returnAt(problem, static_cast<pcl::index_t>(row * cloud.width + column));
    const auto& cluster_of_cell = paper_.cluster(matrix_, cloud.height, sensor_, static_cast<float>(problem.tolerance));
    component_of_.clear();
    for (const auto index : *problem.returns) {
      // A cloud with returns is not empty. NOLINTNEXTLINE(clang-analyzer-core.DivideZero)
      const auto row = static_cast<std::size_t>(index) / cloud.width;
      const auto column = static_cast<std::size_t>(index) % cloud.width;
      component_of_.push_back(cluster_of_cell[column * cloud.height + row]);
    }
    output_.append(component_of_, cloud.size(), problem, clusters);
  }

 private:
  ComparedCloud::ConstPtr cloud_;
  lisco_reference::NominalSensor sensor_{};
  std::vector<lisco::Return> matrix_;
  std::vector<std::uint32_t> component_of_;
  lisco_reference::PaperLisco paper_;
  ComponentsToClusters output_;
};

}  // namespace

lisco_reference::NominalSensor nominalSensor(const ComparedCloud& cloud) {
  double min_step = kPi;
  double before = std::nan("");
  for (std::size_t row = 0; row < cloud.height; ++row) {
    std::vector<double> elevations;
    for (std::size_t column = 0; column < cloud.width; ++column) {
      const ComparedPoint& p = cloud.at(static_cast<int>(column), static_cast<int>(row));
      if (isReturn(p)) elevations.push_back(elevationOf(p));
    }
    if (elevations.empty()) continue;
    const double middle = lisco::sortedElement(elevations, elevations.size() / 2);
    if (std::isfinite(before)) min_step = std::min(min_step, std::fabs(middle - before));
    before = middle;
  }
  return {2 * kPi / cloud.width, min_step};
}

Baseline referenceBaseline() {
  return {kReferenceKey, "PCL, KdTree (false)",
          byPcl([](const Problem&) { return std::make_shared<pcl::search::KdTree<ComparedPoint>>(false); }), 0x000000};
}

Baseline liscoBaseline(unsigned threads) {
  pcl::LiscoClusterExtraction<ComparedPoint> extraction;
  extraction.setNumberOfThreads(threads);
  const auto extract = [extraction](const Problem& problem, Clusters& clusters) mutable {
    extractBy(extraction, problem, clusters);
  };
  return {"lisco", "Lisco for PCL", extract, 0xD55E00};
}

std::vector<Baseline> allBaselines() {
  const auto sorted_tree = [](const Problem&) { return std::make_shared<pcl::search::KdTree<ComparedPoint>>(); };
  const auto octree = [](const Problem& problem) {
    checkOctreeHolds(problem);
    return std::make_shared<pcl::search::Octree<ComparedPoint>>(std::fabs(problem.tolerance));
  };
  // Okabe and Ito's colours, distinct with colour blindness.
  std::vector<Baseline> all{referenceBaseline(),
                            {"pcl-tutorial", "PCL, KdTree as in its tutorial", byPcl(sorted_tree), 0x999999},
                            {"pcl-octree", "PCL, Octree", byPcl(octree), 0x56B4E9},
                            {"pcl-default", "PCL, no search method given",
                             byPcl([](const Problem&) { return Search::Ptr(); }), 0xF0E442, false},
                            {"grid", "voxel grid", ByVoxelGrid(), 0x0072B2},
                            {"paper", "Lisco as in the paper", ByThePaper(), 0xE69F00, true, true},
                            liscoBaseline(1)};
  std::vector<Baseline> trees = kdTreeBaselines();
  all.insert(all.begin() + 4, std::make_move_iterator(trees.begin()), std::make_move_iterator(trees.end()));
  return all;
}

}  // namespace lisco_apps
