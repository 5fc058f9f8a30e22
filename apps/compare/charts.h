// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lisco_apps {

/// A chart of lines with error bars; the y axis is logarithmic.
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
  std::vector<Line> lines{};
};

/// Looks whether gnuplot, which draws the charts, is there. \throws std::runtime_error with one line if not
void checkCharts();

/// Draws a chart as a PNG; one without lines is not drawn. \throws std::runtime_error with one line that says what went
/// wrong
void drawChart(const Chart& chart, const std::filesystem::path& png);

}  // namespace lisco_apps
