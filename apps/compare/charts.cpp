// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/charts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drawing/chart.h"
#include "io/text.h"

namespace lisco_apps {
namespace {

Chart::Point pointOf(double x, const Times& times) {
  return {x, times.mean(), times.confidence99()};
}

/// A line per rival that was timed.
/// \param add_points adds the points of a rival to a line
template <typename AddPoints>
std::vector<Chart::Line> linesOf(const CompareSettings& settings, AddPoints&& add_points) {
  std::vector<Chart::Line> lines;
  for (const Rival& rival : settings.rivals) {
    Chart::Line line{rival.title, rival.color, {}};
    add_points(rival, line.points);
    std::sort(line.points.begin(), line.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    if (!line.points.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

constexpr const char* kTimeLabel = "milliseconds, mean with 99% confidence";

std::string overPoints(double tolerance) {
  return formatted("time_over_points_%g.png", tolerance);
}
std::string overTolerance(const std::string& input) {
  return "time_over_tolerance_" + input + ".png";
}
constexpr const char* kMeanChart = "time_over_tolerance.png";

}  // namespace

std::vector<std::string> chartsOf(const std::vector<std::string>& input_names, const CompareSettings& settings) {
  std::vector<std::string> charts;
  for (const std::string& name : input_names) charts.push_back(overTolerance(name));
  if (input_names.size() < 2) return charts;
  charts.emplace_back(kMeanChart);
  for (const double tolerance : settings.tolerances) charts.push_back(overPoints(tolerance));
  return charts;
}

void drawCharts(const std::vector<InputResult>& inputs, const CompareSettings& settings,
                const std::filesystem::path& folder) {
  for (const InputResult& input : inputs) {
    Chart chart{formatted("%s: %zu returns", input.name.c_str(), input.returns), "tolerance, metres", kTimeLabel};
    chart.lines = linesOf(settings, [&](const Rival& rival, std::vector<Chart::Point>& points) {
      for (const CaseResult& result : input.cases) {
        const RivalResult* const entry = result.find(rival.key);
        if (entry->times) points.push_back(pointOf(result.tolerance, *entry->times));
      }
    });
    drawChart(chart, folder / overTolerance(input.name));
  }
  if (inputs.size() < 2) return;

  Chart mean{formatted("arithmetic mean of %zu scans", inputs.size()), "tolerance, metres", kTimeLabel};
  mean.lines = linesOf(settings, [&](const Rival& rival, std::vector<Chart::Point>& points) {
    for (std::size_t at = 0; at < settings.tolerances.size(); ++at) {
      Chart::Point point{settings.tolerances[at], 0, 0};
      std::size_t timed = 0;
      for (const InputResult& input : inputs) {
        const RivalResult* const entry = input.cases[at].find(rival.key);
        if (!entry->times) continue;
        ++timed;
        point.y += entry->times->mean() / static_cast<double>(inputs.size());
        const double error = entry->times->confidence99() / static_cast<double>(inputs.size());
        point.error = std::hypot(point.error, error);
      }
      if (timed == inputs.size()) points.push_back(point);
    }
  });
  drawChart(mean, folder / kMeanChart);

  for (std::size_t at = 0; at < settings.tolerances.size(); ++at) {
    Chart chart{formatted("%zu scans, tolerance %g m", inputs.size(), settings.tolerances[at]), "returns", kTimeLabel,
                true};
    chart.lines = linesOf(settings, [&](const Rival& rival, std::vector<Chart::Point>& points) {
      for (const InputResult& input : inputs) {
        const RivalResult* const entry = input.cases[at].find(rival.key);
        if (entry->times) points.push_back(pointOf(static_cast<double>(input.returns), *entry->times));
      }
    });
    drawChart(chart, folder / overPoints(settings.tolerances[at]));
  }
}

}  // namespace lisco_apps
