// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <thread>

#include <boost/algorithm/string.hpp>
#include <nlohmann/json.hpp>

#include <pcl/pcl_config.h>

#include "io/text.h"
#include "lisco/version.h"

namespace lisco_apps {
namespace {

constexpr const char* kCompiler =
#ifdef __clang__
    "Clang " __clang_version__;
#else
    "GCC " __VERSION__;
#endif

constexpr const char* kBuild = LISCO_BUILD;  // type and flags

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string line;
  while (std::getline(info, line))
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown processor";
}

/// The table's last column.
std::string verdictOn(const BaselineResult& result) {
  if (!result.failure.empty()) return "not possible: " + result.failure;
  if (result.baseline->key == kReferenceKey) return "reference";
  if (result.difference.identical) return "identical";
  if (result.difference.same_sets) return "DIFFERENT order";
  return formatted("DIFFERENT: %zu points, %zu clusters", result.difference.mislabelled, result.clusters);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

nlohmann::ordered_json jsonOf(const CaseResult& result, const BaselineResult& entry, const CompareSettings& settings) {
  nlohmann::ordered_json json{{"baseline", entry.baseline->key},
                              {"title", entry.baseline->title},
                              {"must_agree", settings.mustAgree(*entry.baseline)}};
  if (!entry.failure.empty()) {
    json["failure"] = entry.failure;
    return json;
  }
  json["clusters"] = entry.clusters;
  json["identical"] = entry.difference.identical;
  if (!entry.difference.identical)
    json["difference"] = {{"same_sets", entry.difference.same_sets},
                          {"clusters", entry.difference.clusters},
                          {"mislabelled", entry.difference.mislabelled},
                          {"missed_by_pcl", entry.difference.missed_by_reference},
                          {"details", entry.difference.details}};
  if (!entry.times) return json;
  json["runs"] = entry.times->runs.size();
  json["mean_ms"] = entry.times->mean();
  json["confidence99_ms"] = entry.times->confidence99();  // NaN and infinity are written as null, here and below
  json["median_ms"] = median(entry.times->runs);
  json["lower_quartile_ms"] = quantile(entry.times->runs, 0.25);
  json["upper_quartile_ms"] = quantile(entry.times->runs, 0.75);
  json["ratio"] = result.ratio(entry).value_or(kNan);
  json["cold_median_ms"] = median(entry.times->cold);
  json["times_ms"] = entry.times->runs;
  return json;
}

}  // namespace

std::string describeRun(const CompareSettings& settings, unsigned threads) {
  std::string text = formatted("lisco %s, %s, %s with %u threads, of which ", LISCO_VERSION, kCompiler,
                               processor().c_str(), std::thread::hardware_concurrency());
  text += threads == 1 ? "1 is used\n" : formatted("up to %u are used\n", threads);
  text += std::string("against PCL ") + PCL_VERSION_PRETTY + "; built as " + kBuild + "\n";
#ifndef NDEBUG
  text += "not a release build: its times are not representative\n";
#endif
  if (settings.runs > 0) text += formatted("%zu run%s of each in turn", settings.runs, settings.runs == 1 ? "" : "s");
  if (settings.runs > 3)
    text += formatted("; fewer, at least 3, of a baseline that takes longer than %g s for all of them",
                      settings.max_seconds);
  if (settings.runs > 0) text += "\n";
  return text;
}

std::string headingOf(const InputResult& input, const CompareSettings& settings) {
  std::string text = "\n" + input.file + ": ";
  text += input.rows > 1 ? formatted("%zu rows x %zu columns, ", input.rows, input.columns) : "unorganized, ";
  text += formatted("%zu returns", input.returns);
  if (input.ground.method == GroundChoice::Method::kHeight)
    text += formatted(" above %g m", static_cast<double>(input.ground.height));
  return text + formatted(", clusters of at least %u\n", settings.min_size);
}

std::string tableOf(const CaseResult& result) {
  std::string text = formatted("\n  tolerance %g m: %zu clusters\n", result.tolerance, result.clusters);
  if (result.objects)
    text += formatted("  true objects: %zu; %zu whole, %zu split, %zu merged with others, %zu missed\n",
                      result.objects->objects, result.objects->whole, result.objects->split, result.objects->merged,
                      result.objects->missed);
  text += formatted("  %-30s %5s %11s %9s %11s %8s  %s\n", "", "runs", "mean ms", "+-99%", "median ms", "ratio",
                    "clusters");
  for (const BaselineResult& entry : result.baselines) {
    text += formatted("  %-30s ", entry.baseline->title.c_str());
    if (entry.times) {
      const double ratio = result.ratio(entry).value_or(kNan);
      const double confidence = entry.times->confidence99();
      text +=
          formatted("%5zu %11.3f %9s %11.3f ", entry.times->runs.size(), entry.times->mean(),
                    std::isfinite(confidence) ? formatted("%.3f", confidence).c_str() : "-", median(entry.times->runs));
      text += std::isfinite(ratio) ? formatted("%8.2f", ratio) : formatted("%8s", "-");
    } else {
      text += formatted("%5s %11s %9s %11s %8s", "-", "-", "-", "-", "-");
    }
    text += "  " + verdictOn(entry) + "\n";
  }
  for (const BaselineResult& entry : result.baselines)
    if (!entry.difference.details.empty())
      text += "  " + entry.baseline->title + ":\n    " +
              boost::replace_all_copy(boost::trim_right_copy(entry.difference.details), "\n", "\n    ") + "\n";
  return text;
}

std::string summaryOf(const std::vector<InputResult>& inputs, const CompareSettings& settings) {
  if (inputs.size() * settings.tolerances.size() < 2) return "";
  std::string text =
      formatted("\n%-32s %9s  %s\n%-32s %9s  %8s %8s %8s %10s\n", "all scans and tolerances", "identical",
                "times as fast as PCL, KdTree (false)", "", "", "mean", "lowest", "highest", "mean, cold");
  for (const Baseline& baseline : settings.baselines) {
    std::size_t cases = 0;
    std::size_t identical = 0;
    std::vector<double> ratios, cold;
    for (const InputResult& input : inputs)
      for (const CaseResult& result : input.cases) {
        const BaselineResult* const entry = result.find(baseline.key);
        if (entry == nullptr || !entry->failure.empty()) continue;
        ++cases;
        identical += entry->difference.identical ? 1 : 0;
        if (!result.ratio(*entry)) continue;
        ratios.push_back(*result.ratio(*entry));
        cold.push_back(*result.coldRatio(*entry));
      }
    text += formatted("%-32s %9s  ", baseline.title.c_str(), formatted("%zu/%zu", identical, cases).c_str());
    text += ratios.empty() ? formatted("%8s %8s %8s %10s\n", "-", "-", "-", "-")
                           : formatted("%8.2f %8.2f %8.2f %10.2f\n", geometricMean(ratios),
                                       *std::min_element(ratios.begin(), ratios.end()),
                                       *std::max_element(ratios.begin(), ratios.end()), geometricMean(cold));
  }
  if (settings.runs > 0) text += "mean: geometric; cold: of first runs, with caches displaced by the other baselines\n";
  return text;
}

std::string csvOf(const std::vector<InputResult>& inputs, const CompareSettings& settings) {
  std::string text =
      std::string(kCsvSignature) +
      ",min_size,reference_clusters,baseline,clusters,identical,mislabelled,runs,mean_ms,confidence99_ms,"
      "median_ms,cold_median_ms,min_ms,lower_quartile_ms,upper_quartile_ms,max_ms,ratio,objects,whole,"
      "split,merged,missed,failure\n";
  const auto number = [](double value) { return std::isfinite(value) ? formatted("%.6g", value) : std::string(); };
  for (const InputResult& input : inputs)
    for (const CaseResult& result : input.cases)
      for (const BaselineResult& entry : result.baselines) {
        text += "\"" + boost::replace_all_copy(input.name, "\"", "\"\"") + "\"" +
                formatted(",%zu,%zu,%zu,%s,%.10g,%u,%zu,%s", input.rows, input.columns, input.returns,
                          number(static_cast<double>(input.ground.height)).c_str(), result.tolerance, settings.min_size,
                          result.clusters, entry.baseline->key.c_str());
        text += entry.failure.empty()
                    ? formatted(",%zu,%s,%zu", entry.clusters, entry.difference.identical ? "yes" : "no",
                                entry.difference.mislabelled)
                    : ",,,";
        text += formatted(",%zu", entry.times ? entry.times->runs.size() : 0);
        const Times none{{kNan}, {kNan}};
        const Times& times = entry.times ? *entry.times : none;
        for (const double value :
             {times.mean(), times.confidence99(), median(times.runs), median(times.cold), times.min(),
              quantile(times.runs, 0.25), quantile(times.runs, 0.75), times.max(), result.ratio(entry).value_or(kNan)})
          text += "," + number(value);
        if (result.objects)
          text += formatted(",%zu,%zu,%zu,%zu,%zu", result.objects->objects, result.objects->whole,
                            result.objects->split, result.objects->merged, result.objects->missed);
        else
          text += ",,,,,";
        text += entry.failure.empty() ? ",\n" : ",\"" + entry.failure + "\"\n";
      }
  return text;
}

std::string jsonTextOf(const std::vector<InputResult>& inputs, const CompareSettings& settings,
                       const std::vector<std::string>& failures) {
  nlohmann::ordered_json json{{"program", "lisco_compare"},
                              {"version", LISCO_VERSION},
                              {"pcl_version", PCL_VERSION_PRETTY},
                              {"compiler", kCompiler},
                              {"build", kBuild},
                              {"processor", processor()},
                              {"hardware_threads", std::thread::hardware_concurrency()},
                              {"min_size", settings.min_size},
                              {"runs", settings.runs},
                              {"max_seconds", settings.max_seconds},
                              {"unorganized", settings.unorganized},
                              {"inputs", nlohmann::ordered_json::array()},
                              {"failures", failures}};
  for (const InputResult& input : inputs) {
    nlohmann::ordered_json cases = nlohmann::ordered_json::array();
    for (const CaseResult& result : input.cases) {
      nlohmann::ordered_json one{{"tolerance", result.tolerance}, {"clusters", result.clusters}};
      if (result.objects)
        one["objects"] = {{"count", result.objects->objects},
                          {"whole", result.objects->whole},
                          {"split", result.objects->split},
                          {"merged", result.objects->merged},
                          {"missed", result.objects->missed}};
      one["baselines"] = nlohmann::ordered_json::array();
      for (const BaselineResult& entry : result.baselines) one["baselines"].push_back(jsonOf(result, entry, settings));
      cases.push_back(std::move(one));
    }
    json["inputs"].push_back({{"name", input.name},
                              {"file", input.file},
                              {"rows", input.rows},
                              {"columns", input.columns},
                              {"returns", input.returns},
                              {"ground", input.left_out},
                              {"ground_method", groundTextOf(input.ground)},
                              {"ground_z", input.ground.height},
                              {"cases", std::move(cases)}});
  }
  // Replaces bytes of file names that are not UTF-8.
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lisco_apps
