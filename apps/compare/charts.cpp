// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <cmath>
#include <utility>

#include "compare/report.h"
#include "drawing/chart.h"
#include "io/text.h"

namespace lisco_apps {
namespace {

/// Draws a line per baseline that was timed.
/// \param add_points (baseline, points) appends its points
template <typename AddPoints>
void drawLines(const CompareSettings& settings, const std::string& title, const char* x_label, bool log_x,
               const fs::path& stem, AddPoints&& add_points) {
  // Scans of different scenes lie on no curve over the number of their returns.
  Chart chart{title, x_label, "milliseconds, mean with 99% confidence", log_x, !log_x};
  for (const Baseline& baseline : settings.baselines) {
    Chart::Line line{baseline.title, baseline.color, {}};
    add_points(baseline, line.points);
    std::sort(line.points.begin(), line.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    if (!line.points.empty()) chart.lines.push_back(std::move(line));
  }
  drawChart(chart, stem.string());
}

/// Appends the times of a baseline, if it was timed.
void addPoint(const CaseResult& result, const Baseline& baseline, double x, std::vector<Chart::Point>& points) {
  const std::optional<Times>& times = result.find(baseline.key)->times;
  if (times) points.push_back({x, times->mean(), times->confidence99()});
}

constexpr const char* kOverTolerance = "tolerance, metres";

std::string overPoints(double tolerance) {
  return formatted("time_over_points_%.9g", tolerance);
}
std::string overTolerance(const std::string& input) {
  return "time_over_tolerance_" + input;
}
constexpr const char* kMeanChart = "time_over_tolerance";

}  // namespace

std::vector<std::string> chartsOf(const std::vector<std::string>& input_names, const CompareSettings& settings) {
  std::vector<std::string> charts;
  const auto add = [&](const std::string& stem) {
    for (const ChartFormat& format : kChartFormats) charts.push_back(stem + format.suffix);
  };
  for (const std::string& name : input_names) add(overTolerance(name));
  if (input_names.size() < 2) return charts;
  add(kMeanChart);
  for (const double tolerance : settings.tolerances) add(overPoints(tolerance));
  return charts;
}

void drawCharts(const std::vector<InputResult>& inputs, const CompareSettings& settings, const fs::path& folder) {
  for (const InputResult& input : inputs)
    drawLines(settings, formatted("%s: %zu returns", input.name.c_str(), input.returns), kOverTolerance, false,
              folder / overTolerance(input.name), [&](const Baseline& baseline, auto& points) {
                for (const CaseResult& result : input.cases) addPoint(result, baseline, result.tolerance, points);
              });
  if (inputs.size() < 2) return;

  drawLines(settings, formatted("geometric mean of %zu scans", inputs.size()), kOverTolerance, false,
            folder / kMeanChart, [&](const Baseline& baseline, auto& points) {
              for (std::size_t at = 0; at < settings.tolerances.size(); ++at) {
                std::vector<Chart::Point> all;
                for (const InputResult& input : inputs) addPoint(input.cases[at], baseline, 0, all);
                if (all.size() != inputs.size()) continue;
                double log_mean = 0;
                double relative_error = 0;
                for (const Chart::Point& point : all) {
                  log_mean += std::log(point.y) / static_cast<double>(inputs.size());
                  relative_error =
                      std::hypot(relative_error, point.error / point.y / static_cast<double>(inputs.size()));
                }
                const double mean = std::exp(log_mean);
                points.push_back({settings.tolerances[at], mean, relative_error * mean});
              }
            });

  for (std::size_t at = 0; at < settings.tolerances.size(); ++at)
    drawLines(settings, formatted("%zu scans, tolerance %g m", inputs.size(), settings.tolerances[at]), "returns", true,
              folder / overPoints(settings.tolerances[at]), [&](const Baseline& baseline, auto& points) {
                for (const InputResult& input : inputs)
                  addPoint(input.cases[at], baseline, static_cast<double>(input.returns), points);
              });
}

}  // namespace lisco_apps
