// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pcl/segmentation/lisco_cloud_clusterer.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <thread>

#include <pcl/console/print.h>
#include <pcl/segmentation/lisco_cluster_writer.h>

#include "lisco/column_clusterer.h"
#include "lisco/sensor_hints.h"

namespace pcl::detail {

class LiscoCloudClusterer::State {
 public:
  lisco::ColumnClusterer clusterer;
  lisco::SensorHints sensor;                       ///< estimated for the latest cloud
  std::size_t columns = 0;                         ///< of that cloud
  bool has_few_points = false;                     ///< of which few_points are selected
  std::vector<char> is_selected;                   ///< per point of the cloud; where many are selected
  Indices few_points;                              ///< ascending; where few are selected
  std::vector<std::uint32_t> subcluster_of_point;  ///< only where the order of the indices is needed
  LiscoClusterPlaces places;
};

LiscoCloudClusterer::LiscoCloudClusterer() : state_(std::make_unique<State>()) {}
LiscoCloudClusterer::~LiscoCloudClusterer() = default;
LiscoCloudClusterer::LiscoCloudClusterer(const LiscoCloudClusterer& other)
    : state_(std::make_unique<State>(*other.state_)) {}
LiscoCloudClusterer& LiscoCloudClusterer::operator=(const LiscoCloudClusterer& other) {
  state_ = std::make_unique<State>(*other.state_);
  return (*this);
}

bool LiscoCloudClusterer::clusterPoints(const Layout& layout, const lisco::StridedPoints& points,
                                        const Indices* indices, float tolerance, unsigned int threads,
                                        const char* caller) {
  if (!fitsIndexType(layout.points)) {
    PCL_ERROR("[%s] The cloud has %zu points, more than pcl::index_t can number.\n", caller, layout.points);
    return (false);
  }
  if (indices)
    for (const auto& index : *indices)
      if (index < 0 || static_cast<std::size_t>(index) >= layout.points) {
        PCL_ERROR("[%s] Index %lld is not within the cloud of %zu points.\n", caller, static_cast<long long>(index),
                  layout.points);
        return (false);
      }

  // A small selection is sorted out beforehand, so that the rest of the cloud costs no time.
  constexpr std::size_t kSmallPart = 8;
  const bool few = indices && indices->size() < layout.points / kSmallPart;
  Indices& few_points = state_->few_points;
  if (few) {
    few_points = *indices;
    std::sort(few_points.begin(), few_points.end());
    few_points.erase(std::unique(few_points.begin(), few_points.end()), few_points.end());
  }

  // Lasers are the cloud's rows and columns its columns; an unorganized selection has one laser. So has a cloud of one
  // column, as lists of points are often stored: a laser for each would take far more time and memory.
  const bool organized = !few && layout.width > 1 && layout.height > 1 && layout.width * layout.height == layout.points;
  const std::size_t lasers = organized ? layout.height : 1;
  const std::size_t columns = (few ? few_points.size() : layout.points) / lasers;
  state_->columns = columns;
  state_->has_few_points = few;
  static const unsigned int cores = std::max(1U, std::thread::hardware_concurrency());
  const auto cluster = [&](const auto& cells) {
    lisco::Parameters parameters;
    parameters.tolerance = tolerance;
    state_->sensor =
        lisco::estimateSensor(columns, lasers, layout.sensor_origin, lisco::CellSource(cells), state_->sensor);
    parameters.sensor = state_->sensor;
    parameters.expected_returns = columns * lasers;
    parameters.threads = std::min(threads, cores);
    parameters.keep_source_indices = false;
    state_->clusterer.begin(parameters);
    state_->clusterer.addColumns(columns, lasers, cells);
    state_->clusterer.update();
  };
  using Destination = lisco::CellSource::Destination;
  const auto read = [&](std::size_t first, std::size_t count, const Destination& to) {
    points.read(first, count, to);
    // What is mostly read next: the same columns of the next row, or the next columns of the first one. Requested after
    // the copy, whose own loads would wait for these.
    constexpr std::size_t kCacheLine = 64;
    const std::size_t below = first + columns;
    const std::size_t next = below < layout.points ? below : below - layout.points + count;
    const auto stride = static_cast<std::size_t>(points.stride);
    const char* const bytes = static_cast<const char*>(points.x) + next * stride;
    const std::size_t size = std::min(count, layout.points - next) * stride;
    for (std::size_t i = 0; i < size; i += kCacheLine) __builtin_prefetch(bytes + i, 0, 2);
  };
  if (few) {
    cluster([&](std::size_t, std::size_t first, std::size_t count, const Destination& to) {
      for (std::size_t i = 0, adjacent = 1; i < count; i += adjacent) {
        const index_t* const point = few_points.data() + first + i;
        adjacent = 1;
        while (i + adjacent < count && point[adjacent] == point[adjacent - 1] + 1) ++adjacent;
        points.read(static_cast<std::size_t>(*point), adjacent, {to.x + i, to.y + i, to.z + i, nullptr});
      }
    });
  } else if (indices) {
    std::vector<char>& is_selected = state_->is_selected;
    is_selected.assign(layout.points, 0);
    for (const auto& index : *indices) is_selected[static_cast<std::size_t>(index)] = 1;
    cluster([&](std::size_t laser, std::size_t first, std::size_t count, const Destination& to) {
      const std::size_t point = laser * columns + first;
      read(point, count, to);
      const char* const selected = is_selected.data() + point;
      constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
      for (std::size_t i = 0; i < count; ++i) to.x[i] = selected[i] ? to.x[i] : kNan;  // no return
    });
  } else {
    cluster([&](std::size_t laser, std::size_t first, std::size_t count, const Destination& to) {
      read(laser * columns + first, count, to);
    });
  }
  return (true);
}

void LiscoCloudClusterer::collect(const Indices* indices, const PCLHeader& header, uindex_t min_size, uindex_t max_size,
                                  std::vector<PointIndices>& clusters) {
  const auto collect_points = [&](const auto& point_at) {
    collectPoints(indices, header, min_size, max_size, point_at, clusters);
  };
  if (state_->has_few_points)
    collect_points([points = state_->few_points.data()](std::size_t, std::size_t column) { return points[column]; });
  else
    collect_points([index = LiscoRowMajorIndex{state_->columns}](std::size_t laser, std::size_t column) {
      return index(laser, column);  // in a lambda: instances of named types would be exported
    });
}

/** \brief collect () of a cloud whose point at each laser and column is given. */
template <typename PointAt>
void LiscoCloudClusterer::collectPoints(const Indices* indices, const PCLHeader& header, uindex_t min_size,
                                        uindex_t max_size, const PointAt& point_at,
                                        std::vector<PointIndices>& clusters) {
  lisco::ColumnClusterer& clusterer = state_->clusterer;
  std::vector<std::uint32_t>& subcluster_of_point = state_->subcluster_of_point;
  LiscoClusterWriter writer(clusterer, header, min_size, max_size, state_->places, clusters);

  // Clusters are in the order of their first points in the indices; within each, indices ascend.
  const bool is_sorted = !indices || std::is_sorted(indices->begin(), indices->end());
  if (!is_sorted) {
    std::uint32_t points = 0;
    for (const auto& index : *indices) points = std::max(points, static_cast<std::uint32_t>(index) + 1);
    constexpr std::uint32_t kNone = lisco::ColumnClusterer::kNone;
    subcluster_of_point.assign(points, kNone);
    clusterer.forEachRun([&](std::uint32_t laser, std::uint32_t column, std::size_t count, std::uint32_t subcluster) {
      for (std::size_t i = 0; i < count; ++i)
        subcluster_of_point[static_cast<std::size_t>(point_at(laser, column + i))] = subcluster;
    });
    for (const auto& index : *indices) {
      const std::uint32_t subcluster = subcluster_of_point[static_cast<std::size_t>(index)];
      if (subcluster != kNone) writer.place(subcluster);
    }
  }
  const LiscoRunAppender append{writer, point_at};
  if (clusterer.threadCount() > 1) {
    writer.placeAll();
    clusterer.forEachRunFromBothEnds(append, writer.acceptedSizes());
    if (is_sorted) writer.orderByFirstPoints();
  } else {
    clusterer.forEachRun(append, writer.acceptedSizes());
  }
}

bool LiscoCloudClusterer::fitsIndexType(std::size_t points) {
  // The engine numbers points and runs with 31 bits.
  return (points <= static_cast<std::size_t>(std::numeric_limits<index_t>::max()) && points < std::size_t{1} << 31);
}

}  // namespace pcl::detail
