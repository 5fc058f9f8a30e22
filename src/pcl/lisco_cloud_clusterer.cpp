// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/segmentation/lisco_cloud_clusterer.h>

#include <algorithm>
#include <limits>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_cluster_writer.h>

#include "lisco/column_clusterer.h"
#include "lisco/sensor_hints.h"

namespace pcl {

namespace detail {

class LiscoCloudClusterer::State {
 public:
  bool select(std::size_t points, const Indices* indices, const char* caller);
  void cluster(const Layout& layout, const lisco::CellSource& points, float tolerance, unsigned int threads);
  void collect(const Indices* indices, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
               std::vector<PointIndices>& clusters);

 private:
  template <typename Cells>
  void clusterCells(std::size_t columns, std::size_t lasers, const std::array<float, 3>& sensor_origin,
                    const Cells& cells, float tolerance, unsigned int threads);

  enum class Selection { kAll, kMany, kFew };  ///< few points are sorted out beforehand

  lisco::ColumnClusterer clusterer_;
  Selection selection_ = Selection::kAll;
  std::vector<char> is_selected_;                   ///< per point of the cloud, of kMany
  Indices few_points_;                              ///< of kFew, ascending
  std::vector<std::uint32_t> subcluster_of_point_;  ///< only where the order of the indices is needed
  LiscoClusterWriter writer_;
};

bool LiscoCloudClusterer::State::select(std::size_t points, const Indices* indices, const char* caller) {
  if (!fitsIndexType(points)) {
    PCL_ERROR("[%s] The cloud has %zu points, more than pcl::index_t can number.\n", caller, points);
    return (false);
  }
  if (indices)
    for (const auto& index : *indices)
      if (index < 0 || static_cast<std::size_t>(index) >= points) {
        PCL_ERROR("[%s] Index %lld is not within the cloud of %zu points.\n", caller, static_cast<long long>(index),
                  points);
        return (false);
      }

  // A small part of a cloud is sorted out beforehand, so that the rest of the cloud costs nothing.
  constexpr std::size_t kSmallPart = 8;
  selection_ = !indices ? Selection::kAll : indices->size() < points / kSmallPart ? Selection::kFew : Selection::kMany;
  if (selection_ == Selection::kFew) {
    few_points_ = *indices;
    std::sort(few_points_.begin(), few_points_.end());
    few_points_.erase(std::unique(few_points_.begin(), few_points_.end()), few_points_.end());
  } else if (selection_ == Selection::kMany) {
    is_selected_.assign(points, 0);
    for (const auto& index : *indices) is_selected_[static_cast<std::size_t>(index)] = 1;
  }
  return (true);
}

void LiscoCloudClusterer::State::cluster(const Layout& layout, const lisco::CellSource& points, float tolerance,
                                         unsigned int threads) {
  using Destination = lisco::CellSource::Destination;
  // Lasers are the cloud's rows and columns its columns; what is not organized is the work of one laser.
  const bool organized =
      selection_ != Selection::kFew && layout.height > 1 && layout.width * layout.height == layout.points;
  const std::size_t lasers = organized ? layout.height : 1;
  const std::size_t columns = (selection_ == Selection::kFew ? few_points_.size() : layout.points) / lasers;
  const auto cluster = [&](const auto& cells) {
    clusterCells(columns, lasers, layout.sensor_origin, cells, tolerance, threads);
  };
  switch (selection_) {
    case Selection::kAll:
      cluster([&](std::size_t laser, std::size_t first, std::size_t count, const Destination& to) {
        points.read(0, laser * columns + first, count, to);
      });
      break;
    case Selection::kMany:
      cluster([&](std::size_t laser, std::size_t first, std::size_t count, const Destination& to) {
        const std::size_t point = laser * columns + first;
        points.read(0, point, count, to);
        const char* const is_selected = is_selected_.data() + point;
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        for (std::size_t i = 0; i < count; ++i) to.x[i] = is_selected[i] ? to.x[i] : kNan;  // no return
      });
      break;
    case Selection::kFew:
      cluster([&](std::size_t, std::size_t first, std::size_t count, const Destination& to) {
        for (std::size_t i = 0, adjacent = 1; i < count; i += adjacent) {
          const index_t* const point = few_points_.data() + first + i;
          adjacent = 1;
          while (i + adjacent < count && point[adjacent] == point[adjacent - 1] + 1) ++adjacent;
          points.read(0, static_cast<std::size_t>(*point), adjacent,
                      {to.x + i, to.y + i, to.z + i, to.source_index + i});
        }
      });
      break;
  }
}

template <typename Cells>
void LiscoCloudClusterer::State::clusterCells(std::size_t columns, std::size_t lasers,
                                              const std::array<float, 3>& sensor_origin, const Cells& cells,
                                              float tolerance, unsigned int threads) {
  lisco::Parameters parameters;
  parameters.tolerance = tolerance;
  parameters.sensor = lisco::estimateSensor(columns, lasers, sensor_origin, lisco::CellSource(cells));
  parameters.expected_returns = columns * lasers;
  parameters.threads = threads;
  clusterer_.begin(parameters);
  clusterer_.addColumns(columns, lasers, cells);
  clusterer_.update();
}

void LiscoCloudClusterer::State::collect(const Indices* indices, const PCLHeader& header, uindex_t min_size,
                                         uindex_t max_size, std::vector<PointIndices>& clusters) {
  writer_.start(clusterer_.subclusterCount(), header, min_size, max_size, clusters);

  // The order of the clusters is that of their first points in the indices; within each, indices ascend.
  if (indices && !std::is_sorted(indices->begin(), indices->end())) {
    std::uint32_t points = 0;
    for (const auto& index : *indices) points = std::max(points, static_cast<std::uint32_t>(index) + 1);
    constexpr std::uint32_t kNone = lisco::ColumnClusterer::kNone;
    subcluster_of_point_.assign(points, kNone);
    clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
      for (std::size_t i = 0; i < count; ++i) subcluster_of_point_[cells[i]] = subcluster;
    });
    for (const auto& index : *indices) {
      const std::uint32_t subcluster = subcluster_of_point_[static_cast<std::size_t>(index)];
      if (subcluster != kNone) writer_.indicesOf(subcluster, clusterer_.sizeOf(subcluster));
    }
  }
  clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
    Indices* const members = writer_.indicesOf(subcluster, clusterer_.sizeOf(subcluster));
    if (members) members->insert(members->end(), cells, cells + count);  // there is room
  });
}

// --- The public face ------------------------------------------------------------------------------------------------

LiscoCloudClusterer::LiscoCloudClusterer() : state_(std::make_unique<State>()) {}
LiscoCloudClusterer::~LiscoCloudClusterer() = default;
LiscoCloudClusterer::LiscoCloudClusterer(const LiscoCloudClusterer& other)
    : state_(std::make_unique<State>(*other.state_)) {}
LiscoCloudClusterer& LiscoCloudClusterer::operator=(const LiscoCloudClusterer& other) {
  *state_ = *other.state_;
  return (*this);
}

bool LiscoCloudClusterer::clusterPoints(const Layout& layout, const lisco::CellSource& points, const Indices* indices,
                                        float tolerance, unsigned int threads, const char* caller) {
  if (!state_->select(layout.points, indices, caller)) return (false);
  state_->cluster(layout, points, tolerance, threads);
  return (true);
}

void LiscoCloudClusterer::collect(const Indices* indices, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
                                  std::vector<PointIndices>& clusters) {
  state_->collect(indices, header, min_size, max_size, clusters);
}

bool LiscoCloudClusterer::fitsIndexType(std::size_t points) {
  // The engine numbers points and runs with 31 bits.
  return (points <= static_cast<std::size_t>(std::numeric_limits<index_t>::max()) && points < std::size_t{1} << 31);
}

}  // namespace detail

}  // namespace pcl
