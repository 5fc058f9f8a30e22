// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

using cairo_surface_t = struct _cairo_surface;
using cairo_t = struct _cairo;

namespace lisco_apps {

constexpr const char* kFont = "DejaVu Sans";

/// Parts of full brightness, 0 to 1.
struct Color {
  double red, green, blue;

  Color shaded(double factor) const { return {red * factor, green * factor, blue * factor}; }
  std::uint32_t argb() const {
    const auto byte = [](double value) { return static_cast<std::uint32_t>(std::lround(value * 255)); };
    return 0xFF000000U | byte(red) << 16 | byte(green) << 8 | byte(blue);
  }
};

constexpr Color kBackground{0.055, 0.06, 0.075};
constexpr Color kGround{0.24, 0.22, 0.19};
constexpr Color kNoise{0.52, 0.52, 0.52};
constexpr Color kText{0.93, 0.93, 0.93};
constexpr Color kLine{0.30, 0.32, 0.36};
/// Colours of clusters: distinct on a dark background, also with most kinds of colour blindness.
constexpr std::array<Color, 12> kPalette{{{0.90, 0.62, 0.00},
                                          {0.34, 0.71, 0.91},
                                          {0.00, 0.72, 0.50},
                                          {0.94, 0.89, 0.26},
                                          {0.20, 0.48, 0.95},
                                          {0.90, 0.33, 0.10},
                                          {0.90, 0.45, 0.75},
                                          {0.62, 0.88, 0.30},
                                          {0.66, 0.46, 1.00},
                                          {1.00, 0.75, 0.65},
                                          {0.30, 0.90, 0.90},
                                          {0.92, 0.18, 0.38}}};

/// A picture in memory, drawn by Cairo. Lengths in pixels, x to the right, y down; drawing starts from kBackground and is
/// clipped to the picture.
class Canvas {
 public:
  enum class Align { kLeft, kCenter, kRight };

  /// \throws std::runtime_error if the size is beyond Cairo's limits
  Canvas(int width, int height);

  int width() const { return width_; }

  /// Sets pixels directly; to be called between beginPixels () and endPixels ().
  void fillPixels(int x, int y, int w, int h, std::uint32_t argb);
  void beginPixels();
  void endPixels();

  /// The colour of all that follows but pixels.
  void setColor(const Color& color, double opacity = 1.0);
  void fillRectangle(double x, double y, double w, double h);
  void strokeRectangle(double x, double y, double w, double h, double line_width);
  void circle(double x, double y, double radius, double line_width);
  void line(double x0, double y0, double x1, double y1, double line_width);
  /// \param x, y where the baseline begins, has its middle, or ends, as aligned
  /// \return width of the text
  double text(double x, double y, double size, const std::string& what, Align align = Align::kLeft);

  /// \throws std::runtime_error with one line if the file cannot be written
  void save(const std::filesystem::path& png);

 private:
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface_;
  std::unique_ptr<cairo_t, void (*)(cairo_t*)> context_;
  int width_, height_;
};

}  // namespace lisco_apps
