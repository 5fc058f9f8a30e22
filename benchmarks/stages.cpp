// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Where an extraction's time goes: what each stage takes, and what vector instructions and threads save.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <omp.h>

#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <pcl/segmentation/lisco_cluster_writer.h>

#include "compare/comparison.h"
#include "compare/report.h"
#include "ground_heights.h"
#include "io/options.h"
#include "io/output_file.h"
#include "io/scan_file.h"
#include "io/text.h"
#include "lisco/column_clusterer.h"
#include "lisco/sensor_hints.h"
#include "lisco/simd.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;

constexpr const char* kSignature = "input,rows,columns,returns,ground_z,tolerance,min_size,clusters,stage,level";

enum Stage : std::size_t { kSensor, kRead, kUpdate, kOutput, kFree, kStages };
constexpr std::array<const char*, kStages> kStageNames{"sensor", "read", "update", "output", "free"};

/// pcl::LiscoClusterExtraction::extract () of a whole cloud by the engine's own calls, each of them timed.
class StagedExtraction {
 public:
  void extract(const Problem& problem, Clusters& clusters) {
    const ComparedCloud& cloud = *problem.cloud;
    const std::size_t lasers = std::max<std::size_t>(1, cloud.height);
    const std::size_t columns = cloud.size() / lasers;
    const std::array<float, 3> sensor{cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2]};
    const ComparedPoint* const points = cloud.points.data();
    const auto cell_at = [points, columns](std::size_t laser, std::size_t column) {
      const std::size_t point = laser * columns + column;
      return lisco::Return{points[point].x, points[point].y, points[point].z, static_cast<std::uint32_t>(point)};
    };

    latest_ = Clock::now();
    lisco::Parameters parameters;
    parameters.sensor = lisco::estimateSensor(columns, lasers, sensor, lisco::CellSource(cell_at));
    parameters.keep_source_indices = false;
    parameters.expected_returns = columns * lasers;
    finish(kSensor);
    parameters.tolerance = static_cast<float>(problem.tolerance);
    clusterer_.begin(parameters);
    clusterer_.addColumns(columns, lasers, cell_at);
    finish(kRead);
    clusterer_.update();
    finish(kUpdate);
    collect(problem, clusters);
    pcl::detail::sortLiscoClusters(clusters);
    finish(kOutput);
  }

  /// Milliseconds of each stage of one extraction.
  std::array<double, kStages> time(const Problem& problem) {
    {
      Clusters clusters;
      extract(problem, clusters);
    }
    finish(kFree);
    return times_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void finish(Stage stage) {
    const Clock::time_point now = Clock::now();
    times_[stage] = std::chrono::duration<double, std::milli>(now - latest_).count();
    latest_ = now;
  }

  /// As LiscoCloudClusterer::collect () does it.
  void collect(const Problem& problem, Clusters& clusters) {
    pcl::detail::LiscoClusterWriter writer(clusterer_, problem.cloud->header, problem.min_size, problem.max_size,
                                           places_, clusters);
    const pcl::detail::LiscoRowMajorIndex point_at{problem.cloud->width};
    clusterer_.forEachRun(pcl::detail::LiscoRunAppender{writer, point_at}, writer.acceptedSizes());
  }

  lisco::ColumnClusterer clusterer_;
  pcl::detail::LiscoClusterPlaces places_;
  Clock::time_point latest_;
  std::array<double, kStages> times_{};
};

/// The whole extraction at a level of vector instructions ("": the best) with so many threads.
Baseline variantOf(const std::string& level, unsigned threads) {
  Baseline baseline = liscoBaseline(threads);
  baseline.key = level + "," + std::to_string(threads);
  baseline.title = level + " with " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
  baseline.extract = [extract = baseline.extract, level](const Problem& problem, Clusters& clusters) {
    lisco::useSimdLevel(level);
    extract(problem, clusters);
  };
  return baseline;
}

struct Options {
  std::vector<std::string> inputs;
  bool threads = false;  ///< the tables of levels and threads, not that of the stages
  std::vector<double> tolerances;
  unsigned min_size = 10;
  unsigned runs = 20;
  PerInput<float> ground = groundHeights({});
  fs::path csv;
};

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: engine_stages SCAN-OR-FOLDER... [options]\n\n"
      "Where the time of pcl::LiscoClusterExtraction goes. One thread, best vector instructions, milliseconds:\n"
      "  sensor   estimating the sensor's position and steps from about a hundred cells\n"
      "  read     making room, reading all columns, and linking what all lasers have passed\n"
      "  update   linking the rest: last columns, seam, near returns; numbering the subclusters\n"
      "  output   writing and sorting PCL's clusters\n"
      "  free     giving back their memory\n"
      "  sum      of these\n"
      "  extract  the whole call of extract (), memory given back\n"
      "or, with --table threads, extract () with each level of vector instructions that the processor has, and with 1, "
      "2\nand all threads.\n"
      "They run in turn. Each runs twice in its turn, of which the second run counts, and +- is half the distance of "
      "the\nquartiles in percent of the median. Numbers of threads run in a spell of a quarter of a second for "
      "every\nfour runs; the fastest spell counts.\n\n"
      "Exit code: 1 if any clusters are not those of EuclideanClusterExtraction, 2 on bad input or usage (1 goes "
      "before 2).\n\n"
      "Options");
  std::string table = "stages";
  std::string tolerances = "0.4";
  std::string min_size = "10";
  std::string runs = "20";
  std::vector<std::string> ground;
  std::string csv;
  // clang-format off
  shown.add_options()
    ("table", po::value<std::string>(&table)->value_name("NAME"), "stages (default) or threads")
    ("tolerance,t", po::value<std::string>(&tolerances)->value_name("M[,M...]"), "metres (default 0.4)")
    ("min-size", po::value<std::string>(&min_size)->value_name("N"), "least returns of a cluster (default 10)")
    ("runs", po::value<std::string>(&runs)->value_name("N"), "timed runs of each (default 20)")
    ("ground-z", po::value<std::vector<std::string>>(&ground)->value_name("M"),
     "leave out returns below this height in metres; NAME=M: of the input of this name only")
    ("csv", po::value<std::string>(&csv)->value_name("FILE"), "write a row per input, tolerance and what was timed");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "engine_stages", shown, &options.inputs, given)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  if (table != "stages" && table != "threads")
    throw std::runtime_error("--table must be stages or threads, not '" + table + "'");
  options.threads = table == "threads";
  for (const std::string& item : itemsOf(tolerances)) options.tolerances.push_back(toleranceOf(item));
  options.min_size = countOf(min_size, "--min-size", 1);
  options.runs = countOf(runs, "--runs", 1);
  options.ground = groundHeights(ground);
  if (given.count("csv") != 0 && csv.empty()) throw std::runtime_error("--csv is empty");
  options.csv = csv;
  return true;
}

/// "   1.234   5%": median and half the distance of the quartiles.
std::string timed(const std::vector<double>& runs) {
  const double middle = median(runs);
  return formatted(" %8.3f %3.0f%%", middle, 50 * (quantile(runs, 0.75) - quantile(runs, 0.25)) / middle);
}

/// What both tables have in common: an input at a tolerance.
struct Case {
  std::string name;
  float ground_z = 0;
  Problem problem;
  Clusters expected;

  std::string head() const {
    return formatted("%-20s %8zu %5.2f %8zu", name.c_str(), problem.returns->size(), problem.tolerance,
                     expected.size());
  }
  static std::string titles() { return formatted("%-20s %8s %5s %8s", "scan", "returns", "eps", "clusters"); }

  /// Whether a baseline finds PCL's clusters; says on stderr where it does not.
  bool agrees(const Baseline& baseline) const {
    Clusters found;
    baseline.extract(problem, found);
    const Difference difference = differenceOf(problem, referenceBaseline(), expected, baseline, found);
    if (!difference.identical)
      std::fprintf(stderr, "%s at %g m: %s differs from PCL\n%s", name.c_str(), problem.tolerance,
                   baseline.title.c_str(), difference.details.c_str());
    return difference.identical;
  }

  std::string csv(const std::string& stage, const std::string& level, unsigned threads,
                  const std::vector<double>& runs) const {
    return formatted("\"%s\",%u,%u,%zu,%g,%g,%u,%zu,%s,%s,%u,%zu,%.6g,%.6g,%.6g,%.6g\n", name.c_str(),
                     problem.cloud->height, problem.cloud->width, problem.returns->size(),
                     static_cast<double>(ground_z), problem.tolerance, problem.min_size, expected.size(), stage.c_str(),
                     level.c_str(), threads, runs.size(), median(runs), *std::min_element(runs.begin(), runs.end()),
                     quantile(runs, 0.25), quantile(runs, 0.75));
  }
};

/// One of the program's tables, or two that are measured together.
class Table {
 public:
  virtual ~Table() = default;
  virtual void printTitles() = 0;
  /// Prints the row of a case. \return false, and nothing is timed, if any clusters are not PCL's
  virtual bool measure(const Case& one, unsigned runs, std::string& csv) = 0;
  virtual void printEnd() = 0;
};

class StagesTable : public Table {
 public:
  StagesTable() : best_(lisco::simdLevels().front()), whole_(variantOf(best_, 1)) {}

  void printTitles() override {
    std::printf("one thread, %s; milliseconds, +- in percent\n%s", best_.c_str(), Case::titles().c_str());
    for (const char* stage : kStageNames) std::printf(" %8s   +-", stage);
    std::printf(" %8s   +- %8s   +-\n", "sum", "extract");
  }

  bool measure(const Case& one, unsigned runs, std::string& csv) override {
    Baseline staged;
    staged.key = staged.title = "stages";
    staged.extract = [this](const Problem& problem, Clusters& clusters) { stages_.extract(problem, clusters); };
    // Both, even if the first is wrong.
    const bool whole_agrees = one.agrees(whole_);
    if (!one.agrees(staged) || !whole_agrees) return false;

    std::array<std::vector<double>, kStages> times;
    std::vector<double> sums, wholes;
    for (unsigned run = 0; run < runs; ++run) {
      stages_.time(one.problem);  // the other's run has displaced its memory from the caches
      const std::array<double, kStages> now = stages_.time(one.problem);
      double sum = 0;
      for (std::size_t stage = 0; stage < kStages; ++stage) {
        times[stage].push_back(now[stage]);
        sum += now[stage];
      }
      sums.push_back(sum);
      const auto extract = runOf(whole_, one.problem);
      extract();
      wholes.push_back(runMs(extract));
    }

    std::string row = one.head();
    for (std::size_t stage = 0; stage < kStages; ++stage) {
      row += timed(times[stage]);
      shares_[stage] += median(times[stage]) / median(sums);
      csv += one.csv(kStageNames[stage], best_, 1, times[stage]);
    }
    ++cases_;
    csv += one.csv("sum", best_, 1, sums) + one.csv("extract", best_, 1, wholes);
    std::printf("%s\n", (row + timed(sums) + timed(wholes)).c_str());
    return true;
  }

  void printEnd() override {
    if (cases_ == 0) return;
    std::printf("%-44s", formatted("mean share of the sum in %zu cases", cases_).c_str());
    for (const double share : shares_) std::printf("%13.1f%%", 100 * share / static_cast<double>(cases_));
    std::printf("\n");
  }

 private:
  std::string best_;
  Baseline whole_;
  StagedExtraction stages_;
  std::array<double, kStages> shares_{};
  std::size_t cases_ = 0;
};

/// The rows of the levels are printed as they come, those of the threads below them all.
class ThreadsTable : public Table {
 public:
  explicit ThreadsTable(const std::vector<unsigned>& threads) : levels_(lisco::simdLevels()) {
    for (const std::string& level : levels_) add(level, 1);
    for (const unsigned count : threads)
      if (count > 1) add(levels_.front(), count);
  }

  void printTitles() override {
    std::printf("one thread; milliseconds, +- in percent, ratio to %s\n%s", levels_.front().c_str(),
                Case::titles().c_str());
    for (std::size_t i = 0; i < levels_.size(); ++i)
      std::printf(" %8s   +-%s", levels_[i].c_str(), i == 0 ? "" : "  ratio");
    std::printf("\n");
  }

  bool measure(const Case& one, unsigned runs, std::string& csv) override {
    bool agree = true;
    for (const Variant& variant : variants_) agree = one.agrees(variant.baseline) && agree;
    if (!agree) return false;

    measureLevels(one, runs, csv);
    measureThreads(one, (runs + kRunsOfSpell - 1) / kRunsOfSpell, csv);
    return true;
  }

  void printEnd() override {
    if (thread_rows_.empty()) return;
    printMeans(false);
    std::printf(
        "\n%s; milliseconds, +- in percent, ratio of one thread to more; paused: after a pause of 20 ms\n"
        "%s %8s   +-   paused",
        levels_.front().c_str(), Case::titles().c_str(), "1 thread");
    for (const Variant& variant : variants_)
      if (variant.threads > 1)
        std::printf(" %8s   +-  ratio   paused  ratio", formatted("%u thr.", variant.threads).c_str());
    std::printf("\n%s", thread_rows_.c_str());
    printMeans(true);
  }

 private:
  struct Variant {
    std::string level;
    unsigned threads = 1;
    Baseline baseline{};
    std::vector<double> ratios{};         ///< of each case, to the first variant
    std::vector<double> paused_ratios{};  ///< the same after a pause
  };

  void measureLevels(const Case& one, unsigned runs, std::string& csv) {
    std::vector<Contestant> contestants;
    for (std::size_t i = 0; i < levels_.size(); ++i)
      contestants.push_back({runOf(variants_[i].baseline, one.problem), 0, runs});
    const std::vector<Times> times = timeInTurn(contestants, TimeKind::kWall, [](std::size_t, std::size_t) {});
    const double best = median(times.front().runs);
    std::string row = one.head();
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      csv += one.csv("extract", variants_[i].level, 1, times[i].runs);
      row += timed(times[i].runs);
      if (i == 0) continue;
      variants_[i].ratios.push_back(median(times[i].runs) / best);
      row += formatted(" %6.2f", variants_[i].ratios.back());
    }
    std::printf("%s\n", row.c_str());
  }

  void measureThreads(const Case& one, std::size_t spells, std::string& csv) {
    std::vector<std::function<void()>> contestants{runOf(variants_.front().baseline, one.problem)};
    for (std::size_t i = levels_.size(); i < variants_.size(); ++i)
      contestants.push_back(runOf(variants_[i].baseline, one.problem));
    const std::vector<Times> times = timeInSpells(contestants, spells);
    const Times& alone = times.front();
    csv += one.csv("threads", levels_.front(), 1, alone.runs);
    thread_rows_ += one.head() + timed(alone.runs) + formatted(" %8.3f", median(alone.cold));
    for (std::size_t i = 1; i < times.size(); ++i) {
      Variant& variant = variants_[levels_.size() + i - 1];
      csv += one.csv("threads", variant.level, variant.threads, times[i].runs);
      variant.ratios.push_back(median(alone.runs) / median(times[i].runs));
      variant.paused_ratios.push_back(median(alone.cold) / median(times[i].cold));
      thread_rows_ += timed(times[i].runs) + formatted(" %6.2f %8.3f %6.2f", variant.ratios.back(),
                                                       median(times[i].cold), variant.paused_ratios.back());
    }
    thread_rows_ += "\n";
  }

  void add(const std::string& level, unsigned threads) {
    variants_.push_back({level, threads, variantOf(level, threads)});
  }

  void printMeans(bool of_threads) const {
    const std::size_t cases = variants_.back().ratios.size();
    std::printf("%-*s", of_threads ? 67 : 58, formatted("geometric mean of %zu cases", cases).c_str());
    for (const Variant& variant : variants_) {
      if (&variant == &variants_.front() || (variant.threads > 1) != of_threads) continue;
      std::printf("%21.2f", geometricMean(variant.ratios));
      if (of_threads) std::printf("%16.2f", geometricMean(variant.paused_ratios));
    }
    std::printf("\n");
  }

  static constexpr unsigned kRunsOfSpell = 4;  ///< of the levels, for each spell of the threads

  std::vector<std::string> levels_;
  std::vector<Variant> variants_;  ///< one thread at each level, the best first; then more threads at that one
  std::string thread_rows_;
};

/// \return false if any clusters are not PCL's
bool measureFile(const fs::path& file, const std::string& name, const Options& options, Table& table,
                 std::string& csv) {
  Case one;
  one.name = name;
  one.ground_z = options.ground.of(file.stem().string());
  const Cloud::Ptr cloud = readScan(file).cloud;
  ComparedScan scan;
  try {
    scan = prepareScan(*cloud, {}, returnsAbove(*cloud, one.ground_z), false);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  one.problem.cloud = scan.cloud;
  one.problem.returns = scan.returns;
  one.problem.min_size = options.min_size;
  bool good = true;
  for (const double tolerance : options.tolerances) {
    one.problem.tolerance = tolerance;
    one.expected.clear();
    referenceBaseline().extract(one.problem, one.expected);
    if (!table.measure(one, options.runs, csv)) {
      std::printf("%s  NOT PCL's clusters\n", one.head().c_str());
      good = false;
    }
    std::fflush(stdout);
  }
  return good;
}

int run(const Options& options) {
  std::vector<std::string> failures;
  const std::vector<fs::path> files = expandInputs(options.inputs, failures);
  const std::vector<std::string> names = namesOf(files);
  if (!options.csv.empty()) checkMayWrite(options.csv, kSignature);
  std::string csv = std::string(kSignature) + ",threads,runs,median_ms,min_ms,lower_quartile_ms,upper_quartile_ms\n";

  std::vector<unsigned> threads{1};
  if (options.threads) threads.push_back(2);
  const auto all = static_cast<unsigned>(std::thread::hardware_concurrency());
  if (options.threads && all > 2) threads.push_back(all);
  std::unique_ptr<Table> table;
  if (options.threads)
    table = std::make_unique<ThreadsTable>(threads);
  else
    table = std::make_unique<StagesTable>();

  CompareSettings unlimited;
  unlimited.runs = 0;  // no line about runs, which are not fewer where they take long
  std::fputs(describeRun(unlimited, threads.back()).c_str(), stdout);
  std::printf("%u run%s of each in turn; all clusters are those of PCL unless a row says otherwise\n", options.runs,
              options.runs == 1 ? "" : "s");
  table->printTitles();
  bool good = true;
  std::size_t measured = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      good = measureFile(files[i], names[i], options, *table, csv) && good;
      ++measured;
    } catch (const std::exception& error) {
      failures.emplace_back(error.what());
    }
  }
  lisco::useSimdLevel("");
  table->printEnd();
  std::fflush(stdout);
  for (const std::string& failure : failures) std::fprintf(stderr, "engine_stages: %s\n", failure.c_str());
  if (measured > 0 && !options.csv.empty()) writeOwnFile(options.csv, csv, kSignature);
  if (!good) {
    std::fprintf(stderr, "engine_stages: wrong clusters\n");
    return 1;
  }
  return failures.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);  // as lisco_compare; the engine asks for its threads itself
  return runProgram("engine_stages", [&] {
    Options options;
    return parse(argc, argv, options) ? run(options) : 0;
  });
}
