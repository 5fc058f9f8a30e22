// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "engine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bodies.h"
#include "endless_streams.h"
#include "input.h"
#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/simd.h"
#include "lisco/window_clusterer.h"
#include "oracle.h"
#include "shapes.h"

namespace lisco_test {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Uses one of the levels of vector instructions; changing it takes as long as a scan.
void useLevel(Input& input) {
  static std::size_t in_use = levels().size();
  const std::size_t level = input.below(levels().size());
  if (level == in_use) return;
  hold(lisco::useSimdLevel(levels()[level]), "a level is gone");
  in_use = level;
}

/// The subcluster of each point.
template <typename Clusterer>
const std::vector<std::uint32_t>& subclustersOf(Clusterer& clusterer, std::size_t points) {
  static std::vector<std::uint32_t> subcluster_of;
  subcluster_of.assign(points, kNone);
  std::size_t returns = 0;
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
    hold(count > 0, "a run of no returns");
    hold(subcluster < clusterer.subclusterCount(), "an unknown subcluster");
    for (std::size_t i = 0; i < count; ++i) {
      hold(source_indices[i] < points, "an unknown source index");
      hold(subcluster_of[source_indices[i]] == kNone, "a return comes twice");
      subcluster_of[source_indices[i]] = subcluster;
    }
    returns += count;
  });
  hold(returns == clusterer.returnCount(), "the number of returns");
  return subcluster_of;
}

template <typename Clusterer>
void holdExact(Clusterer& clusterer, const std::vector<Point>& points, float tolerance) {
  const std::vector<std::uint32_t>& subcluster_of = subclustersOf(clusterer, points.size());
  hold(areTrueClusters(points, tolerance, subcluster_of, clusterer.subclusterCount(),
                       [&](std::uint32_t subcluster) { return clusterer.sizeOf(subcluster); }),
       "the clusters are not the oracle's");
}

void holdExactUpTo(lisco::ColumnClusterer& clusterer, Shape& shape, std::size_t end, float tolerance) {
  clusterer.update();
  const std::vector<Point>& points = shape.pointsIn(0, end);
  holdExact(clusterer, points, tolerance);
  const std::vector<std::uint32_t>& subcluster_of = subclustersOf(clusterer, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t column = shape.columnOf(i);
    if (column >= end) continue;
    hold(clusterer.subclusterAt(shape.laserOf(i), column) == subcluster_of[i], "the subcluster at a place");
    const std::uint32_t beside = clusterer.subclusterAt(shape.laserOf(i), column + 1);
    hold((beside == kNone) == (column + 1 >= end || !isValid([&] {
                                 const lisco::Return cell = shape.at(shape.laserOf(i), column + 1);
                                 return Point{cell.x, cell.y, cell.z};
                               }())),
         "the subcluster beside a place");
  }
}

/// Adds columns, with at most one look in between.
void feed(lisco::ColumnClusterer& clusterer, Shape& shape, std::size_t columns, unsigned portions, float tolerance) {
  constexpr std::array<std::size_t, 8> kPortions{10000, 10000, 64, 65, 17, 7, 1, 260};
  const std::size_t portion = kPortions[portions % 8];
  const std::size_t look_at = portions / 8 * 4;  // and there
  bool looked = (portions / 8) % 2 == 0;
  for (std::size_t first = 0; first < columns;) {
    const std::size_t count = std::min(portion, columns - first);
    clusterer.addColumns(count, shape.lasers(),
                         [&](std::size_t laser, std::size_t column) { return shape.at(laser, first + column); });
    first += count;
    if (looked || first < look_at || first >= columns) continue;
    looked = true;
    holdExactUpTo(clusterer, shape, first, tolerance);
  }
  holdExactUpTo(clusterer, shape, columns, tolerance);
}

/// Clusters a rotation; in one of eight cases several times, as later ones depend on those before (FarHistory).
void rotate(lisco::ColumnClusterer& clusterer, const lisco::Parameters& parameters, Shape& shape, std::size_t columns,
            unsigned portions) {
  const int rotations = portions % 8 == 1 ? 5 : 1;
  for (int rotation = 0; rotation < rotations; ++rotation) {
    clusterer.begin(parameters);
    feed(clusterer, shape, columns, portions, parameters.tolerance);
  }
}

/// So many columns at once are sorted.
constexpr std::size_t kSortedColumns = 256;

/// \param is_wide whether empty columns follow, so that there are enough
void clusterScan(Input& input, float unit, bool is_wide) {
  constexpr std::array<int, 8> kSteps{512, 512, 512, 0, 0, 600, 600, 2048};
  constexpr std::array<float, 5> kElevationSteps{0.5F, 0.3F, 0.1F, 0.02F, 0.002F};
  constexpr std::array<std::size_t, 8> kBlocks{64, 64, 64, 16, 16, 3, 1, 40};
  static std::array<lisco::ColumnClusterer, 4> clusterers;  // each input starts afresh
  static Shape shape;

  lisco::Parameters parameters;
  parameters.expected_returns = 100;
  const unsigned steps = input.byte();
  parameters.sensor.steps_per_turn = kSteps[steps % 8];
  parameters.sensor.elevation_step = input.oneOf(kElevationSteps);
  const unsigned flags = input.byte();
  parameters.sensor.clockwise = (flags & 1U) != 0;
  const bool turns_as_told = (flags & 2U) != 0 || (flags & 4U) != 0;
  if ((flags & 24U) == 24) parameters.sensor.origin = {3.0F * unit, -20.0F * unit, 1.5F * unit};
  if ((flags & 32U) != 0) parameters.sensor.roughness = 2 * unit;
  parameters.threads = 1 + flags / 64 % 3;
  parameters.block_columns = input.oneOf(kBlocks);
  const std::size_t lasers = 1 + input.below(Shape::kMaxLasers);
  // Few columns where each costs much.
  const std::size_t max_columns = parameters.block_columns < 16           ? 96
                                  : parameters.sensor.steps_per_turn == 0 ? 160
                                                                          : Shape::kMaxColumns;
  parameters.tolerance = toleranceFrom(input, unit);
  useLevel(input);
  const unsigned portions = input.byte();
  lisco::SensorHints shape_hints = parameters.sensor;
  if (!turns_as_told) shape_hints.clockwise = !shape_hints.clockwise;
  shape.read(input, unit, lasers, max_columns, parameters.sensor.steps_per_turn == 600 ? 600 : 512, shape_hints);
  std::size_t columns = shape.columns();
  if (is_wide) columns = std::max(columns, kSortedColumns);
  // So many cells that threads share them.
  if (parameters.threads > 1 && lasers == Shape::kMaxLasers && parameters.block_columns == 64) columns = 1040;

  const std::size_t which = steps / 8 % 4 == 3 ? steps / 32 % 4 : parameters.sensor.steps_per_turn == 0 ? 0 : 1;
  lisco::ColumnClusterer& clusterer =
      parameters.sensor.steps_per_turn == 2048 ? clusterers[3] : clusterers[which < 3 ? which : 2];
  rotate(clusterer, parameters, shape, columns, portions);
}

void clusterRecording(Input& input, float unit) {
  static std::array<lisco::ColumnClusterer, 2> clusterers;
  static Shape shape;
  constexpr std::array<float, 4> kElevationSteps{0.3F, 0.1F, 0.02F, 0.002F};
  lisco::Parameters parameters;
  const unsigned flags = input.byte();
  const std::size_t steps = (flags & 1U) != 0 ? 600 : 512;
  parameters.sensor.clockwise = (flags & 2U) != 0;
  parameters.sensor.steps_per_turn = (flags & 12U) == 0 ? 0 : static_cast<int>(steps);
  parameters.sensor.elevation_step = kElevationSteps[flags / 16 % 4];
  parameters.threads = 1 + flags / 64;
  const std::size_t lasers = 1 + input.below(Shape::kMaxLasers);
  parameters.tolerance = toleranceFrom(input, unit);
  useLevel(input);
  const unsigned portions = input.byte();
  shape.readRecording(input, unit, lasers, steps, parameters.sensor);
  if (portions < 192) shape.widen(kSortedColumns);
  if (parameters.threads > 1 && shape.lasers() == Shape::kMaxLasers) shape.widen(1040);
  lisco::ColumnClusterer& clusterer = clusterers[parameters.threads > 1 ? 1 : 0];
  rotate(clusterer, parameters, shape, shape.columns(), portions);
}

void clusterWindows(Input& input, float unit) {
  static lisco::WindowClusterer clusterer;
  static Shape shape;
  const float tolerance = toleranceFrom(input, unit);
  useLevel(input);
  const std::size_t lasers = 1 + input.below(4);
  const unsigned sizes = input.byte();
  const std::size_t hop = sizes % 16 == 15 ? 70 : 1 + sizes % 16;
  const std::size_t window = hop * (1 + sizes / 16);
  shape.read(input, unit, lasers, 192, 512, {});
  const std::size_t columns = std::min<std::size_t>(shape.columns() + window, 192);
  clusterer.begin({tolerance, window, hop, lasers});
  std::array<lisco::Return, Shape::kMaxLasers> cells;
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t laser = 0; laser < lasers; ++laser) cells[laser] = shape.at(laser, column);
    const bool ends = clusterer.addColumn(cells.data(), lasers);
    hold(ends == ((column + 1) % hop == 0), "a window's end");
    if (!ends) continue;
    const std::size_t first = column + 1 - std::min(window, column + 1);
    hold(clusterer.columnCount() == column + 1 - first, "the columns of a window");
    holdExact(clusterer, shape.pointsIn(first, column + 1), tolerance);
  }
}

void clusterEndlessly(Input& input) {
  static lisco::EndlessClusterer clusterer;
  useLevel(input);
  const EndlessStream stream = endlessStreamFrom(input);
  if (stream.columns.empty()) return;
  const EndlessTruth truth = endlessTruth(stream);
  const std::vector<Delivery> deliveries = deliveriesOf(clusterer, stream);
  hold(clusterer.outlierCount() == truth.outliers, "the number of outliers");
  hold(deliveries.size() == truth.deliveries.size(), "the number of deliveries");
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    const Delivery& own = deliveries[i];
    const Delivery& right = truth.deliveries[i];
    hold(own.members == right.members, "what is delivered together");
    hold(own.cut == right.cut && own.continued == right.continued, "what is cut or continued");
    hold(own.first_position == right.first_position && own.last_position == right.last_position,
         "where a cluster begins and ends");
    hold(own.cut || own.column == stream.columns.size() || own.reach_end <= stream.columns[own.column].position,
         "a cluster is delivered too soon");
  }
}

}  // namespace

void fuzzEngine(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<float, 8> kUnits{1.0F, 1.0F, 0.25F, 0.3F, 0.1F, 0.7F, 1e-15F, 1e11F};
  Input input(data, size);
  const unsigned what = input.byte();
  const float unit = kUnits[what / 8 % 8];
  switch (what % 8) {
    case 6:
      return clusterWindows(input, unit);
    case 7:
      return clusterEndlessly(input);
    default:
      return what / 64 == 3 ? clusterRecording(input, unit) : clusterScan(input, unit, what / 64 == 2);
  }
}

}  // namespace lisco_test
