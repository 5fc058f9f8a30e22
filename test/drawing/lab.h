// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/pi.h"

namespace lisco_test {

/// A colour in CIE L*a*b*, white D65.
using Lab = std::array<double, 3>;

/// \param argb sRGB, 0xAARRGGBB
inline Lab labOf(std::uint32_t argb) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = (argb >> (16 - 8 * i) & 0xFF) / 255.0;
    linear[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const double y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
  const double z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/// The distance of two colours as seen: CIEDE2000, in the notation of Sharma, Wu, Dalal (2005).
inline double labDistance(const Lab& one, const Lab& two) {
  using lisco::kPi;
  const auto pow7 = [](double c) { return std::pow(c, 7); };
  const auto radians = [](double degrees) { return degrees * kPi / 180; };
  const double mean_c = (std::hypot(one[1], one[2]) + std::hypot(two[1], two[2])) / 2;
  const double g = 0.5 * (1 - std::sqrt(pow7(mean_c) / (pow7(mean_c) + pow7(25))));
  const double a1 = one[1] * (1 + g), a2 = two[1] * (1 + g);
  const double c1 = std::hypot(a1, one[2]), c2 = std::hypot(a2, two[2]);
  const auto hueOf = [](double a, double b) {
    const double hue = a == 0 && b == 0 ? 0 : std::atan2(b, a) * 180 / kPi;
    return hue < 0 ? hue + 360 : hue;
  };
  const double h1 = hueOf(a1, one[2]), h2 = hueOf(a2, two[2]);
  double dh = c1 * c2 == 0 ? 0 : h2 - h1;
  double h = c1 * c2 == 0 ? h1 + h2 : (h1 + h2) / 2;
  if (std::fabs(h1 - h2) > 180 && c1 * c2 != 0) {
    dh += dh > 0 ? -360 : 360;
    h += h1 + h2 < 360 ? 180 : -180;
  }
  const double dl = two[0] - one[0], dc = c2 - c1, dH = 2 * std::sqrt(c1 * c2) * std::sin(radians(dh / 2));
  const double l = (one[0] + two[0]) / 2, c = (c1 + c2) / 2;
  const double t = 1 - 0.17 * std::cos(radians(h - 30)) + 0.24 * std::cos(radians(2 * h)) +
                   0.32 * std::cos(radians(3 * h + 6)) - 0.20 * std::cos(radians(4 * h - 63));
  const double sl = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));
  const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
  const double turn = (h - 275) / 25;
  const double rt = -2 * std::sqrt(pow7(c) / (pow7(c) + pow7(25))) * std::sin(radians(60 * std::exp(-turn * turn)));
  return std::sqrt(std::pow(dl / sl, 2) + std::pow(dc / sc, 2) + std::pow(dH / sh, 2) + rt * dc / sc * dH / sh);
}

}  // namespace lisco_test
