// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "io/text.h"

namespace lisco_apps {

/// A chart of lines, or of single points, with error bars over a logarithmic y axis.
struct Chart {
  struct Point {
    double x, y, error;  ///< error: half the bar, 0 or NaN: none
  };
  struct Line {
    std::string title;
    unsigned color;  ///< 0xRRGGBB
    std::vector<Point> points;
  };
  std::string title, x_label, y_label;
  bool log_x = false;
  bool is_connected = true;  ///< the points of a line
  std::vector<Line> lines{};
};

/// \throws std::runtime_error with one line if gnuplot, which draws the charts, is missing
void checkGnuplot();

/// The suffixes of a chart's files, and the terminals of gnuplot that write them.
struct ChartFormat {
  const char* suffix;
  const char* terminal;
};
inline constexpr ChartFormat kChartFormats[] = {{".png", "pngcairo"}, {".svg", "svg"}};

/// Draws a chart as `stem`.png and `stem`.svg, or nothing if it has no lines.
/// \throws std::runtime_error with one line on the error
void drawChart(const Chart& chart, const std::string& stem);

}  // namespace lisco_apps
