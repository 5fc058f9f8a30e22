// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "drawing/scan_pictures.h"
#include "io/point_geometry.h"
#include "io/stagger.h"

namespace lisco_apps {
namespace {

constexpr int kMaxCells = 8000;          ///< columns, and rows, of a picture; of more, every n-th is shown
constexpr int kProjectedColumns = 1800;  ///< of an unorganized scan
constexpr int kProjectedRows = 96;
// Lengths in pixels.
constexpr int kMargin = 40;
constexpr int kWantedWidth = 1800;
constexpr int kWantedHeight = 420;
constexpr int kMaxHeight = 2000;
constexpr int kMaxCellSize = 12;

constexpr std::size_t kMinBoxCells = 40;  ///< shown of a cluster with a box and an id
constexpr double kMaxSeam = 0.2;          ///< between the ends of a turn, radians

PointMap emptyMap(int columns, int rows) {
  return {columns, rows, 1, 1,
          std::vector<std::int64_t>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                                    PointMap::kNoPoint)};
}

/// An organized scan, each row shifted by its stagger.
PointMap shiftedRows(const Cloud& cloud) {
  PointMap map = emptyMap(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  const std::vector<int> shifts = seenByCamera(cloud) ? std::vector<int>(cloud.height, 0) : rowShiftsOf(cloud);
  for (std::size_t row = 0; row < cloud.height; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const int shifted = ((column + shifts[row]) % map.columns + map.columns) % map.columns;
      map.points[row * cloud.width + static_cast<std::size_t>(shifted)] =
          static_cast<std::int64_t>(row * cloud.width + static_cast<std::size_t>(column));
    }
  return map;
}

/// A projection by azimuth and elevation; the nearest return of a cell is shown.
PointMap projected(const Cloud& cloud) {
  const SensorPoint sensor = sensorOf(cloud);
  double lowest = kPi / 2;
  double highest = -kPi / 2;
  for (const auto& point : cloud)
    if (isReturn(point)) {
      const double elevation = elevationOf(seenFrom(sensor, point));
      lowest = std::min(lowest, elevation);
      highest = std::max(highest, elevation);
    }
  PointMap map = emptyMap(kProjectedColumns, kProjectedRows);
  std::vector<double> nearest(map.points.size(), std::numeric_limits<double>::infinity());
  const auto binOf = [](double position, int bins) {
    return static_cast<std::size_t>(std::clamp(position * bins, 0.0, bins - 1.0));
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!isReturn(cloud[i])) continue;
    const pcl::PointXYZ point = seenFrom(sensor, cloud[i]);
    const double down = (highest - elevationOf(point)) / std::max(highest - lowest, 1e-9);
    const std::size_t cell =
        binOf(down, kProjectedRows) * kProjectedColumns + binOf(0.5 - azimuthOf(point) / (2 * kPi), kProjectedColumns);
    const double range = rangeOf(point);
    if (range >= nearest[cell]) continue;
    nearest[cell] = range;
    map.points[cell] = static_cast<std::int64_t>(i);
  }
  return map;
}

/// Every n-th row and column, so that there are at most kMaxCells.
PointMap thinnedOut(PointMap map) {
  const int n = (map.columns + kMaxCells - 1) / kMaxCells;
  const int m = (map.rows + kMaxCells - 1) / kMaxCells;
  if (n == 1 && m == 1) return map;
  PointMap thin{(map.columns + n - 1) / n, (map.rows + m - 1) / m, 1, 1, {}};
  for (int row = 0; row < map.rows; row += m)
    for (int column = 0; column < map.columns; column += n) thin.points.push_back(map.points[map.cellAt(row, column)]);
  return thin;
}

/// Whether the first and the last column with returns lie side by side, as in a turn of a rotating sensor.
bool meetsAtItsEnds(const Cloud& cloud, const PointMap& map) {
  if (seenByCamera(cloud)) return false;
  const SensorPoint sensor = sensorOf(cloud);
  const auto directionOf = [&](int column, std::array<double, 2>& sum) {
    for (int row = 0; row < map.rows; ++row) {
      const std::int64_t index = map.points[map.cellAt(row, column)];
      if (index == PointMap::kNoPoint || !isReturn(cloud[static_cast<std::size_t>(index)])) continue;
      const double azimuth = azimuthOf(seenFrom(sensor, cloud[static_cast<std::size_t>(index)]));
      sum[0] += std::cos(azimuth);
      sum[1] += std::sin(azimuth);
    }
    return sum[0] != 0 || sum[1] != 0;
  };
  std::array<double, 2> first{}, last{};
  int begin = 0, end = map.columns - 1;
  while (begin < map.columns && !directionOf(begin, first)) ++begin;
  while (end > begin && !directionOf(end, last)) --end;
  if (end <= begin) return false;
  const double turned = std::atan2(first[0] * last[1] - first[1] * last[0], first[0] * last[0] + first[1] * last[1]);
  return std::fabs(turned) < kMaxSeam + 2 * kPi * (begin + map.columns - 1 - end) / map.columns;
}

/// A cluster in the range image. Across the seam its columns go on beyond the last one.
struct ShownCluster {
  std::vector<std::array<int, 2>> cells;  ///< column and row
  int left = 0, right = -1;               ///< first and last column
  int top = 0, bottom = -1;               ///< first and last row
};

/// Moves the cells left of the widest gap to the other end of the picture, so that the cluster is in one piece there.
void joinAtSeam(ShownCluster& cluster, int columns) {
  std::vector<int> at;
  for (const auto& cell : cluster.cells) at.push_back(cell[0]);
  std::sort(at.begin(), at.end());
  int widest = at.front() + columns - at.back();
  int moved_before = 0;
  for (std::size_t i = 1; i < at.size(); ++i)
    if (at[i] - at[i - 1] > widest) {
      widest = at[i] - at[i - 1];
      moved_before = at[i];
    }
  for (auto& cell : cluster.cells)
    if (cell[0] < moved_before) cell[0] += columns;
}

/// The larger clusters as far as they are shown; the others are left without cells.
std::vector<ShownCluster> shownClusters(const ClusteredScan& scan, const PointMap& map) {
  const std::vector<std::uint32_t> labels = labelsOf(scan.clusters, scan.cloud->size());
  std::vector<ShownCluster> shown(scan.clusters.size());
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const std::int64_t point = map.points[map.cellAt(row, column)];
      if (point == PointMap::kNoPoint || labels[static_cast<std::size_t>(point)] == 0) continue;
      shown[labels[static_cast<std::size_t>(point)] - 1].cells.push_back({column, row});
    }
  const bool has_seam = meetsAtItsEnds(*scan.cloud, map);
  for (ShownCluster& cluster : shown) {
    if (cluster.cells.size() < kMinBoxCells) {
      cluster.cells.clear();
      continue;
    }
    if (has_seam) joinAtSeam(cluster, map.columns);
    cluster.left = cluster.right = cluster.cells.front()[0];
    cluster.top = cluster.bottom = cluster.cells.front()[1];
    for (const auto& [column, row] : cluster.cells) {
      cluster.left = std::min(cluster.left, column);
      cluster.right = std::max(cluster.right, column);
      cluster.top = std::min(cluster.top, row);
      cluster.bottom = std::max(cluster.bottom, row);
    }
  }
  return shown;
}

/// Outlines the columns `left` to `right` - 1 of a cluster, one pixel outside of its cells. An open side is at a seam.
void drawBoxPart(Canvas& canvas, const PointMap& map, const ShownCluster& cluster, int left, int right, bool open_left,
                 bool open_right) {
  const double outside = 0.5;
  const double x0 = kMargin + left * map.cell_width - (open_left ? 0 : outside);
  const double x1 = kMargin + right * map.cell_width + (open_right ? 0 : outside);
  const double y0 = kHeaderHeight + cluster.top * map.cell_height - outside;
  const double y1 = kHeaderHeight + (cluster.bottom + 1) * map.cell_height + outside;
  canvas.line(x0, y0, x1, y0, 1);
  canvas.line(x0, y1, x1, y1, 1);
  if (!open_left) canvas.line(x0, y0, x0, y1, 1);
  if (!open_right) canvas.line(x1, y0, x1, y1, 1);
}

/// Outlines the larger clusters, and writes their ids at the cells nearest to their middles.
void drawBoxes(Canvas& canvas, const ClusteredScan& scan, const PointMap& map, const ScanColors& colors) {
  const std::vector<ShownCluster> shown = shownClusters(scan, map);
  for (std::size_t i = shown.size(); i-- > 0;) {
    const ShownCluster& cluster = shown[i];
    if (cluster.cells.empty()) continue;
    canvas.setColor(colors.of_cluster[i].brightened(), 0.9);
    const int end = cluster.right + 1;
    const bool crosses = end > map.columns;
    drawBoxPart(canvas, map, cluster, cluster.left, crosses ? map.columns : end, false, crosses);
    if (crosses) drawBoxPart(canvas, map, cluster, 0, end - map.columns, true, false);
  }
  IdLabels ids;
  for (std::size_t i = 0; i < shown.size() && !ids.isFull(); ++i) {
    const auto& cells = shown[i].cells;
    if (cells.empty()) continue;
    std::array<double, 2> middle{};
    for (const auto& cell : cells)
      for (std::size_t axis = 0; axis < 2; ++axis) middle[axis] += cell[axis] / static_cast<double>(cells.size());
    const auto nearest = *std::min_element(cells.begin(), cells.end(), [&](const auto& a, const auto& b) {
      return std::hypot(a[0] - middle[0], a[1] - middle[1]) < std::hypot(b[0] - middle[0], b[1] - middle[1]);
    });
    ids.add(canvas, i, kMargin + (nearest[0] % map.columns + 0.5) * map.cell_width,
            kHeaderHeight + (nearest[1] + 0.5) * map.cell_height, colors.of_cluster[i].brightened());
  }
}

}  // namespace

PointMap rangeImageOf(const ClusteredScan& scan) {
  PointMap map = thinnedOut(scan.cloud->height > 1 ? shiftedRows(*scan.cloud) : projected(*scan.cloud));
  const int scale_x = std::clamp(kWantedWidth / map.columns, 1, kMaxCellSize);
  map.cell_width = scale_x;
  map.cell_height =
      std::clamp(std::max(kWantedHeight / map.rows, std::min(scale_x, kMaxHeight / map.rows)), 1, kMaxCellSize);
  return map;
}

void drawRangeImage(const ClusteredScan& scan, const PointMap& map, const ScanColors& colors, const fs::path& png) {
  const bool organized = scan.cloud->height > 1;
  const auto scale_x = static_cast<int>(map.cell_width);
  const int width = map.columns * scale_x;
  const int height = map.rows * static_cast<int>(map.cell_height);
  Canvas canvas(width + 2 * kMargin, height + kHeaderHeight + kMargin);

  paintCells(canvas, map, kMargin, colors.shaded);
  drawBoxes(canvas, scan, map, colors);

  canvas.setColor(kLine);
  canvas.strokeRectangle(kMargin - 0.5, kHeaderHeight - 0.5, width + 1, height + 1, 1);
  const double right = canvas.width() - kMargin;
  drawHeader(canvas, scan, kMargin, right);

  // The axis below the cells: columns or azimuths, and the rows at its right end.
  const double bottom = kHeaderHeight + height;
  const double note_width = organized ? 180 : 360;
  const int step =
      organized ? std::max(1, static_cast<int>(roundLength(std::max(1.0, map.columns / 4.0)))) : map.columns / 8;
  for (int column = 0; column < map.columns; column += step) {
    const double x = kMargin + column * scale_x;
    if (x > right - note_width) break;
    canvas.setColor(kLine);
    canvas.line(x, bottom, x, bottom + 6, 1);
    canvas.setColor(kText);
    canvas.text(x, bottom + 22, kLabelSize,
                organized ? "column " + std::to_string(column)
                          : "azimuth " + std::to_string(180 - 360 * column / map.columns) + "\u00b0");
  }
  canvas.text(right, bottom + 22, kLabelSize,
              organized ? std::to_string(scan.cloud->height) + " rows" : "unorganized: by azimuth and elevation",
              Canvas::Align::kRight);
  canvas.save(png);
}

}  // namespace lisco_apps
