// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "io/text.h"

namespace lisco_apps {

/// A chart of lines with error bars over a logarithmic y axis.
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

/// \throws std::runtime_error with one line if gnuplot, which draws the charts, is missing
void checkGnuplot();

/// Draws a chart as a PNG, or nothing if it has no lines.
/// \throws std::runtime_error with one line on the error
void drawChart(const Chart& chart, const fs::path& png);

}  // namespace lisco_apps
