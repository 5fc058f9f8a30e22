// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/pi.h"
#include "io/text.h"

namespace lisco_apps {

/// Parts of full brightness, 0 to 1.
struct Color {
  double red, green, blue;

  Color shaded(double factor) const { return {red * factor, green * factor, blue * factor}; }
  /// Halfway to white: for lines and letters over points of this colour.
  Color brightened() const { return {(1 + red) / 2, (1 + green) / 2, (1 + blue) / 2}; }
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
/// Colours of clusters on a dark background, of which any two differ clearly, and each from noise and ground: by
/// CIEDE2000 distances of 19.5 or more. The first kPrimaryColors differ also with red-green blindness (CIE76 distances
/// of 36 or more as seen with protanopia and deuteranopia); the others are for clusters with so many neighbours that
/// these do not suffice.
constexpr Color kPalette[] = {{0.85, 0.80, 0.20}, {0.05, 0.60, 0.90}, {0.00, 1.00, 0.60}, {0.55, 0.35, 0.00},
                              {0.40, 0.30, 1.00}, {0.00, 0.95, 1.00}, {0.80, 0.05, 0.40}, {1.00, 0.75, 0.95},
                              {0.05, 0.55, 0.40}, {1.00, 0.25, 0.00}, {0.95, 0.75, 0.65}, {0.30, 0.70, 0.00},
                              {1.00, 0.15, 0.85}, {0.90, 0.55, 0.00}, {1.00, 0.50, 0.55}, {0.95, 1.00, 0.80},
                              {0.50, 0.35, 0.55}, {0.30, 0.45, 0.00}, {0.65, 0.55, 0.95}, {0.60, 0.35, 0.30},
                              {0.70, 0.85, 1.00}};
constexpr std::size_t kPrimaryColors = 7;

/// A picture in memory, drawn by Cairo. Lengths in pixels, x to the right, y down; drawing starts from kBackground and
/// is clipped to the picture.
class Canvas {
 public:
  enum class Align { kLeft, kCenter, kRight };

  /// \throws std::runtime_error if the size is beyond Cairo's limits
  Canvas(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
        context_(cairo_create(surface_.get()), cairo_destroy),
        width_(width),
        height_(height) {
    if (const cairo_status_t status = cairo_status(context_.get()); status != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(std::string("cannot draw a picture: ") + cairo_status_to_string(status));
    setColor(kBackground);
    cairo_paint(context_.get());
    cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  }

  int width() const { return width_; }

  /// Sets pixels directly; to be called between beginPixels () and endPixels ().
  void fillPixels(int x, int y, int w, int h, std::uint32_t argb) {
    unsigned char* const pixels = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    for (int row = std::max(0, y); row < std::min(height_, y + h); ++row)
      for (int column = std::max(0, x); column < std::min(width_, x + w); ++column)
        std::memcpy(pixels + static_cast<std::ptrdiff_t>(row) * stride + column * 4, &argb, 4);
  }
  void beginPixels() { cairo_surface_flush(surface_.get()); }
  void endPixels() { cairo_surface_mark_dirty(surface_.get()); }

  /// The colour of all that follows but pixels.
  void setColor(const Color& color, double opacity = 1.0) {
    cairo_set_source_rgba(context_.get(), color.red, color.green, color.blue, opacity);
  }
  void fillRectangle(double x, double y, double w, double h) {
    cairo_rectangle(context_.get(), x, y, w, h);
    cairo_fill(context_.get());
  }
  void strokeRectangle(double x, double y, double w, double h, double line_width) {
    cairo_rectangle(context_.get(), x, y, w, h);
    stroke(line_width);
  }
  void circle(double x, double y, double radius, double line_width) {
    cairo_new_path(context_.get());
    cairo_arc(context_.get(), x, y, radius, 0, 2 * lisco::kPi);
    stroke(line_width);
  }
  void line(double x0, double y0, double x1, double y1, double line_width) {
    cairo_move_to(context_.get(), x0, y0);
    cairo_line_to(context_.get(), x1, y1);
    stroke(line_width);
  }
  /// Strokes a closed outline. \param corners x and y
  void strokePolygon(const std::vector<std::array<double, 2>>& corners, double line_width) {
    cairo_new_path(context_.get());
    for (const auto& [x, y] : corners) cairo_line_to(context_.get(), x, y);
    cairo_close_path(context_.get());
    stroke(line_width);
  }
  /// Text with its middle at (x, y), on a dark rectangle.
  void label(double x, double y, double size, const std::string& what, const Color& color) {
    const double width = widthOf(what, size) + 4;
    setColor(kBackground, 0.75);
    fillRectangle(x - width / 2, y - size / 2 - 1, width, size + 2);
    setColor(color);
    text(x, y + 0.36 * size, size, what, Align::kCenter);
  }
  double widthOf(const std::string& what, double size) {
    cairo_set_font_size(context_.get(), size);
    cairo_text_extents_t extents;
    cairo_text_extents(context_.get(), what.c_str(), &extents);
    return extents.x_advance;
  }
  /// \param x, y where the baseline begins, has its middle, or ends, as aligned
  /// \return width of the text
  double text(double x, double y, double size, const std::string& what, Align align = Align::kLeft) {
    const double width = widthOf(what, size);
    const double shift = align == Align::kLeft ? 0.0 : (align == Align::kCenter ? 0.5 : 1.0);
    cairo_move_to(context_.get(), x - shift * width, y);
    cairo_show_text(context_.get(), what.c_str());
    return width;
  }

  /// \throws std::runtime_error with one line if the file cannot be written
  void save(const fs::path& png) {
    const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), png.c_str());
    if (status != CAIRO_STATUS_SUCCESS) fail(png, std::string("cannot be written: ") + cairo_status_to_string(status));
  }

 private:
  void stroke(double line_width) {
    cairo_set_line_width(context_.get(), line_width);
    cairo_stroke(context_.get());
  }

  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
  int width_, height_;
};

}  // namespace lisco_apps
