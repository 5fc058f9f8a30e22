// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "ground_picture.h"

#include <algorithm>
#include <cmath>

#include "drawing/canvas.h"
#include "io/point_geometry.h"

namespace lisco_benchmarks {

using namespace lisco_apps;

void drawGround(const Cloud& cloud, const std::vector<std::uint8_t>& ground, const std::vector<float>& local,
                const std::vector<std::int32_t>& labels, const std::vector<std::uint8_t>& flat_clusters, double radius,
                const std::filesystem::path& png) {
  constexpr int kSize = 1400;
  constexpr int kSide = 400;
  constexpr double kSideMetres = 12.0;  // shown in height
  constexpr Color kFlat{1.0, 0.0, 1.0}, kLost{1.0, 0.15, 0.1}, kBrown{0.5, 0.36, 0.2};
  Canvas canvas(kSize, kSize + kSide);
  canvas.beginPixels();
  for (int pass = 0; pass < 3; ++pass)
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!isReturn(cloud[i])) continue;
      const double above = static_cast<double>(cloud[i].z - local[i]);
      const bool flat = labels[i] >= 0 && flat_clusters[static_cast<std::size_t>(labels[i])] != 0;
      const bool lost = ground[i] != 0 && above > 0.5;
      if (pass != (flat || lost ? 2 : ground[i] != 0 ? 0 : 1)) continue;
      const double bright = 0.35 + 0.65 * std::clamp(above / 3.0, 0.0, 1.0);
      const Color color = flat ? kFlat : lost ? kLost : ground[i] != 0 ? kBrown : Color{bright * 0.8, bright, 1.0};
      const int size = pass == 2 ? 3 : 2;
      const double scale = kSize / (2 * radius);
      const auto x = static_cast<double>(cloud[i].x), y = static_cast<double>(cloud[i].y);
      if (std::fabs(x) < radius && std::fabs(y) < radius)
        canvas.fillPixels(static_cast<int>(kSize / 2.0 - y * scale), static_cast<int>(kSize / 2.0 - x * scale), size,
                          size, color.argb());
      const double side = std::hypot(x, y) * kSize / (radius * 1.5);
      const double up = (static_cast<double>(cloud[i].z) + 5.0) / kSideMetres * kSide;
      if (up > 0 && up < kSide && side < kSize)
        canvas.fillPixels(static_cast<int>(side), kSize + kSide - static_cast<int>(up), size, size, color.argb());
    }
  canvas.endPixels();
  canvas.save(png);
}

}  // namespace lisco_benchmarks
