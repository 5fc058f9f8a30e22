// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
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

struct Cells {
  int columns, rows;
  std::vector<std::uint32_t> colors;  ///< row by row

  std::uint32_t at(int row, int column) const {
    return colors[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

/// An organized scan, each row shifted by its stagger.
Cells shiftedRows(const Cloud& cloud, const std::vector<std::uint32_t>& colors) {
  Cells cells{static_cast<int>(cloud.width), static_cast<int>(cloud.height), colors};
  const std::vector<int> shifts = seenByCamera(cloud) ? std::vector<int>(cloud.height, 0) : staggerOf(cloud);
  for (std::size_t row = 0; row < cloud.height; ++row)
    for (int column = 0; column < cells.columns; ++column) {
      const int shifted = ((column + shifts[row]) % cells.columns + cells.columns) % cells.columns;
      cells.colors[row * cloud.width + static_cast<std::size_t>(shifted)] =
          colors[row * cloud.width + static_cast<std::size_t>(column)];
    }
  return cells;
}

/// A projection by azimuth and elevation; the nearest return of a cell is shown.
Cells projected(const Cloud& cloud, const std::vector<std::uint32_t>& colors) {
  double lowest = kPi / 2;
  double highest = -kPi / 2;
  for (const auto& point : cloud)
    if (isReturn(point)) {
      lowest = std::min(lowest, elevationOf(point));
      highest = std::max(highest, elevationOf(point));
    }
  Cells cells{kProjectedColumns, kProjectedRows,
              std::vector<std::uint32_t>(std::size_t{kProjectedColumns} * kProjectedRows, kBackground.argb())};
  std::vector<double> nearest(cells.colors.size(), std::numeric_limits<double>::infinity());
  const auto binOf = [](double position, int bins) {
    return static_cast<std::size_t>(std::clamp(position * bins, 0.0, bins - 1.0));
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& point = cloud[i];
    if (!isReturn(point)) continue;
    const double down = (highest - elevationOf(point)) / std::max(highest - lowest, 1e-9);
    const std::size_t cell =
        binOf(down, kProjectedRows) * kProjectedColumns + binOf(0.5 - azimuthOf(point) / (2 * kPi), kProjectedColumns);
    const double range = rangeOf(point);
    if (range >= nearest[cell]) continue;
    nearest[cell] = range;
    cells.colors[cell] = colors[i];
  }
  return cells;
}

/// Every n-th row and column, so that there are at most kMaxCells.
Cells thinnedOut(Cells cells) {
  const int n = (cells.columns + kMaxCells - 1) / kMaxCells;
  const int m = (cells.rows + kMaxCells - 1) / kMaxCells;
  if (n == 1 && m == 1) return cells;
  Cells thin{(cells.columns + n - 1) / n, (cells.rows + m - 1) / m, {}};
  for (int row = 0; row < cells.rows; row += m)
    for (int column = 0; column < cells.columns; column += n) thin.colors.push_back(cells.at(row, column));
  return thin;
}

}  // namespace

void drawRangeImage(const ClusteredScan& scan, const fs::path& png) {
  const bool organized = scan.cloud->height > 1;
  const std::vector<std::uint32_t> colors = pointColors(scan, true);
  const Cells cells = thinnedOut(organized ? shiftedRows(*scan.cloud, colors) : projected(*scan.cloud, colors));
  const int scale_x = std::clamp(kWantedWidth / cells.columns, 1, kMaxCellSize);
  const int scale_y =
      std::clamp(std::max(kWantedHeight / cells.rows, std::min(scale_x, kMaxHeight / cells.rows)), 1, kMaxCellSize);
  const int width = cells.columns * scale_x;
  const int height = cells.rows * scale_y;
  Canvas canvas(width + 2 * kMargin, height + kHeaderHeight + kMargin);

  canvas.beginPixels();
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column)
      canvas.fillPixels(kMargin + column * scale_x, kHeaderHeight + row * scale_y, scale_x, scale_y,
                        cells.at(row, column));
  canvas.endPixels();

  canvas.setColor(kLine);
  canvas.strokeRectangle(kMargin - 0.5, kHeaderHeight - 0.5, width + 1, height + 1, 1);
  const double right = canvas.width() - kMargin;
  drawHeader(canvas, scan, kMargin, right);

  // The axis below the cells: columns or azimuths, and the rows at its right end.
  const double bottom = kHeaderHeight + height;
  const double note_width = organized ? 180 : 360;
  const int step =
      organized ? std::max(1, static_cast<int>(roundLength(std::max(1.0, cells.columns / 4.0)))) : cells.columns / 8;
  for (int column = 0; column < cells.columns; column += step) {
    const double x = kMargin + column * scale_x;
    if (x > right - note_width) break;
    canvas.setColor(kLine);
    canvas.line(x, bottom, x, bottom + 6, 1);
    canvas.setColor(kText);
    canvas.text(x, bottom + 22, kLabelSize,
                organized ? "column " + std::to_string(column)
                          : "azimuth " + std::to_string(180 - 360 * column / cells.columns) + "\u00b0");
  }
  canvas.text(right, bottom + 22, kLabelSize,
              organized ? std::to_string(scan.cloud->height) + " rows" : "unorganized: by azimuth and elevation",
              Canvas::Align::kRight);
  canvas.save(png);
}

}  // namespace lisco_apps
