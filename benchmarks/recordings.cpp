// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Lisco, the voxel grid and PCL on clouds as users have them, or Lisco on several threads: seven sets, see
// recording_sets.h.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <omp.h>

#include "compare/comparison.h"
#include "compare/report.h"
#include "io/options.h"
#include "io/output_file.h"
#include "io/point_geometry.h"
#include "io/text.h"
#include "recording_sets.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;
using namespace lisco_benchmarks;

constexpr const char* kSignature = "\"program\": \"recordings\"";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSpells = 5;  ///< see timeInSpells ()

struct Options {
  fs::path data;
  std::set<int> sets;              ///< empty: all
  std::string cloud;               ///< part of the names to be measured
  std::vector<double> tolerances;  ///< empty: all
  unsigned runs = 9;
  unsigned pcl_runs = 1;        ///< 0: without PCL
  double max_pcl_seconds = 20;  ///< of a case, by the tolerance before
  unsigned threads = 1;         ///< more: their times are compared with those of one, and the grid's are not taken
  std::size_t min_returns = 0;
  bool summary = false;
  fs::path json;
};

/// One recording at one tolerance.
struct Result {
  int set = 0;
  std::string scan, form;
  double tolerance = 0;
  std::size_t returns = 0, clusters = 0;
  bool identical = true;
  double pcl_ms = kNan;  ///< NaN: not run
  Times rival, lisco;    ///< empty if not identical; the rival is the grid, or Lisco on one thread

  bool isTimed() const { return !lisco.runs.empty(); }
  double rivalMs() const { return isTimed() ? median(rival.runs) : kNan; }
  double liscoMs() const { return isTimed() ? median(lisco.runs) : kNan; }
  double rivalRatio() const { return rivalMs() / liscoMs(); }
  double pclRatio() const { return pcl_ms / liscoMs(); }
  std::string name() const { return formatted("%s, %s, %g m", scan.c_str(), form.c_str(), tolerance); }
};

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: recordings [options]\n\n"
      "Compares pcl::LiscoClusterExtraction with an exact voxel grid and PCL (KdTree (false)) on clouds as users have\n"
      "them, one thread, clusters of at least 10 returns, ground removed:\n"
      "  1  organized scans\n"
      "  2  unorganized in ring order and in firing order\n"
      "  3  shuffled, and voxel-filtered and cropped\n"
      "  4  moved into a vehicle's frame and into map coordinates (UTM, OSGB)\n"
      "  5  of a moving sensor, deskewed; over one turn; dual returns\n"
      "  6  RGB-D, airborne, from several stations, worst cases\n"
      "  7  organized with a column per laser; lasers unsorted; half of the returns missing; sensor tilted by 15\n"
      "     degrees; a sector; several turns in one cloud\n"
      "Clusters are compared first, then the grid and Lisco run in turn; medians, milliseconds. With --threads, Lisco "
      "on\none thread and on several in five spells of a quarter of a second each, of which the fastest counts.\n\n"
      "Exit code: 1 if any clusters differ, 2 on bad input or usage.\n\n"
      "Options");
  std::string sets, runs = "9", pcl_runs = "1", tolerances, max_seconds = "20", data, json;
  std::string threads = "1", min_returns = "0";
  bool no_pcl = false;
  const char* const folder = std::getenv("LISCO_TEST_DATA");
  data = folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT;
  // clang-format off
  shown.add_options()
    ("data", po::value<std::string>(&data)->value_name("FOLDER"),
     "real scans (default: $LISCO_TEST_DATA, or ../shared/data beside the project)")
    ("set", po::value<std::string>(&sets)->value_name("N[,N...]"), "only these sets")
    ("cloud", po::value<std::string>(&options.cloud)->value_name("TEXT"), "only clouds with this in 'scan, form'")
    ("eps", po::value<std::string>(&tolerances)->value_name("M[,M...]"), "only these tolerances of each set's")
    ("runs", po::value<std::string>(&runs)->value_name("N"), "timed runs of the grid and of Lisco (default 9)")
    ("pcl-runs", po::value<std::string>(&pcl_runs)->value_name("N"), "runs of PCL (default 1)")
    ("no-pcl", po::bool_switch(&no_pcl), "compare Lisco's clusters with the grid's only")
    ("max-pcl-seconds", po::value<std::string>(&max_seconds)->value_name("S"),
     "leave PCL out of cases that it is expected to take longer for, by the tolerance before (default 20)")
    ("threads", po::value<std::string>(&threads)->value_name("N"),
     "compare Lisco's times on N threads with those on one, not with the grid's; PCL does not run")
    ("min-returns", po::value<std::string>(&min_returns)->value_name("N"), "leave out clouds of fewer returns")
    ("summary", po::bool_switch(&options.summary), "print the sets only, not every case")
    ("json", po::value<std::string>(&json)->value_name("FILE"), "write all cases and their runs");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "recordings", shown, nullptr, given)) return false;
  options.data = data;
  if (given.count("set") != 0)
    for (const std::string& item : itemsOf(sets))
      options.sets.insert(static_cast<int>(countOf(item, "--set", 1, kSets)));
  if (given.count("eps") != 0)
    for (const std::string& item : itemsOf(tolerances)) options.tolerances.push_back(toleranceOf(item));
  options.runs = countOf(runs, "--runs", 1);
  options.threads = countOf(threads, "--threads", 1);
  options.min_returns = countOf(min_returns, "--min-returns", 0);
  options.pcl_runs = no_pcl || options.threads > 1 ? 0 : countOf(pcl_runs, "--pcl-runs", 1);
  options.max_pcl_seconds = numberOf(max_seconds, "--max-pcl-seconds");
  if (given.count("json") != 0 && json.empty()) throw std::runtime_error("--json is empty");
  options.json = json;
  return true;
}

/// What is measured, with the memory they keep from case to case.
struct Methods {
  Baseline pcl, grid, lisco;
  Baseline one_thread = liscoBaseline(1);

  /// \param threads of Lisco
  explicit Methods(unsigned threads) : lisco(liscoBaseline(threads)) {
    for (Baseline& baseline : allBaselines()) {
      if (baseline.key == "grid")
        grid = std::move(baseline);
      else if (baseline.key == kReferenceKey)
        pcl = std::move(baseline);
    }
  }
};

/// PCL's times over a recording's tolerances, to leave out those that would take too long: the neighbours on a surface
/// grow with the square of the tolerance.
class PclBudget {
 public:
  explicit PclBudget(double max_seconds) : max_ms_(1000 * max_seconds) {}

  bool allows(double tolerance) const { return expected_ms_ * tolerance * tolerance <= max_ms_; }
  void spend(double tolerance, double ms) { expected_ms_ = ms / (tolerance * tolerance); }

 private:
  double max_ms_;
  double expected_ms_ = 0;  ///< at a tolerance of 1 m
};

/// Says on stderr where two differ.
bool agree(const Result& result, const Problem& problem, const Baseline& reference, const Clusters& expected,
           const Baseline& baseline, const Clusters& found) {
  const Difference difference = differenceOf(problem, reference, expected, baseline, found);
  if (!difference.identical)
    std::fprintf(stderr, "%s: %s differs from %s\n%s", result.name().c_str(), baseline.title.c_str(),
                 reference.title.c_str(), difference.details.c_str());
  return difference.identical;
}

void measure(const Problem& problem, const Options& options, const Methods& methods, PclBudget& budget,
             Result& result) {
  Clusters by_lisco, by_grid;
  const double lisco_ms = runMs([&] { methods.lisco.extract(problem, by_lisco); });
  const double grid_ms = runMs([&] { methods.grid.extract(problem, by_grid); });
  result.clusters = by_grid.size();
  result.identical = agree(result, problem, methods.grid, by_grid, methods.lisco, by_lisco);
  if (options.pcl_runs > 0 && budget.allows(result.tolerance)) {
    std::vector<double> times;
    for (unsigned run = 0; run < options.pcl_runs; ++run) {
      Clusters by_pcl;
      times.push_back(runMs([&] { methods.pcl.extract(problem, by_pcl); }));
      if (run == 0)
        result.identical = agree(result, problem, methods.pcl, by_pcl, methods.lisco, by_lisco) && result.identical;
    }
    result.pcl_ms = median(times);
    budget.spend(result.tolerance, result.pcl_ms);
  }
  if (!result.identical) return;
  std::vector<Times> times;
  if (options.threads > 1)
    times = timeInSpells({runOf(methods.one_thread, problem), runOf(methods.lisco, problem)}, kSpells);
  else
    times = timeInTurn({{runOf(methods.grid, problem), grid_ms, options.runs},
                        {runOf(methods.lisco, problem), lisco_ms, options.runs}},
                       TimeKind::kThread, [](std::size_t, std::size_t) {});
  result.rival = times[0];
  result.lisco = times[1];
}

/// \param digits of the value
std::string orDash(int digits, double value) {
  return std::isfinite(value) ? formatted("%.*f", digits, value) : "-";
}

void printCase(const Result& result) {
  std::printf("%d %-20s %-28s %8zu %5.2f %8zu", result.set, result.scan.c_str(), result.form.c_str(), result.returns,
              result.tolerance, result.clusters);
  if (!result.identical)
    std::printf("  DIFFERENT clusters\n");
  else
    std::printf(" %9s %9.3f %9.3f %10.2f %10s\n", orDash(2, result.pcl_ms).c_str(), result.rivalMs(), result.liscoMs(),
                result.rivalRatio(), orDash(1, result.pclRatio()).c_str());
  std::fflush(stdout);
}

void measureRecording(const Recording& recording, const Options& options, const Methods& methods,
                      std::vector<Result>& results) {
  Problem problem;
  problem.cloud = recording.make();
  auto returns = std::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < problem.cloud->size(); ++i)
    if (isReturn((*problem.cloud)[i])) returns->push_back(static_cast<pcl::index_t>(i));
  problem.returns = returns;
  if (returns->size() < options.min_returns) return;
  PclBudget budget(options.max_pcl_seconds);
  for (const double tolerance : recording.tolerances) {
    const auto& wanted = options.tolerances;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), tolerance) == wanted.end()) continue;
    problem.tolerance = tolerance;
    Result result;
    result.set = recording.set;
    result.scan = recording.scan;
    result.form = recording.form;
    result.tolerance = tolerance;
    result.returns = returns->size();
    measure(problem, options, methods, budget, result);
    if (!options.summary) printCase(result);
    results.push_back(std::move(result));
  }
}

/// Geometric mean and lowest of the ratios of some cases.
class Ratios {
 public:
  void add(double ratio, const Result& result) {
    if (!std::isfinite(ratio)) return;
    if (values_.empty() || ratio < lowest()) lowest_ = &result;
    values_.push_back(ratio);
  }
  bool empty() const { return values_.empty(); }
  double mean() const { return geometricMean(values_); }
  double lowest() const { return *std::min_element(values_.begin(), values_.end()); }
  std::string lowestName() const { return lowest_->name(); }

 private:
  std::vector<double> values_;
  const Result* lowest_ = nullptr;
};

void printRatios(const std::string& name, const std::vector<const Result*>& cases) {
  Ratios rival, pcl;
  for (const Result* result : cases) {
    rival.add(result->rivalRatio(), *result);
    pcl.add(result->pclRatio(), *result);
  }
  if (rival.empty()) return;
  std::printf("%-32s %5zu %6.2f %6.2f", name.c_str(), cases.size(), rival.mean(), rival.lowest());
  if (pcl.empty())
    std::printf(" %7s %7s", "-", "-");
  else
    std::printf(" %7.1f %7.1f", pcl.mean(), pcl.lowest());
  std::printf("  %s%s\n", rival.lowestName().c_str(),
              !pcl.empty() && pcl.lowestName() != rival.lowestName() ? ("; PCL: " + pcl.lowestName()).c_str() : "");
}

/// The columns of the rival's times and the ratio to them.
struct RivalTitles {
  std::string time, ratio;

  explicit RivalTitles(unsigned threads)
      : time(threads > 1 ? "1 thread" : "grid"),
        ratio(threads > 1 ? formatted("1/%u threads", threads) : "grid/Lisco") {}
};

void printSets(const std::vector<Result>& results, const RivalTitles& titles) {
  std::printf("\n%-32s %5s %13s %15s\n", "", "", titles.ratio.c_str(), "PCL/Lisco");
  std::printf("%-32s %5s %6s %6s %7s %7s  %s\n", "set, form", "cases", "mean", "lowest", "mean", "lowest",
              "lowest case");
  for (int set = 1; set <= kSets; ++set) {
    std::vector<const Result*> of_set;
    std::vector<std::pair<std::string, std::vector<const Result*>>> forms;
    for (const Result& result : results) {
      if (result.set != set) continue;
      of_set.push_back(&result);
      auto form = std::find_if(forms.begin(), forms.end(), [&](const auto& f) { return f.first == result.form; });
      if (form == forms.end()) form = forms.insert(forms.end(), {result.form, {}});
      form->second.push_back(&result);
    }
    printRatios(formatted("%d %s", set, titleOf(set)), of_set);
    if (forms.size() > 1)
      for (const auto& [form, cases] : forms) printRatios("    " + form, cases);
  }
}

/// \param rival the name of the rival's times
std::string jsonTextOf(const std::vector<Result>& results, const char* rival) {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const Result& r : results) {
    nlohmann::ordered_json entry{{"set", r.set},
                                 {"scan", r.scan},
                                 {"form", r.form},
                                 {"tolerance", r.tolerance},
                                 {"returns", r.returns},
                                 {"clusters", r.clusters},
                                 {"identical", r.identical},
                                 {rival, r.rival.runs},
                                 {"lisco_ms", r.lisco.runs},
                                 {"lisco_cold_ms", r.lisco.cold}};
    if (std::isfinite(r.pcl_ms)) entry["pcl_ms"] = r.pcl_ms;
    cases.push_back(std::move(entry));
  }
  return nlohmann::ordered_json{{"program", "recordings"}, {"cases", std::move(cases)}}.dump(1) + "\n";
}

int run(const Options& options) {
  if (!options.json.empty()) checkMayWrite(options.json, kSignature);
  CompareSettings settings;
  settings.runs = 0;  // no line about runs, which do not depend on the time they take
  std::fputs(describeRun(settings, options.threads).c_str(), stdout);
  const RivalTitles titles(options.threads);
  if (options.threads > 1)
    std::printf("1 and %u threads: %zu spells of each in turn, medians of the fastest; milliseconds\n", options.threads,
                kSpells);
  else
    std::printf("grid and Lisco: %u runs in turn, medians; PCL: %u; milliseconds\n", options.runs, options.pcl_runs);
  if (!options.summary)
    std::printf("%-51s %8s %5s %8s %9s %9s %9s %10s %10s\n", "  scan                 form", "returns", "eps",
                "clusters", "PCL", titles.time.c_str(), "Lisco", titles.ratio.c_str(), "PCL/Lisco");
  const Methods methods(options.threads);
  std::vector<Result> results;
  for (const Recording& recording : allRecordings(options.data))
    if ((options.sets.empty() || options.sets.count(recording.set) != 0) &&
        recording.name().find(options.cloud) != std::string::npos)
      measureRecording(recording, options, methods, results);
  if (results.empty()) throw std::runtime_error("no case is left to measure");
  printSets(results, titles);
  if (!options.json.empty())
    writeOwnFile(options.json, jsonTextOf(results, options.threads > 1 ? "one_thread_ms" : "grid_ms"), kSignature);
  const auto wrong = std::count_if(results.begin(), results.end(), [](const Result& r) { return !r.identical; });
  std::printf("%zu cases, clusters identical in %zu\n", results.size(),
              results.size() - static_cast<std::size_t>(wrong));
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);  // as lisco_compare
  return runProgram("recordings", [&] {
    Options options;
    return parse(argc, argv, options) ? run(options) : 0;
  });
}
