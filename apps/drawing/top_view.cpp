// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

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
  /// Holds all but the outermost of the points, and the sensor, unless it is farther away than they are wide.
  /// \param sensor right and up
  Window(std::vector<double> rights, std::vector<double> ups, const std::array<double, 2>& sensor) {
    const Span right = spanOf(rights, sensor[0]);
    const Span up = spanOf(ups, sensor[1]);
    const double width = std::max(right.second - right.first, up.second - up.first);
    shows_sensor_ = isNear(right, sensor[0], width) && isNear(up, sensor[1], width);
    const auto [left_end, right_end] = shows_sensor_ ? widened(right, sensor[0]) : right;
    const auto [low_end, high_end] = shows_sensor_ ? widened(up, sensor[1]) : up;
    extent_ = std::max({right_end - left_end, high_end - low_end, kMinExtent}) * kMargin;
    center_right_ = (left_end + right_end) / 2;
    center_up_ = (low_end + high_end) / 2;
  }

  double extent() const { return extent_; }  ///< metres
  bool showsSensor() const { return shows_sensor_; }
  double pixelsPerMetre() const { return kSize / extent_; }
  double x(double right) const { return kSize / 2.0 + (right - center_right_) * pixelsPerMetre(); }
  double y(double up) const { return kHeaderHeight + kSize / 2.0 - (up - center_up_) * pixelsPerMetre(); }

 private:
  using Span = std::pair<double, double>;

  /// \param sensor is taken where there are no values
  static Span spanOf(std::vector<double>& values, double sensor) {
    if (values.empty()) values.push_back(sensor);
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / kOutermost;
    return {values[cut], values[values.size() - 1 - cut]};
  }
  static bool isNear(const Span& span, double sensor, double width) {
    return sensor >= span.first - width && sensor <= span.second + width;
  }
  static Span widened(const Span& span, double sensor) {
    return {std::min(span.first, sensor), std::max(span.second, sensor)};
  }

  double extent_, center_right_, center_up_;
  bool shows_sensor_;
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

/// Where the points of a scan are in the picture.
class View {
 public:
  explicit View(const ClusteredScan& scan)
      : cloud_(*scan.cloud), is_camera_(seenByCamera(cloud_)), window_(windowAround(scan.returns.clustered)) {}

  const Window& window() const { return window_; }
  /// Right and up, metres.
  std::array<double, 2> sensor() const {
    const SensorPoint at = sensorOf(cloud_);
    return is_camera_ ? std::array<double, 2>{at[0], at[2]} : std::array<double, 2>{-at[1], at[0]};
  }
  /// \return false outside of the picture
  bool find(std::size_t point, int& x, int& y) const {
    if (!isReturn(cloud_[point])) return false;
    const double right = window_.x(rightOf(point));
    const double down = window_.y(upOf(point));
    if (right < 0 || down < kHeaderHeight || right >= kSize || down >= kSize + kHeaderHeight) return false;
    x = static_cast<int>(right);
    y = static_cast<int>(down) - kHeaderHeight;
    return true;
  }

  /// The corners of a cluster's box: the oriented one, or a camera's axis-aligned one.
  std::vector<std::array<double, 2>> corners(const lisco::ClusterFeatures& features) const {
    std::vector<std::array<double, 2>> corners;
    for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
      const lisco::OrientedBox& box = features.box;
      const double along = a * box.length;
      const double across = b * box.width;
      const double x = box.center[0] + along * std::cos(box.yaw) - across * std::sin(box.yaw);
      const double y = box.center[1] + along * std::sin(box.yaw) + across * std::cos(box.yaw);
      if (is_camera_)
        corners.push_back({window_.x(static_cast<double>(a < 0 ? features.min[0] : features.max[0])),
                           window_.y(static_cast<double>(b < 0 ? features.min[2] : features.max[2]))});
      else
        corners.push_back({window_.x(-y), window_.y(x)});
    }
    return corners;
  }

 private:
  double rightOf(std::size_t i) const { return static_cast<double>(is_camera_ ? cloud_[i].x : -cloud_[i].y); }
  double upOf(std::size_t i) const { return static_cast<double>(is_camera_ ? cloud_[i].z : cloud_[i].x); }
  Window windowAround(const pcl::Indices& points) const {
    std::vector<double> rights, ups;
    for (const auto index : points) {
      rights.push_back(rightOf(static_cast<std::size_t>(index)));
      ups.push_back(upOf(static_cast<std::size_t>(index)));
    }
    return {std::move(rights), std::move(ups), sensor()};
  }

  const Cloud& cloud_;
  bool is_camera_;
  Window window_;
};

/// Outlines the boxes, and writes the ids of the larger clusters above them.
void drawBoxes(Canvas& canvas, const ClusteredScan& scan, const View& view, const ScanColors& colors) {
  constexpr double kAbove = 9;   // pixels from a box to its id
  constexpr double kMinBox = 9;  // pixels, of a box with an id
  IdLabels ids;
  for (std::size_t i = scan.clusters.size(); i-- > 0;) {
    canvas.setColor(colors.of_cluster[i].brightened(), 0.9);
    canvas.strokePolygon(view.corners(scan.features[i]), 1);
  }
  for (std::size_t i = 0; i < scan.clusters.size() && !ids.isFull(); ++i) {
    double left = kSize, right = 0, top = kSize + kHeaderHeight, bottom = 0;
    const std::vector<std::array<double, 2>> corners = view.corners(scan.features[i]);
    for (const auto& [x, y] : corners) {
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
    // Above the uppermost corner, or the middle of the upper side.
    double x = 0;
    int uppermost = 0;
    for (const auto& [corner_x, corner_y] : corners)
      if (corner_y < top + 1) {
        x += corner_x;
        ++uppermost;
      }
    x /= uppermost;
    if (std::max(right - left, bottom - top) < kMinBox || x < 0 || x >= kSize || top < kHeaderHeight + 2 * kAbove ||
        top >= kSize + kHeaderHeight)
      continue;
    ids.add(canvas, i, x, top - kAbove, colors.of_cluster[i].brightened());
  }
}

}  // namespace

PointMap topViewOf(const ClusteredScan& scan) {
  const View view(scan);
  PointMap map{kSize, kSize, 1, 1, std::vector<std::int64_t>(std::size_t{kSize} * kSize, PointMap::kNoPoint)};
  const auto place = [&](std::size_t point, int size) {
    int x, y;
    if (!view.find(point, x, y)) return;
    for (int row = std::max(0, y - size / 2); row < std::min(kSize, y - size / 2 + size); ++row)
      for (int column = std::max(0, x - size / 2); column < std::min(kSize, x - size / 2 + size); ++column)
        map.points[map.cellAt(row, column)] = static_cast<std::int64_t>(point);
  };
  // From bottom to top: ground, noise, clusters.
  for (std::size_t i = 0; i < scan.cloud->size(); ++i) place(i, 1);
  for (const auto index : scan.returns.clustered) place(static_cast<std::size_t>(index), 2);
  for (const auto& cluster : scan.clusters)
    for (const auto index : cluster.indices) place(static_cast<std::size_t>(index), 3);
  return map;
}

void drawTopView(const ClusteredScan& scan, const PointMap& map, const ScanColors& colors, const fs::path& png) {
  Canvas canvas(kSize, kSize + kHeaderHeight);
  const View view(scan);
  const Window& window = view.window();
  const double ring = roundLength(window.extent() / 4);  // metres between rings of equal range
  const double ring_pixels = ring * window.pixelsPerMetre();
  const int rings = window.showsSensor() ? kRings : 0;
  const double sensor_x = window.x(view.sensor()[0]);
  const double sensor_y = window.y(view.sensor()[1]);
  canvas.setColor(kLine);
  for (int i = 1; i <= rings; ++i) canvas.circle(sensor_x, sensor_y, i * ring_pixels, 1);

  paintCells(canvas, map, 0, colors.of_point);
  drawBoxes(canvas, scan, view, colors);

  canvas.setColor(kText, 0.75);
  for (int i = 1; i <= rings; ++i) {
    const double y = sensor_y - i * ring_pixels;
    if (y < kHeaderHeight + 14) break;
    canvas.text(sensor_x + 4, y - 4, kLabelSize, formatted("%g m", i * ring));
  }
  // The sensor: a circle with a line that points forward.
  if (window.showsSensor()) {
    canvas.setColor(kText);
    canvas.circle(sensor_x, sensor_y, 6, 2);
    canvas.line(sensor_x, sensor_y - 6, sensor_x, sensor_y - 18, 2);
    canvas.label(sensor_x, sensor_y + 18, kLabelSize, "sensor", kText);
  }
  drawScaleBar(canvas, ring, ring_pixels);

  canvas.setColor(kBackground);
  canvas.fillRectangle(0, 0, kSize, kHeaderHeight);
  drawHeader(canvas, scan, 24, kSize - 30);
  canvas.save(png);
}

}  // namespace lisco_apps
