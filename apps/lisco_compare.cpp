// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Clusters scans by PCL, Lisco and other baselines, side by side: compares the clusters, then the times.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <omp.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/program_options.hpp>

#include "compare/comparison.h"
#include "compare/report.h"
#include "drawing/chart.h"
#include "io/cloud_file.h"
#include "io/interruption.h"
#include "io/options.h"
#include "io/output_file.h"
#include "io/scan_options.h"
#include "io/scan_returns.h"
#include "io/terminal_line.h"
#include "io/text.h"
#include "recordings/scan_source.h"
#include "view/page.h"
#include "view/rows.h"
#include "view/scan_encoder.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

struct Options {
  std::vector<std::string> inputs;
  InputOptions input;
  CompareSettings settings;
  ScanOptions scan{"none", true};
  std::optional<unsigned> ignored_label;  ///< of returns that are left out
  fs::path json, csv, plot, view;
};

/// The baselines with these keys, in the order of allBaselines ().
std::vector<Baseline> baselinesNamed(const std::string& keys, const char* option) {
  std::vector<std::string> asked = itemsOf(keys);
  std::vector<Baseline> chosen;
  std::vector<std::string> known;
  for (Baseline& baseline : allBaselines()) {
    known.push_back(baseline.key);
    const auto found = std::find(asked.begin(), asked.end(), baseline.key);
    if (found == asked.end()) continue;
    asked.erase(std::remove(asked.begin(), asked.end(), baseline.key), asked.end());
    chosen.push_back(std::move(baseline));
  }
  if (!asked.empty())
    throw std::runtime_error(std::string(option) + ": there is no baseline '" + asked.front() + "'; known are " +
                             boost::join(known, ", "));
  return chosen;
}

/// \return false if --help or --version was given
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: lisco_compare INPUT... --tolerance M[,M...] [options]\n\n"
      "Clusters scans by PCL and by Lisco side by side, on the same returns: compares the clusters first, then the\n"
      "times. An input is a scan (.pcd .ply .bin .npy, the paper authors' .csv), a folder of scans, or a recording\n"
      "(.db3 .mcap .bag .pcap .pcapng) with a scan in each cloud or rotation, see lisco_cluster --help.\n"
      "Clusters are also scored against the true objects of scans with a field 'label' (uint32, as lisco_simulate\n"
      "writes it). An unorganized cloud with rings is arranged in rows first. Ctrl-C ends the program after the scan "
      "it\n"
      "has begun, with the summary and files of those that are done.\n\n"
      "Baselines: pcl (the reference: EuclideanClusterExtraction with KdTree (false)), pcl-tutorial (sorted KdTree),\n"
      "pcl-octree (resolution = tolerance), grid (a voxel grid), paper (Lisco as published, with PCL's comparison),\n"
      "lisco, and, shown without times, pcl-default (no search method given, which breaks on rotating scans).\n\n"
      "Exit code: 0 if the clusters of those that must agree are identical everywhere, 1 if not, otherwise 2 on bad\n"
      "input or usage.\n\n"
      "Options");
  CompareSettings& settings = options.settings;
  std::string tolerances;
  std::string baselines = "pcl,pcl-tutorial,pcl-octree,grid,paper,lisco";
  std::string must_agree = "lisco";
  bool check_only = false;
  bool no_details = false;
  // clang-format off
  shown.add_options()
    ("tolerance,t", po::value<std::string>(&tolerances)->value_name("M[,M...]"),
     "points nearer to each other than this many metres belong together")
    ("min-size", countOption("--min-size", settings.min_size, 1), "least returns of a cluster (default 10)")
    ;
  options.scan.addTo(shown);
  shown.add_options()
    ("runs", countOption("--runs", settings.runs, 1), "timed runs of each baseline (default 20)")
    ("max-seconds", numberOption("S", "--max-seconds", settings.max_seconds),
     "fewer runs, at least 3, for a baseline that would take longer than this for all of them (default 10)")
    ("check-only", po::bool_switch(&check_only), "compare the clusters only, without times")
    ("no-details", po::bool_switch(&no_details), "say how much differs, but do not look for the pairs that decide")
    ("baselines", po::value<std::string>(&baselines)->value_name("A,B,..."),
     "the methods to compare (default: all but pcl-default, flann and nanoflann, the last of which needs a build with "
     "libnanoflann-dev)")
    ("must-agree", po::value<std::string>(&must_agree)->value_name("A,B,..."),
     "those of them that must find PCL's clusters (default lisco)")
    ("ignore-label", textOption("N", [&options](const std::string& text) {
       options.ignored_label = countOf(text, "--ignore-label", 0);
     }),
     "leave out returns whose field 'label' is N, such as a table's")
    ("unorganized", po::bool_switch(&settings.unorganized), "cluster the returns as an unorganized cloud")
    ("json", pathOption("FILE", "--json", options.json), "write everything, each run's time included")
    ("csv", pathOption("FILE", "--csv", options.csv), "write a row per input, tolerance and baseline")
    ("plot", pathOption("DIR", "--plot", options.plot), "draw charts (PNG and SVG) into a folder; needs gnuplot")
    ("view", pathOption("FILE.html", "--view", options.view),
     "write a page for browsers that shows two methods' clusters, or those at two tolerances, side by side, and marks "
     "where they differ; of several scans, a timeline");
  // clang-format on
  options.input.addTo(shown);
  po::options_description hidden;
  hidden.add_options()("rivals", po::value<std::string>(&baselines));  // the former name of --baselines
  po::variables_map given;
  if (!readCommandLine(argc, argv, "lisco_compare", shown, &options.inputs, given, hidden)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  options.input.check();
  if (given.count("tolerance") == 0) throw std::runtime_error("--tolerance is missing; see --help");
  for (const std::string& item : itemsOf(tolerances)) settings.tolerances.push_back(toleranceOf(item));
  if (check_only) settings.runs = 0;
  settings.locate = !no_details;
  if (!(settings.max_seconds > 0)) throw std::runtime_error("--max-seconds must be positive");
  options.scan.check();
  settings.baselines = baselinesNamed(baselines, "--baselines");
  for (const Baseline& baseline : baselinesNamed(must_agree, "--must-agree")) {
    settings.must_agree.push_back(baseline.key);
    const auto is_it = [&baseline](const Baseline& other) { return other.key == baseline.key; };
    if (given.count("must-agree") != 0 && std::none_of(settings.baselines.begin(), settings.baselines.end(), is_it))
      throw std::runtime_error("--must-agree names " + baseline.key + ", which --baselines does not");
  }
  const auto are_one = [](const fs::path& a, const fs::path& b) {
    return !a.empty() && !b.empty() && fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal();
  };
  if (are_one(options.json, options.csv))
    throw std::runtime_error("--json and --csv are one file: " + options.json.string());
  if (are_one(options.view, options.json) || are_one(options.view, options.csv))
    throw std::runtime_error("--view and another option name one file: " + options.view.string());
  if (check_only && !options.plot.empty())
    throw std::runtime_error("--plot needs times, which --check-only leaves out");
  return true;
}

/// Compares one scan at all tolerances and prints the tables.
/// \param done, weight share of the work before this scan, and of this scan
/// \param views receives the scan for --view
InputResult compareScan(const ScanItem& item, const std::string& name, const Options& options, double done,
                        double weight, ProgressBar& progress, std::vector<std::string>& views) {
  const CompareSettings& settings = options.settings;
  const Scan read = item.read();
  InputResult input;
  input.name = name;
  input.file = item.file.string() + (item.folder.empty() ? "" : ": " + item.folder);
  input.ground = options.scan.ground.of(item.file.stem().string());
  // The rows of an arrangement show the ground; without it, the points stay in the order of the input.
  ScanReturns returns = returnsOf(*read.clustered(), input.ground, options.scan.region, item.of_packets);
  input.left_out = returns.ground.size();
  if (options.ignored_label) {
    const std::vector<std::uint32_t> object_of = read.objectsOfClustered();
    if (object_of.empty()) throw std::runtime_error(input.file + ": --ignore-label needs a field 'label'");
    auto& clustered = returns.clustered;
    const auto is_ignored = [&](auto index) {
      return object_of[static_cast<std::size_t>(index)] == options.ignored_label;
    };
    clustered.erase(std::remove_if(clustered.begin(), clustered.end(), is_ignored), clustered.end());
  }
  ComparedScan scan;
  try {
    if (settings.unorganized && read.arranged) {
      for (auto& index : returns.clustered) index = read.point_of_cell[static_cast<std::size_t>(index)];
      std::sort(returns.clustered.begin(), returns.clustered.end());
    }
    const Cloud& cloud = settings.unorganized ? *read.cloud : *read.clustered();
    scan = prepareScan(cloud, settings.unorganized ? read.object_of : read.objectsOfClustered(), returns.clustered,
                       settings.unorganized);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(input.file + ": " + error.what());
  }
  input.rows = scan.cloud->height;
  input.columns = scan.cloud->width;
  input.returns = scan.returns->size();
  progress.clear();
  std::fputs(headingOf(input, settings).c_str(), stdout);
  std::fputs(describe(returns, input.ground).c_str(), stdout);
  if (!settings.unorganized && read.arranged) std::printf("  %s\n", read.note.c_str());
  ViewScan view;
  if (!options.view.empty()) {
    view.name = name;
    for (const ComparedPoint& point : *scan.cloud) view.points.push_back({point.x, point.y, point.z});
    view.ring = rowsOf(scan.cloud->width, scan.cloud->height);
  }
  const double cases = static_cast<double>(settings.tolerances.size());
  for (const double tolerance : settings.tolerances) {
    const double cases_before = static_cast<double>(input.cases.size());
    input.cases.push_back(compareAt(
        scan, tolerance, settings,
        [&](const std::string& what, double share) {
          progress.show(done + weight * (cases_before + share) / cases,
                        formatted("%s at %g m: %s", name.c_str(), tolerance, what.c_str()));
        },
        [&](const Baseline& baseline, const Clusters& clusters) {
          if (options.view.empty()) return;
          const std::string labelling = formatted("%s, %g m", baseline.title.c_str(), tolerance);
          view.labellings.push_back({labelling, tolerance, labelsOf(clusters, view.points.size()), {}});
        }));
    progress.clear();
    std::fputs(tableOf(input.cases.back()).c_str(), stdout);
    std::fflush(stdout);
  }
  if (!view.labellings.empty()) views.push_back(encodeViewScan(view));
  return input;
}

/// Prints a line on stderr for each baseline that must agree with PCL and does not. \return whether all agree
bool checkAgreement(const std::vector<InputResult>& inputs, const CompareSettings& settings) {
  bool agree = true;
  for (const InputResult& input : inputs)
    for (const CaseResult& result : input.cases)
      for (const BaselineResult& entry : result.baselines) {
        if (!settings.mustAgree(*entry.baseline) || (entry.failure.empty() && entry.difference.identical)) continue;
        agree = false;
        std::fprintf(stderr, "lisco_compare: %s at %g m: the clusters of %s are not PCL's%s\n", input.file.c_str(),
                     result.tolerance, entry.baseline->title.c_str(),
                     entry.difference.missed_by_reference ? ": PCL's tree missed a pair" : "");
      }
  return agree;
}

int compare(const Options& options) {
  const CompareSettings& settings = options.settings;
  std::vector<std::string> failures;
  const auto report = [&failures](const std::string& failure) {
    std::fprintf(stderr, "lisco_compare: %s\n", failure.c_str());
    failures.push_back(failure);
  };
  Interruption::listen();
  ScanSource source(options.inputs, options.input, Interruption::happened);
  for (const std::string& failure : source.takeFailures()) report(failure);
  const std::vector<fs::path>& files = source.files();
  if (files.empty()) return 2;
  std::vector<std::string> names = namesOf(files);
  // Checked before the work.
  if (!options.json.empty()) checkMayWrite(options.json, kJsonSignature);
  if (!options.csv.empty()) checkMayWrite(options.csv, kCsvSignature);
  if (!options.view.empty()) checkMayWrite(options.view, kViewSignature);
  if (!options.plot.empty()) {
    checkGnuplot();
    checkMayWriteInto(options.plot, "lisco_compare", chartsOf(names, settings));
  }

  for (const std::string& line : options.scan.unknownNames(files))
    std::fprintf(stderr, "lisco_compare: %s\n", line.c_str());

  std::fputs(describeRun(settings).c_str(), stdout);
  std::fflush(stdout);
  std::vector<InputResult> results;
  std::vector<std::string> views;
  ProgressBar progress;
  source.onNote([&progress](const std::string& note) {
    progress.clear();
    std::fprintf(stderr, "lisco_compare: %s\n", note.c_str());
  });
  bool is_over = false;
  while (!Interruption::happened()) {
    const double share = source.share();
    const std::optional<ScanItem> item = source.next();
    is_over = !item;
    if (is_over) break;
    const double weight = item->folder.empty() ? 1 / static_cast<double>(files.size()) : 0;
    const std::string name = names[item->input] + (item->folder.empty() ? "" : "_" + item->folder);
    try {
      results.push_back(compareScan(*item, name, options, share, weight, progress, views));
    } catch (const std::exception& error) {
      progress.clear();
      report(error.what());
    }
  }
  if (Interruption::happened() && !is_over) report(formatted("interrupted after %zu scans", results.size()));
  progress.clear();
  if (results.empty()) return 2;
  std::fputs(summaryOf(results, settings).c_str(), stdout);
  std::fflush(stdout);
  const bool agree = checkAgreement(results, settings);

  if (!options.json.empty()) writeOwnFile(options.json, jsonTextOf(results, settings, failures), kJsonSignature);
  if (!options.csv.empty()) writeOwnFile(options.csv, csvOf(results, settings), kCsvSignature);
  if (!options.view.empty()) writeOwnFile(options.view, viewPage("Comparison", views), kViewSignature);
  names.clear();
  for (const InputResult& result : results) names.push_back(result.name);
  if (!options.plot.empty())
    writeOwnFolder(options.plot, "lisco_compare", chartsOf(names, settings),
                   [&](const fs::path& aside) { drawCharts(results, settings, aside); });
  if (!agree) return 1;
  return failures.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);  // threads of PCL's kd-tree would go on spinning while the others are timed
  return runProgram("lisco_compare", [&] {
    Options options;
    return parse(argc, argv, options) ? compare(options) : 0;
  });
}
