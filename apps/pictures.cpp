// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "pictures.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

#include "lisco/return.h"
#include "stagger.h"

namespace lisco_apps {
namespace {

constexpr double kPi = 3.14159265358979323846;

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
// Colours that are told apart at a glance on a dark ground, also by most colour-blind eyes.
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

/// A colour per cluster, so that clusters of one colour lie as far apart as can be: each cluster, the largest
/// first, takes the colour whose nearest bearer is the farthest away.
std::vector<Color> colorsOf(const ClusteredScan& scan) {
  std::vector<Color> colors;
  std::vector<std::pair<ClusterShape, std::size_t>> placed;
  for (const auto& cluster : scan.clusters) {
    const ClusterShape shape = shapeOf(*scan.cloud, cluster);
    std::array<double, kPalette.size()> nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    for (const auto& [other, color] : placed) {
      double gap = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float apart = std::max({other.lo[axis] - shape.hi[axis], shape.lo[axis] - other.hi[axis], 0.0F});
        gap += static_cast<double>(apart) * static_cast<double>(apart);
      }
      nearest[color] = std::min(nearest[color], gap);
    }
    const auto best = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    placed.emplace_back(shape, best);
    colors.push_back(kPalette[best]);
  }
  return colors;
}

double rangeOf(const pcl::PointXYZ& point) {
  return std::hypot(static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z));
}

/// Per point of the cloud, the colour it is drawn in.
/// \param by_range whether what is further away is darker, which gives a picture from the sensor its depth
std::vector<std::uint32_t> pointColors(const ClusteredScan& scan, bool by_range) {
  const Cloud& cloud = *scan.cloud;
  std::vector<std::uint32_t> colors(cloud.size(), kBackground.argb());
  const auto color = [&](std::size_t i, const Color& plain) {
    constexpr double kFull = 4.0;         // metres
    constexpr double kPerDoubling = 0.1;  // of the brightness
    const double factor = 1.0 - kPerDoubling * std::log2(std::max(rangeOf(cloud[i]), 1e-3) / kFull);
    colors[i] = plain.shaded(by_range ? std::clamp(factor, 0.5, 1.0) : 1.0).argb();
  };
  for (std::size_t i = 0; i < colors.size(); ++i)
    if (lisco::isReturn(cloud[i].x, cloud[i].y, cloud[i].z)) color(i, kGround);
  for (const auto& index : scan.clustered) color(static_cast<std::size_t>(index), kNoise);
  const std::vector<Color> of_cluster = colorsOf(scan);
  for (std::size_t number = 0; number < scan.clusters.size(); ++number)
    for (const auto& index : scan.clusters[number].indices) color(static_cast<std::size_t>(index), of_cluster[number]);
  return colors;
}

/// A picture: pixels set one by one, with lines and text drawn over them by Cairo.
class Canvas {
 public:
  Canvas(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
        context_(cairo_create(surface_.get()), cairo_destroy),
        width_(width),
        height_(height) {
    if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(std::string("cannot draw a picture: ") +
                               cairo_status_to_string(cairo_status(context_.get())));
    setColor(kBackground);
    cairo_paint(context_.get());
    cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  cairo_t* context() const { return context_.get(); }

  void setColor(const Color& color, double opacity = 1.0) {
    cairo_set_source_rgba(context_.get(), color.red, color.green, color.blue, opacity);
  }

  /// Fills the pixels of a rectangle, cut to the picture.
  void fill(int x, int y, int w, int h, std::uint32_t argb) {
    unsigned char* const pixels = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    for (int row = std::max(0, y); row < std::min(height_, y + h); ++row)
      for (int column = std::max(0, x); column < std::min(width_, x + w); ++column)
        std::memcpy(pixels + static_cast<std::ptrdiff_t>(row) * stride + column * 4, &argb, 4);
  }
  void beginPixels() { cairo_surface_flush(surface_.get()); }
  void endPixels() { cairo_surface_mark_dirty(surface_.get()); }

  enum class Align { kLeft, kCenter, kRight };
  void text(double x, double y, double size, const std::string& what, Align align = Align::kLeft) {
    cairo_set_font_size(context_.get(), size);
    cairo_text_extents_t extents;
    cairo_text_extents(context_.get(), what.c_str(), &extents);
    const double shift = align == Align::kLeft ? 0.0 : (align == Align::kCenter ? 0.5 : 1.0);
    cairo_move_to(context_.get(), x - shift * extents.x_advance, y);
    cairo_show_text(context_.get(), what.c_str());
  }

  void circle(double x, double y, double radius, double width) {
    cairo_set_line_width(context_.get(), width);
    cairo_new_path(context_.get());
    cairo_arc(context_.get(), x, y, radius, 0, 2 * kPi);
    cairo_stroke(context_.get());
  }

  void line(double x0, double y0, double x1, double y1, double width) {
    cairo_set_line_width(context_.get(), width);
    cairo_move_to(context_.get(), x0, y0);
    cairo_line_to(context_.get(), x1, y1);
    cairo_stroke(context_.get());
  }

  void save(const std::filesystem::path& png) {
    const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), png.c_str());
    if (status != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(png.string() + ": cannot be written: " + cairo_status_to_string(status));
  }

 private:
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
  int width_, height_;
};

std::string titleOf(const ClusteredScan& scan) {
  char text[200];
  std::snprintf(text, sizeof text, "%zu clusters, tolerance %g m", scan.clusters.size(), scan.tolerance);
  return scan.name + ":  " + text;
}

/// The meaning of the colours, in one line from x on.
void drawKey(Canvas& canvas, double x, double y) {
  const auto entry = [&](const Color& color, const char* what) {
    canvas.setColor(color);
    cairo_rectangle(canvas.context(), x, y - 10, 12, 12);
    cairo_fill(canvas.context());
    canvas.setColor(kText);
    canvas.text(x + 18, y, 13, what);
    cairo_text_extents_t extents;
    cairo_text_extents(canvas.context(), what, &extents);
    x += 18 + extents.x_advance + 22;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    canvas.setColor(kPalette[i]);
    cairo_rectangle(canvas.context(), x, y - 10, 12, 12);
    cairo_fill(canvas.context());
    x += 14;
  }
  x -= 14;
  canvas.setColor(kText);
  entry(kPalette[2], "clusters");
  entry(kNoise, "noise");
  entry(kGround, "ground");
}

/// Whether the points lie ahead of a camera (+z forward) instead of around a LiDAR.
bool seenByCamera(const Cloud& cloud) {
  std::size_t returns = 0;
  std::size_t ahead = 0;
  for (const auto& point : cloud)
    if (lisco::isReturn(point.x, point.y, point.z)) {
      ++returns;
      ahead += point.z > 0.5F * std::hypot(point.x, point.y) ? 1 : 0;
    }
  return returns > 0 && static_cast<double>(ahead) > 0.99 * static_cast<double>(returns);
}

/// 1, 2 or 5 times a power of ten, the largest that is not above `length`.
double roundLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double mantissa = length / power;
  return power * (mantissa >= 5 ? 5 : (mantissa >= 2 ? 2 : 1));
}

std::string metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%g m", length);
  return text;
}

struct Cells {
  int columns, rows;
  std::vector<std::uint32_t> colors;  ///< row by row
};

/// Every n-th cell, so that a picture has at most 8000 columns and rows.
Cells thinnedOut(const Cells& cells) {
  constexpr int kMost = 8000;
  const int n = (cells.columns + kMost - 1) / kMost;
  const int m = (cells.rows + kMost - 1) / kMost;
  if (n == 1 && m == 1) return cells;
  Cells thin{(cells.columns + n - 1) / n, (cells.rows + m - 1) / m, {}};
  for (int row = 0; row < cells.rows; row += m)
    for (int column = 0; column < cells.columns; column += n)
      thin.colors.push_back(cells.colors[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells.columns) +
                                         static_cast<std::size_t>(column)]);
  return thin;
}

/// The cells of an organized scan, each row shifted by its stagger; of any other, a projection by azimuth and
/// elevation.
Cells cellsOf(const ClusteredScan& scan) {
  const Cloud& cloud = *scan.cloud;
  const std::vector<std::uint32_t> colors = pointColors(scan, true);
  if (cloud.height > 1) {
    Cells cells{static_cast<int>(cloud.width), static_cast<int>(cloud.height), colors};
    const std::vector<int> shifts = seenByCamera(cloud) ? std::vector<int>(cloud.height, 0) : staggerOf(cloud);
    for (std::size_t row = 0; row < cloud.height; ++row)
      for (int column = 0; column < cells.columns; ++column) {
        const int shifted = ((column + shifts[row]) % cells.columns + cells.columns) % cells.columns;
        cells.colors[row * cloud.width + static_cast<std::size_t>(shifted)] =
            colors[row * cloud.width + static_cast<std::size_t>(column)];
      }
    return cells;
  }

  constexpr int kColumns = 1800;
  constexpr int kRows = 96;
  double lowest = kPi / 2;
  double highest = -kPi / 2;
  const auto elevation = [](const pcl::PointXYZ& p) {
    return std::atan2(static_cast<double>(p.z), std::hypot(static_cast<double>(p.x), static_cast<double>(p.y)));
  };
  const auto valid = [](const pcl::PointXYZ& p) { return lisco::isReturn(p.x, p.y, p.z); };
  for (const auto& point : cloud)
    if (valid(point)) {
      lowest = std::min(lowest, elevation(point));
      highest = std::max(highest, elevation(point));
    }
  Cells cells{kColumns, kRows,
              std::vector<std::uint32_t>(static_cast<std::size_t>(kColumns) * kRows, kBackground.argb())};
  std::vector<double> nearest(cells.colors.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& point = cloud[i];
    if (!valid(point)) continue;
    const double azimuth = std::atan2(static_cast<double>(point.y), static_cast<double>(point.x));
    const auto column =
        static_cast<std::size_t>(std::clamp((0.5 - azimuth / (2 * kPi)) * kColumns, 0.0, kColumns - 1.0));
    const double down = (highest - elevation(point)) / std::max(highest - lowest, 1e-9);
    const auto row = static_cast<std::size_t>(std::clamp(down * kRows, 0.0, kRows - 1.0));
    const double range = rangeOf(point);
    const std::size_t cell = row * kColumns + column;
    if (range < nearest[cell]) {
      nearest[cell] = range;
      cells.colors[cell] = colors[i];
    }
  }
  return cells;
}

}  // namespace

void drawRangeImage(const ClusteredScan& scan, const std::filesystem::path& png) {
  const Cells cells = thinnedOut(cellsOf(scan));
  constexpr int kMargin = 40;
  constexpr int kTop = 44;
  const int scale_x = std::clamp(1800 / cells.columns, 1, 12);
  const int scale_y = std::clamp(std::max(420 / cells.rows, std::min(scale_x, 2000 / cells.rows)), 1, 12);
  Canvas canvas(cells.columns * scale_x + 2 * kMargin, cells.rows * scale_y + kTop + kMargin);

  canvas.beginPixels();
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.columns; ++column)
      canvas.fill(kMargin + column * scale_x, kTop + row * scale_y, scale_x, scale_y,
                  cells.colors[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells.columns) +
                               static_cast<std::size_t>(column)]);
  canvas.endPixels();

  canvas.setColor(kLine);
  cairo_set_line_width(canvas.context(), 1);
  cairo_rectangle(canvas.context(), kMargin - 0.5, kTop - 0.5, cells.columns * scale_x + 1, cells.rows * scale_y + 1);
  cairo_stroke(canvas.context());
  canvas.setColor(kText);
  canvas.text(kMargin, 28, 17, titleOf(scan));
  drawKey(canvas, canvas.width() - kMargin - 270, 28);
  const bool organized = scan.cloud->height > 1;
  const double bottom = kTop + cells.rows * scale_y;
  const int step = std::max(1, static_cast<int>(roundLength(std::max(1.0, cells.columns / 4.0))));
  for (int column = 0; column < cells.columns; column += organized ? step : cells.columns / 8) {
    const double x = kMargin + column * scale_x;
    if (x > canvas.width() - kMargin - (organized ? 180 : 360)) break;  // room for the words at the right
    canvas.setColor(kLine);
    canvas.line(x, bottom, x, bottom + 6, 1);
    canvas.setColor(kText);
    canvas.text(x, bottom + 22, 13,
                organized ? "column " + std::to_string(column)
                          : "azimuth " + std::to_string(180 - 360 * column / cells.columns) + "\u00b0");
  }
  canvas.text(canvas.width() - kMargin, bottom + 22, 13,
              organized ? std::to_string(scan.cloud->height) + " rows" : "unorganized: by azimuth and elevation",
              Canvas::Align::kRight);
  canvas.save(png);
}

void drawTopView(const ClusteredScan& scan, const std::filesystem::path& png) {
  constexpr int kSize = 1400;
  constexpr int kTop = 44;
  Canvas canvas(kSize, kSize + kTop);
  const Cloud& cloud = *scan.cloud;
  const bool camera = seenByCamera(cloud);
  // Right and up on the picture, in metres.
  const auto right = [camera](const pcl::PointXYZ& p) { return static_cast<double>(camera ? p.x : -p.y); };
  const auto up = [camera](const pcl::PointXYZ& p) { return static_cast<double>(camera ? p.z : p.x); };

  // The window holds the sensor and all but the outermost hundredth of what was clustered, on each side.
  std::vector<double> rights{0.0};
  std::vector<double> ups{0.0};
  for (const auto& index : scan.clustered) {
    rights.push_back(right(cloud[static_cast<std::size_t>(index)]));
    ups.push_back(up(cloud[static_cast<std::size_t>(index)]));
  }
  const auto span = [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 100;
    return std::pair{std::min(0.0, values[cut]), std::max(0.0, values[values.size() - 1 - cut])};
  };
  const auto [left_end, right_end] = span(rights);
  const auto [low_end, high_end] = span(ups);
  const double extent = std::max({right_end - left_end, high_end - low_end, 1e-3}) * 1.08;
  const double pixels_per_metre = kSize / extent;
  const double center_right = (left_end + right_end) / 2;
  const double center_up = (low_end + high_end) / 2;
  const auto pixel_x = [&](double r) { return kSize / 2.0 + (r - center_right) * pixels_per_metre; };
  const auto pixel_y = [&](double u) { return kTop + kSize / 2.0 - (u - center_up) * pixels_per_metre; };

  // Rings of equal range around the sensor.
  const double ring = roundLength(extent / 4);
  const double sensor_x = pixel_x(0);
  const double sensor_y = pixel_y(0);
  for (int i = 1; i <= 20; ++i) {
    canvas.setColor(kLine);
    canvas.circle(sensor_x, sensor_y, i * ring * pixels_per_metre, 1);
  }

  const std::vector<std::uint32_t> colors = pointColors(scan, false);
  canvas.beginPixels();
  const auto draw = [&](std::size_t i, int size) {
    const auto& point = cloud[i];
    if (!lisco::isReturn(point.x, point.y, point.z)) return;
    const double x = pixel_x(right(point));
    const double y = pixel_y(up(point));
    if (x < 0 || y < kTop || x >= kSize || y >= kSize + kTop) return;
    canvas.fill(static_cast<int>(x) - size / 2, static_cast<int>(y) - size / 2, size, size, colors[i]);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) draw(i, 1);  // ground below everything else
  for (const auto& index : scan.clustered) draw(static_cast<std::size_t>(index), 2);
  for (const auto& cluster : scan.clusters)
    for (const auto& index : cluster.indices) draw(static_cast<std::size_t>(index), 3);
  canvas.endPixels();

  for (int i = 1; i <= 20; ++i) {
    const double y = sensor_y - i * ring * pixels_per_metre;
    if (y < kTop + 14) break;
    canvas.setColor(kText, 0.75);
    canvas.text(sensor_x + 4, y - 4, 13, metres(i * ring));
  }
  // The sensor: a ring with a nose that points forward.
  canvas.setColor(kText);
  canvas.circle(sensor_x, sensor_y, 6, 2);
  canvas.line(sensor_x, sensor_y - 6, sensor_x, sensor_y - 18, 2);
  canvas.text(sensor_x + 10, sensor_y + 18, 13, "sensor");

  // Scale bar.
  const double bar = ring * pixels_per_metre;
  const double bar_y = kSize + kTop - 28;
  canvas.setColor(kBackground, 0.8);
  cairo_rectangle(canvas.context(), 20, bar_y - 26, bar + 24, 44);
  cairo_fill(canvas.context());
  canvas.setColor(kText);
  canvas.line(32, bar_y, 32 + bar, bar_y, 2);
  canvas.line(32, bar_y - 5, 32, bar_y + 5, 2);
  canvas.line(32 + bar, bar_y - 5, 32 + bar, bar_y + 5, 2);
  canvas.text(32 + bar / 2, bar_y - 8, 14, metres(ring), Canvas::Align::kCenter);

  canvas.setColor(kBackground);
  cairo_rectangle(canvas.context(), 0, 0, kSize, kTop);
  cairo_fill(canvas.context());
  canvas.setColor(kText);
  canvas.text(24, 28, 17, titleOf(scan));
  drawKey(canvas, kSize - 300, 28);
  canvas.save(png);
}

}  // namespace lisco_apps
