// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <boost/algorithm/string/replace.hpp>

#include "io/text.h"

namespace lisco_apps {
namespace {

/// In single quotes, inside which gnuplot and the shell have different ways of writing one.
std::string quoted(std::string text, const char* quote_inside) {
  boost::replace_all(text, "'", quote_inside);
  boost::replace_all(text, "\n", " ");
  return "'" + text + "'";
}
std::string forGnuplot(const std::string& text) {
  return quoted(text, "''");
}

void writeScript(const Chart& chart, const std::string& stem, std::ostream& script) {
  // Of the points alone: error bars may reach below 0, which a logarithmic axis cannot show.
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0;
  for (const Chart::Line& line : chart.lines)
    for (const Chart::Point& point : line.points) {
      lowest = std::min(lowest, point.y);
      highest = std::max(highest, point.y);
    }
  script
      << "set title " << forGnuplot(chart.title) << '\n'
      << "set xlabel " << forGnuplot(chart.x_label) << '\n'
      << "set ylabel " << forGnuplot(chart.y_label) << '\n'
      << "set logscale y\nset grid ytics xtics back linetype 1 linecolor rgb '#dcdcdc' linewidth 1\nset key outside "
         "bottom center horizontal height 1\n"
      << "set autoscale noextend\nset offsets graph 0.02, graph 0.02\nset border 3\nset tics nomirror\nset bars small\n"
      << "set format y '%g'\n"
      << "set yrange [" << lowest / 2 << ':' << highest * 2 << "]\n"
      << (chart.log_x ? "set logscale x\n" : "");
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    script << "$line" << i << " << END\n";
    for (const Chart::Point& point : chart.lines[i].points)
      script << point.x << ' ' << point.y << ' ' << (std::isfinite(point.error) ? point.error : 0.0) << '\n';
    script << "END\n";
  }
  for (const ChartFormat& format : kChartFormats) {
    script << "set terminal " << format.terminal
           << " noenhanced font ',11' size 900,620 background '#ffffff'\nset output "
           << forGnuplot(stem + format.suffix) << '\n';
    for (std::size_t i = 0; i < chart.lines.size(); ++i)
      script << (i == 0 ? "plot " : ", ") << "$line" << i << " using 1:2:3 with "
             << (chart.is_connected ? "yerrorlines" : "yerrorbars") << " lw 2 pt " << 5 + i % 8 << " ps 0.8 lc rgb "
             << chart.lines[i].color << " title " << forGnuplot(chart.lines[i].title);
    script << '\n';
  }
}

}  // namespace

void checkGnuplot() {
  // Called while there is one thread only. NOLINTNEXTLINE(concurrency-mt-unsafe)
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    throw std::runtime_error("charts need gnuplot (Debian's package gnuplot-nox)");
}

void drawChart(const Chart& chart, const std::string& stem) {
  if (chart.lines.empty()) return;
  const fs::path script = stem + ".gnuplot";
  std::ofstream stream(script);
  stream.precision(10);
  writeScript(chart, stem, stream);
  stream.close();
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  const bool drawn =
      stream && std::system(("gnuplot " + quoted(script.string(), "'\\''") + " >/dev/null 2>&1").c_str()) == 0;
  std::error_code ignored;
  fs::remove(script, ignored);
  for (const ChartFormat& format : kChartFormats)
    if (!drawn || !fs::exists(stem + format.suffix)) fail(stem + format.suffix, "cannot be drawn");
}

}  // namespace lisco_apps
