// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/canvas.h"

#include <cairo.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "io/file_error.h"

namespace lisco_apps {

Canvas::Canvas(int width, int height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
      context_(cairo_create(surface_.get()), cairo_destroy),
      width_(width),
      height_(height) {
  if (const cairo_status_t status = cairo_status(context_.get()); status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot draw a picture: ") + cairo_status_to_string(status));
  setColor(kBackground);
  cairo_paint(context_.get());
  cairo_select_font_face(context_.get(), kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

void Canvas::fillPixels(int x, int y, int w, int h, std::uint32_t argb) {
  unsigned char* const pixels = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  for (int row = std::max(0, y); row < std::min(height_, y + h); ++row)
    for (int column = std::max(0, x); column < std::min(width_, x + w); ++column)
      std::memcpy(pixels + static_cast<std::ptrdiff_t>(row) * stride + column * 4, &argb, 4);
}

void Canvas::beginPixels() {
  cairo_surface_flush(surface_.get());
}

void Canvas::endPixels() {
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::setColor(const Color& color, double opacity) {
  cairo_set_source_rgba(context_.get(), color.red, color.green, color.blue, opacity);
}

void Canvas::fillRectangle(double x, double y, double w, double h) {
  cairo_rectangle(context_.get(), x, y, w, h);
  cairo_fill(context_.get());
}

void Canvas::strokeRectangle(double x, double y, double w, double h, double line_width) {
  cairo_set_line_width(context_.get(), line_width);
  cairo_rectangle(context_.get(), x, y, w, h);
  cairo_stroke(context_.get());
}

void Canvas::circle(double x, double y, double radius, double line_width) {
  constexpr double kFullCircle = 2 * 3.14159265358979323846;
  cairo_set_line_width(context_.get(), line_width);
  cairo_new_path(context_.get());
  cairo_arc(context_.get(), x, y, radius, 0, kFullCircle);
  cairo_stroke(context_.get());
}

void Canvas::line(double x0, double y0, double x1, double y1, double line_width) {
  cairo_set_line_width(context_.get(), line_width);
  cairo_move_to(context_.get(), x0, y0);
  cairo_line_to(context_.get(), x1, y1);
  cairo_stroke(context_.get());
}

double Canvas::text(double x, double y, double size, const std::string& what, Align align) {
  cairo_set_font_size(context_.get(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), what.c_str(), &extents);
  const double shift = align == Align::kLeft ? 0.0 : (align == Align::kCenter ? 0.5 : 1.0);
  cairo_move_to(context_.get(), x - shift * extents.x_advance, y);
  cairo_show_text(context_.get(), what.c_str());
  return extents.x_advance;
}

void Canvas::save(const std::filesystem::path& png) {
  const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), png.c_str());
  if (status != CAIRO_STATUS_SUCCESS) fail(png, std::string("cannot be written: ") + cairo_status_to_string(status));
}

}  // namespace lisco_apps
