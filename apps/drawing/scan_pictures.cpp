// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/scan_pictures.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "io/point_geometry.h"
#include "io/text.h"

namespace lisco_apps {
namespace {

constexpr double kFullBrightness = 4.0;  ///< range up to which points have it, metres
constexpr double kDimming = 0.1;         ///< part of the brightness lost per doubling of the range
constexpr double kMinBrightness = 0.5;
constexpr double kMinRange = 1e-3;     ///< metres
constexpr double kCameraShare = 0.99;  ///< of the returns lie ahead of a camera
constexpr double kKeyWidth = 270;      ///< pixels, all its entries
constexpr double kSwatch = 12;         ///< pixels, side of a square of colour

ScanColors colorsOf(const ClusteredScan& scan, const std::vector<std::uint32_t>& labels,
                    const std::vector<Color>& of_cluster) {
  const Cloud& cloud = *scan.cloud;
  const SensorPoint sensor = sensorOf(cloud);
  ScanColors colors;
  colors.of_cluster = of_cluster;
  colors.of_point.assign(cloud.size(), kBackground.argb());
  colors.shaded = colors.of_point;
  const auto color = [&](std::size_t i, const Color& plain) {
    const double range = std::max(rangeOf(seenFrom(sensor, cloud[i])), kMinRange);
    const double brightness = 1.0 - kDimming * std::log2(range / kFullBrightness);
    colors.of_point[i] = plain.argb();
    colors.shaded[i] = plain.shaded(std::clamp(brightness, kMinBrightness, 1.0)).argb();
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!isReturn(cloud[i])) continue;
    if (labels[i] == 0)
      color(i, kGround);
    else
      colors.of_point[i] = colors.shaded[i] = colors.of_cluster[labels[i] - 1].argb();
  }
  for (const auto index : scan.returns.clustered)
    if (const auto i = static_cast<std::size_t>(index); labels[i] == 0) color(i, kNoise);
  return colors;
}

}  // namespace

void drawPictures(const ClusteredScan& scan, const fs::path& range_image_png, const fs::path& top_view_png) {
  const ClusteredScan& seen = scan.arranged ? *scan.arranged : scan;
  const PointMap range_image = rangeImageOf(seen);
  const PointMap top_view = topViewOf(scan);
  const std::vector<std::uint32_t> labels = labelsOf(scan.clusters, scan.cloud->size());
  const std::vector<std::uint32_t> labels_seen = labelsOf(seen.clusters, seen.cloud->size());
  std::vector<Color> of_cluster;
  for (const std::size_t color : colorNeighbours(scan.clusters.size(), {{range_image, labels_seen}, {top_view, labels}},
                                                 kPrimaryColors, std::size(kPalette)))
    of_cluster.push_back(kPalette[color]);
  drawRangeImage(seen, range_image, colorsOf(seen, labels_seen, of_cluster), range_image_png);
  drawTopView(scan, top_view, colorsOf(scan, labels, of_cluster), top_view_png);
}

void IdLabels::add(Canvas& canvas, std::size_t cluster, double x, double y, const Color& color) {
  constexpr double kSize = 12;
  constexpr double kGap = 3;
  if (isFull()) return;
  const std::string id = std::to_string(cluster + 1);
  const double width = canvas.widthOf(id, kSize);
  for (const Place& other : placed_)
    if (std::fabs(other.x - x) < (other.width + width) / 2 + 2 * kGap && std::fabs(other.y - y) < kSize + kGap) return;
  placed_.push_back({x, y, width});
  canvas.label(x, y, kSize, id, color);
}

void paintCells(Canvas& canvas, const PointMap& map, int left, const std::vector<std::uint32_t>& color_of_point) {
  const auto width = static_cast<int>(map.cell_width), height = static_cast<int>(map.cell_height);
  canvas.beginPixels();
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      if (const std::int64_t point = map.points[map.cellAt(row, column)]; point != PointMap::kNoPoint)
        canvas.fillPixels(left + column * width, kHeaderHeight + row * height, width, height,
                          color_of_point[static_cast<std::size_t>(point)]);
  canvas.endPixels();
}

void drawHeader(Canvas& canvas, const ClusteredScan& scan, double left, double right) {
  canvas.setColor(kText);
  canvas.text(left, kHeaderBaseline, kTitleSize,
              scan.name + ":  " + formatted("%zu clusters, tolerance %g m", scan.clusters.size(), scan.tolerance));
  double x = right - kKeyWidth;
  const auto swatch = [&](const Color& color, double advance) {
    canvas.setColor(color);
    canvas.fillRectangle(x, kHeaderBaseline - 10, kSwatch, kSwatch);
    x += advance;
  };
  const auto entry = [&](const Color& color, const char* what) {
    swatch(color, kSwatch + 6);
    canvas.setColor(kText);
    x += canvas.text(x, kHeaderBaseline, kLabelSize, what) + 22;
  };
  swatch(kPalette[0], kSwatch + 2);
  swatch(kPalette[1], kSwatch + 2);
  entry(kPalette[2], "clusters");
  entry(kNoise, "noise");
  entry(kGround, "ground");
}

SensorPoint sensorOf(const Cloud& cloud) {
  const std::array<float, 3> origin = declaredOriginOf(cloud);
  return {static_cast<double>(origin[0]), static_cast<double>(origin[1]), static_cast<double>(origin[2])};
}

pcl::PointXYZ seenFrom(const SensorPoint& sensor, const pcl::PointXYZ& point) {
  return {static_cast<float>(static_cast<double>(point.x) - sensor[0]),
          static_cast<float>(static_cast<double>(point.y) - sensor[1]),
          static_cast<float>(static_cast<double>(point.z) - sensor[2])};
}

bool seenByCamera(const Cloud& cloud) {
  const SensorPoint sensor = sensorOf(cloud);
  std::size_t returns = 0;
  std::size_t ahead = 0;
  for (const auto& point : cloud) {
    if (!isReturn(point)) continue;
    ++returns;
    const pcl::PointXYZ seen = seenFrom(sensor, point);
    ahead += seen.z > 0.5F * std::hypot(seen.x, seen.y) ? 1 : 0;
  }
  return returns > 0 && static_cast<double>(ahead) > kCameraShare * static_cast<double>(returns);
}

double roundLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double mantissa = length / power;
  return power * (mantissa >= 5 ? 5 : (mantissa >= 2 ? 2 : 1));
}

}  // namespace lisco_apps
