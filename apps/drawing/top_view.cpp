// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <utility>

#include "drawing/scan_pictures.h"
#include "io/point_geometry.h"
#include "io/text.h"

namespace lisco_apps {
namespace {

constexpr int kSize = 1400;              ///< width and height below the header, pixels
constexpr double kMargin = 1.08;         ///< extent of the picture by that of its points
constexpr double kMinExtent = 1e-3;      ///< metres
constexpr std::size_t kOutermost = 100;  ///< one of so many points, on each side, may lie outside the picture
constexpr int kRings = 20;

/// The part of the plane that is shown: right and up in metres to pixels.
class Window {
 public:
  /// Holds the sensor and all but the outermost of the points.
  Window(std::vector<double> rights, std::vector<double> ups) {
    const auto [left, right] = spanOf(rights);
    const auto [low, high] = spanOf(ups);
    extent_ = std::max({right - left, high - low, kMinExtent}) * kMargin;
    center_right_ = (left + right) / 2;
    center_up_ = (low + high) / 2;
  }

  double extent() const { return extent_; }  ///< metres
  double pixelsPerMetre() const { return kSize / extent_; }
  double x(double right) const { return kSize / 2.0 + (right - center_right_) * pixelsPerMetre(); }
  double y(double up) const { return kHeaderHeight + kSize / 2.0 - (up - center_up_) * pixelsPerMetre(); }

 private:
  static std::pair<double, double> spanOf(std::vector<double>& values) {
    values.push_back(0);
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / kOutermost;
    return {std::min(0.0, values[cut]), std::max(0.0, values[values.size() - 1 - cut])};
  }

  double extent_, center_right_, center_up_;
};

void drawScaleBar(Canvas& canvas, double length, double pixels) {
  constexpr double kLeft = 32;
  constexpr double kY = kSize + kHeaderHeight - 28;
  canvas.setColor(kBackground, 0.8);
  canvas.fillRectangle(kLeft - 12, kY - 26, pixels + 24, 44);
  canvas.setColor(kText);
  canvas.line(kLeft, kY, kLeft + pixels, kY, 2);
  for (const double end : {kLeft, kLeft + pixels}) canvas.line(end, kY - 5, end, kY + 5, 2);
  canvas.text(kLeft + pixels / 2, kY - 8, 14, formatted("%g m", length), Canvas::Align::kCenter);
}

}  // namespace

void drawTopView(const ClusteredScan& scan, const fs::path& png) {
  Canvas canvas(kSize, kSize + kHeaderHeight);
  const Cloud& cloud = *scan.cloud;
  const bool camera = seenByCamera(cloud);
  const auto right = [camera](const pcl::PointXYZ& p) { return static_cast<double>(camera ? p.x : -p.y); };
  const auto up = [camera](const pcl::PointXYZ& p) { return static_cast<double>(camera ? p.z : p.x); };
  std::vector<double> rights, ups;
  for (const auto index : scan.clustered) {
    rights.push_back(right(cloud[static_cast<std::size_t>(index)]));
    ups.push_back(up(cloud[static_cast<std::size_t>(index)]));
  }
  const Window window(std::move(rights), std::move(ups));

  const double ring = roundLength(window.extent() / 4);  // metres between rings of equal range
  const double ring_pixels = ring * window.pixelsPerMetre();
  const double sensor_x = window.x(0);
  const double sensor_y = window.y(0);
  canvas.setColor(kLine);
  for (int i = 1; i <= kRings; ++i) canvas.circle(sensor_x, sensor_y, i * ring_pixels, 1);

  const std::vector<std::uint32_t> colors = pointColors(scan, false);
  canvas.beginPixels();
  const auto draw = [&](std::size_t i, int size) {
    if (!isReturn(cloud[i])) return;
    const double x = window.x(right(cloud[i]));
    const double y = window.y(up(cloud[i]));
    if (x < 0 || y < kHeaderHeight || x >= kSize || y >= kSize + kHeaderHeight) return;
    canvas.fillPixels(static_cast<int>(x) - size / 2, static_cast<int>(y) - size / 2, size, size, colors[i]);
  };
  // From bottom to top: ground, noise, clusters.
  for (std::size_t i = 0; i < cloud.size(); ++i) draw(i, 1);
  for (const auto index : scan.clustered) draw(static_cast<std::size_t>(index), 2);
  for (const auto& cluster : scan.clusters)
    for (const auto index : cluster.indices) draw(static_cast<std::size_t>(index), 3);
  canvas.endPixels();

  canvas.setColor(kText, 0.75);
  for (int i = 1; i <= kRings; ++i) {
    const double y = sensor_y - i * ring_pixels;
    if (y < kHeaderHeight + 14) break;
    canvas.text(sensor_x + 4, y - 4, kLabelSize, formatted("%g m", i * ring));
  }
  // The sensor: a circle with a line that points forward.
  canvas.setColor(kText);
  canvas.circle(sensor_x, sensor_y, 6, 2);
  canvas.line(sensor_x, sensor_y - 6, sensor_x, sensor_y - 18, 2);
  canvas.text(sensor_x + 10, sensor_y + 18, kLabelSize, "sensor");
  drawScaleBar(canvas, ring, ring_pixels);

  canvas.setColor(kBackground);
  canvas.fillRectangle(0, 0, kSize, kHeaderHeight);
  drawHeader(canvas, scan, 24, kSize - 30);
  canvas.save(png);
}

}  // namespace lisco_apps
