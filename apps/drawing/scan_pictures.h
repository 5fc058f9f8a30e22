// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drawing/canvas.h"
#include "drawing/cluster_colors.h"
#include "io/clusters.h"
#include "io/text.h"

namespace lisco_apps {

/// Draws both pictures of a scan, with the ids of its larger clusters, in the same colours:
/// - the scan as the sensor sees it, one cell per laser and step (an unorganized scan is projected by azimuth and
///   elevation): clusters in colours, noise grey, ground dark, no return black; the rectangles around the cells of the
///   larger clusters, divided where they cross the seam of a turn;
/// - the scan from above, x (forward) up and y to the left, with the oriented boxes of the clusters, the sensor and
///   rings of equal range, unless it is far away, and a scale. A camera's cloud (all points ahead in +z) is shown with
///   z up and x to the right, with axis-aligned boxes.
/// \throws std::runtime_error if a file cannot be written
void drawPictures(const ClusteredScan& scan, const fs::path& range_image_png, const fs::path& top_view_png);

// Shared by both pictures. Lengths in pixels.
constexpr int kHeaderHeight = 44;
constexpr double kHeaderBaseline = 28;
constexpr double kTitleSize = 17;
constexpr double kLabelSize = 13;

/// The colours of clusters, and of each point of the cloud, 0xAARRGGBB.
struct ScanColors {
  std::vector<Color> of_cluster;
  std::vector<std::uint32_t> of_point;
  std::vector<std::uint32_t> shaded;  ///< of points: noise and ground darker at a distance, which gives depth
};

/// The ids of clusters at places of a picture, the larger ones first, where there is room.
class IdLabels {
 public:
  /// \param x, y middle of the label, pixels
  void add(Canvas& canvas, std::size_t cluster, double x, double y, const Color& color);
  bool isFull() const { return placed_.size() >= kMaxIds; }

 private:
  static constexpr std::size_t kMaxIds = 60;
  struct Place {
    double x, y, width;
  };
  std::vector<Place> placed_;
};

/// The range image: the points it shows, then the drawing.
PointMap rangeImageOf(const ClusteredScan& scan);
void drawRangeImage(const ClusteredScan& scan, const PointMap& map, const ScanColors& colors, const fs::path& png);

/// The view from above likewise.
PointMap topViewOf(const ClusteredScan& scan);
void drawTopView(const ClusteredScan& scan, const PointMap& map, const ScanColors& colors, const fs::path& png);

/// Fills the cells of a map with the colours of their points. \param left of its first column; it is below the header
void paintCells(Canvas& canvas, const PointMap& map, int left, const std::vector<std::uint32_t>& color_of_point);

/// Writes the title at the left of the header and the meaning of the colours at its right.
/// \param left, right ends of the header
void drawHeader(Canvas& canvas, const ClusteredScan& scan, double left, double right);

/// Where the sensor of a cloud is, metres: its VIEWPOINT; the origin if that is not finite.
using SensorPoint = std::array<double, 3>;
SensorPoint sensorOf(const Cloud& cloud);
/// A point as seen from there.
pcl::PointXYZ seenFrom(const SensorPoint& sensor, const pcl::PointXYZ& point);

/// Whether the points lie ahead of a camera (+z forward) instead of around a LiDAR.
bool seenByCamera(const Cloud& cloud);

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
double roundLength(double length);

}  // namespace lisco_apps
