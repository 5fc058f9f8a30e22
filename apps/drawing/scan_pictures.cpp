// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/scan_pictures.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

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

/// A colour per cluster. Clusters of one colour are kept apart: each cluster, the largest first, takes the colour whose
/// nearest cluster so far is the farthest away.
std::vector<Color> colorsOf(const ClusteredScan& scan) {
  std::vector<Color> colors;
  std::vector<std::pair<ClusterShape, std::size_t>> placed;
  for (const auto& cluster : scan.clusters) {
    const ClusterShape shape = shapeOf(*scan.cloud, cluster);
    std::array<double, std::size(kPalette)> nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    for (const auto& [other, color] : placed) {
      double squared_gap = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float gap = std::max({other.lo()[axis] - shape.hi()[axis], shape.lo()[axis] - other.hi()[axis], 0.0F});
        squared_gap += static_cast<double>(gap) * static_cast<double>(gap);
      }
      nearest[color] = std::min(nearest[color], squared_gap);
    }
    const auto best = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    placed.emplace_back(shape, best);
    colors.push_back(kPalette[best]);
  }
  return colors;
}

}  // namespace

std::vector<std::uint32_t> pointColors(const ClusteredScan& scan, bool shade_by_range) {
  const Cloud& cloud = *scan.cloud;
  std::vector<std::uint32_t> colors(cloud.size(), kBackground.argb());
  const auto color = [&](std::size_t i, const Color& plain) {
    const double brightness = 1.0 - kDimming * std::log2(std::max(rangeOf(cloud[i]), kMinRange) / kFullBrightness);
    colors[i] = plain.shaded(shade_by_range ? std::clamp(brightness, kMinBrightness, 1.0) : 1.0).argb();
  };
  for (std::size_t i = 0; i < colors.size(); ++i)
    if (isReturn(cloud[i])) color(i, kGround);
  for (const auto index : scan.clustered) color(static_cast<std::size_t>(index), kNoise);
  const std::vector<Color> of_cluster = colorsOf(scan);
  for (std::size_t i = 0; i < scan.clusters.size(); ++i)
    for (const auto index : scan.clusters[i].indices) color(static_cast<std::size_t>(index), of_cluster[i]);
  return colors;
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

bool seenByCamera(const Cloud& cloud) {
  std::size_t returns = 0;
  std::size_t ahead = 0;
  for (const auto& point : cloud) {
    if (!isReturn(point)) continue;
    ++returns;
    ahead += point.z > 0.5F * std::hypot(point.x, point.y) ? 1 : 0;
  }
  return returns > 0 && static_cast<double>(ahead) > kCameraShare * static_cast<double>(returns);
}

double roundLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double mantissa = length / power;
  return power * (mantissa >= 5 ? 5 : (mantissa >= 2 ? 2 : 1));
}

}  // namespace lisco_apps
