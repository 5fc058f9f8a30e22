// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// How long a stream's user waits: for a column to be taken, for the clusters after the last one, for an endless
// stream's clusters, for the next window.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <omp.h>

#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <pcl/segmentation/lisco_cluster_writer.h>

#include "captured_rotations.h"
#include "column_periods.h"
#include "compare/comparison.h"
#include "compare/report.h"
#include "ground_heights.h"
#include "io/options.h"
#include "io/scan_file.h"
#include "io/text.h"
#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/sensor_hints.h"
#include "lisco/window_clusterer.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;
using lisco_benchmarks::readRotations;

using Timer = std::chrono::steady_clock;

double microsecondsSince(Timer::time_point begin) {
  return std::chrono::duration<double, std::micro>(Timer::now() - begin).count();
}

struct Options {
  std::vector<std::string> inputs;
  std::string table;
  std::vector<double> tolerances;
  unsigned min_size = 10;
  unsigned runs = 5;
  unsigned rotations = 3;  ///< of a capture
  PerInput<float> ground = groundHeights({});
  lisco_benchmarks::SensorNames sensors;
};

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: stream_latency SCAN-OR-CAPTURE... [options]\n\n"
      "How long a stream's user waits, one thread. Scans are fed column by column, captures (.pcap) rotation by "
      "rotation:\n"
      "  column    microseconds that a column takes: median, 99th percentile, most; and the 99th percentile in percent "
      "of "
      "the\n            time between two columns of the sensor\n"
      "  at speed  the same where columns come as the sensor fires and the thread sleeps in between\n"
      "  clusters  milliseconds from the last column to PCL's vector of clusters\n"
      "  pcl grid  milliseconds of the whole batch by PCL's KdTree (false) and by the voxel grid, and how many times "
      "the "
      "clusters'\n"
      "  endless   99th percentile of a column, microseconds; and milliseconds from the column that made sure that "
      "nothing\n            can reach a cluster any more to its delivery, columns coming as the sensor fires: median, "
      "99th, "
      "most\n"
      "or, with --table windows, milliseconds per window that slides on by a 4th, 8th, 16th and 32nd of a turn, and "
      "how "
      "many\ntimes that is faster than extracting the window's clusters anew,\n"
      "or, with --table timeline, when work is done while a sensor turns ten times a second, for timeline.gp.\n\n"
      "Exit code: 1 if any clusters are not those of EuclideanClusterExtraction, 2 on bad input or usage.\n\n"
      "Options");
  options.table = "columns";
  std::string tolerances = "0.4";
  std::string min_size = "10";
  std::string runs = "5";
  std::string rotations = "3";
  std::vector<std::string> ground;
  std::vector<std::string> sensors;
  // clang-format off
  shown.add_options()
    ("table", po::value<std::string>(&options.table)->value_name("NAME"),
     "columns (default), windows or timeline")
    ("tolerance,t", po::value<std::string>(&tolerances)->value_name("M[,M...]"), "metres (default 0.4)")
    ("min-size", po::value<std::string>(&min_size)->value_name("N"), "least returns of a cluster (default 10)")
    ("runs", po::value<std::string>(&runs)->value_name("N"), "times that each rotation is fed (default 5)")
    ("rotations", po::value<std::string>(&rotations)->value_name("N"), "whole rotations of each capture (default 3)")
    ("ground-z", po::value<std::vector<std::string>>(&ground)->value_name("M"),
     "leave out returns below this height in metres; NAME=M: of the input of this name only")
    ("sensor", po::value<std::vector<std::string>>(&sensors)->value_name("NAME=MODEL"),
     "what inputs whose names begin so were recorded with: os1, or as lisco_stream's --sensor");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "stream_latency", shown, &options.inputs, given)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  if (options.table != "columns" && options.table != "windows" && options.table != "timeline")
    throw std::runtime_error("--table must be columns, windows or timeline, not '" + options.table + "'");
  for (const std::string& item : itemsOf(tolerances)) options.tolerances.push_back(toleranceOf(item));
  options.min_size = countOf(min_size, "--min-size", 1);
  options.runs = countOf(runs, "--runs", 1);
  options.rotations = countOf(rotations, "--rotations", 1);
  options.ground = groundHeights(ground);
  for (const std::string& item : sensors) options.sensors.add(item);
  return true;
}

/// A rotation as its columns come.
struct Rotation {
  Problem problem;
  Clusters expected;  ///< PCL's
  std::size_t lasers = 0;
  std::vector<std::vector<lisco::Return>> columns;
};

Rotation makeRotation(const Cloud& cloud, float ground_z) {
  Rotation rotation;
  const ComparedScan scan = prepareScan(cloud, {}, returnsAbove(cloud, ground_z), false);
  rotation.problem.cloud = scan.cloud;
  rotation.problem.returns = scan.returns;
  rotation.lasers = scan.cloud->height;
  rotation.columns.resize(scan.cloud->width);
  for (std::size_t i = 0; i < scan.cloud->size(); ++i) {
    const ComparedPoint& point = scan.cloud->points[i];
    rotation.columns[i % scan.cloud->width].push_back({point.x, point.y, point.z, static_cast<std::uint32_t>(i)});
  }
  return rotation;
}

/// One input at one tolerance.
struct Case {
  std::string name;
  double period_us = 0;
  std::vector<Rotation> rotations;

  void setTolerance(double tolerance, unsigned min_size) {
    for (Rotation& rotation : rotations) {
      rotation.problem.tolerance = tolerance;
      rotation.problem.min_size = min_size;
      rotation.expected.clear();
      referenceBaseline().extract(rotation.problem, rotation.expected);
    }
  }
};

/// \return whether they are PCL's clusters; says on stderr where not
bool isRight(const Case& one, const Rotation& rotation, const std::string& whose, const Clusters& clusters) {
  Baseline baseline;
  baseline.title = whose;
  const Difference difference =
      differenceOf(rotation.problem, referenceBaseline(), rotation.expected, baseline, clusters);
  if (!difference.identical)
    std::fprintf(stderr, "%s at %g m: %s differs from PCL\n%s", one.name.c_str(), rotation.problem.tolerance,
                 whose.c_str(), difference.details.c_str());
  return difference.identical;
}

/// PCL's vectors from what clusterers found. Keeps its memory, as the classes for PCL do.
class Collector {
 public:
  /// \param width columns of the cloud that the clusters are of
  template <typename Clusterer>
  Clusters collect(Clusterer& clusterer, const Problem& problem, std::size_t width) {
    Clusters clusters;
    pcl::detail::LiscoClusterWriter writer(clusterer, problem.cloud->header, problem.min_size, problem.max_size,
                                           places_, clusters);
    const pcl::detail::LiscoRowMajorIndex point_at{width};
    clusterer.forEachRun(pcl::detail::LiscoRunAppender{writer, point_at}, writer.acceptedSizes());
    pcl::detail::sortLiscoClusters(clusters);
    return clusters;
  }

 private:
  pcl::detail::LiscoClusterPlaces places_;
};

/// Parameters for the next rotation.
lisco::Parameters parametersAfter(const Rotation& rotation) {
  const auto cell_at = [&](std::size_t laser, std::size_t column) { return rotation.columns[column][laser]; };
  lisco::Parameters parameters;
  parameters.sensor =
      lisco::estimateSensor(rotation.columns.size(), rotation.lasers, {0, 0, 0}, lisco::CellSource(cell_at));
  parameters.keep_source_indices = false;
  parameters.expected_returns = rotation.columns.size() * rotation.lasers;
  return parameters;
}

/// Clusters rotations column by column.
class RotationFeeder {
 public:
  /// Feeds a rotation, checks the clusters, and appends microseconds of each column and milliseconds of the end.
  /// \param period_us time between two columns, in which the thread sleeps; 0: they come back to back
  bool feed(const Rotation& rotation, std::vector<double>* columns, std::vector<double>* ends, const Case& one,
            double period_us = 0) {
    lisco::Parameters parameters = parametersAfter(rotation);
    parameters.tolerance = static_cast<float>(rotation.problem.tolerance);
    const Timer::time_point start = Timer::now();
    for (std::size_t i = 0; i < rotation.columns.size(); ++i) {
      const std::chrono::duration<double, std::micro> due(static_cast<double>(i) * period_us);
      if (period_us > 0) std::this_thread::sleep_until(start + std::chrono::duration_cast<Timer::duration>(due));
      const Timer::time_point begin = Timer::now();
      if (i == 0) clusterer_.begin(parameters);
      clusterer_.addColumn(rotation.columns[i].data(), rotation.columns[i].size());
      const double time = microsecondsSince(begin);
      if (columns != nullptr) columns->push_back(time);
    }
    const Timer::time_point begin = Timer::now();
    clusterer_.update();
    const Clusters clusters = collector_.collect(clusterer_, rotation.problem, rotation.columns.size());
    const double time = microsecondsSince(begin);
    if (ends != nullptr) ends->push_back(time / 1000);
    return isRight(one, rotation, "Lisco, column by column,", clusters);
  }

 private:
  lisco::ColumnClusterer clusterer_;
  Collector collector_;
};

class ColumnsTable {
 public:
  static void printTitles() {
    std::printf("%-20s %5s %7s | %-30s | %-30s | clusters %9s %7s %8s %7s | endless us %6s %22s\n", "scan", "eps",
                "columns", "column us", "at speed us", "pcl", "ratio", "grid", "ratio", "", "ms");
    std::printf("%-20s %5s %7s | %7s %7s %7s %6s | %7s %7s %7s %6s | %8s %9s %7s %8s %7s | %10s %6s %6s %6s\n", "", "m",
                "", "50%", "99%", "most", "of T", "50%", "99%", "most", "of T", "ms", "ms", "", "ms", "", "99%", "50%",
                "99%", "most");
  }

  bool measure(const Case& one, unsigned runs) {
    std::vector<double> columns, paced, ends, pcls, grids;
    const std::vector<Baseline> baselines = allBaselines();
    const auto grid = std::find_if(baselines.begin(), baselines.end(),
                                   [](const Baseline& baseline) { return baseline.key == "grid"; });
    const Baseline pcl = referenceBaseline();
    RotationFeeder feeder;
    for (unsigned run = 0; run <= runs; ++run)  // the first is not timed
      for (const Rotation& rotation : one.rotations) {
        if (!feeder.feed(rotation, run > 0 ? &columns : nullptr, run > 0 ? &ends : nullptr, one)) return false;
        if (run > 0 && !feeder.feed(rotation, &paced, nullptr, one, one.period_us)) return false;
        const auto timeOf = [&](const Baseline& baseline) { return runMs(runOf(baseline, rotation.problem)); };
        if (run == 0) continue;
        grids.push_back(timeOf(*grid));
        if (run <= 2) pcls.push_back(timeOf(pcl));
      }
    std::vector<double> endless_columns, deliveries;
    if (!feedEndlessly(one, runs, endless_columns, deliveries)) return false;

    const double p99 = quantile(columns, 0.99);
    const double paced_p99 = quantile(paced, 0.99);
    const double end = median(ends);
    std::printf(
        "%-20s %5.2f %7zu | %7.2f %7.2f %7.1f %5.0f%% | %7.2f %7.2f %7.1f %5.0f%% | %8.3f %9.2f %7.1f %8.3f %7.1f | "
        "%10.2f %6.2f %6.2f %6.2f\n",
        one.name.c_str(), one.rotations.front().problem.tolerance, one.rotations.front().columns.size(),
        median(columns), p99, *std::max_element(columns.begin(), columns.end()), 100 * p99 / one.period_us,
        median(paced), paced_p99, *std::max_element(paced.begin(), paced.end()), 100 * paced_p99 / one.period_us, end,
        median(pcls), median(pcls) / end, median(grids), median(grids) / end, quantile(endless_columns, 0.99),
        median(deliveries), quantile(deliveries, 0.99), *std::max_element(deliveries.begin(), deliveries.end()));
    pcl_ratios_.push_back(median(pcls) / end);
    grid_ratios_.push_back(median(grids) / end);
    shares_.push_back(p99 / one.period_us);
    longest_ = std::max(longest_, longestOf(columns, runs));
    paced_shares_.push_back(paced_p99 / one.period_us);
    return true;
  }

  void printEnd() const {
    if (shares_.empty()) return;
    std::printf("99%% of the columns take at most %.0f%% of the time between two; at the sensor's speed %.0f%%\n",
                100 * *std::max_element(shares_.begin(), shares_.end()),
                100 * *std::max_element(paced_shares_.begin(), paced_shares_.end()));
    std::printf("each column's least time of all runs is at most %.1f us: what is longer is the system's\n", longest_);
    const auto print = [](const char* whose, const std::vector<double>& ratios) {
      std::printf(
          "%s's batch takes %.0f times as long as from the last column to the clusters (geometric mean; least %.1f)\n",
          whose, geometricMean(ratios), *std::min_element(ratios.begin(), ratios.end()));
    };
    print("PCL", pcl_ratios_);
    print("the grid", grid_ratios_);
  }

 private:
  /// The most that any column took in its fastest run, microseconds: what the system adds differs from run to run.
  /// \param times of the columns of all rotations, run by run
  static double longestOf(const std::vector<double>& times, unsigned runs) {
    const std::size_t columns = times.size() / runs;
    double longest = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      double least = times[column];
      for (std::size_t i = column; i < times.size(); i += columns) least = std::min(least, times[i]);
      longest = std::max(longest, least);
    }
    return longest;
  }

  /// Feeds the rotations again and again without an end, in virtual time: a column comes when the sensor fires it, or
  /// when the one before has been taken.
  static bool feedEndlessly(const Case& one, unsigned runs, std::vector<double>& columns,
                            std::vector<double>& deliveries) {
    const Rotation& first = one.rotations.front();
    const lisco::SensorHints sensor = parametersAfter(first).sensor;
    lisco::EndlessParameters parameters;
    parameters.tolerance = static_cast<float>(first.problem.tolerance);
    parameters.min_size = first.problem.min_size;
    parameters.clockwise = sensor.clockwise;
    const double per_turn =
        sensor.steps_per_turn > 0 ? sensor.steps_per_turn : static_cast<double>(first.columns.size());
    parameters.start_azimuth = startAzimuthOf(first, parameters.clockwise, per_turn);
    std::vector<double> came;  // when the columns of each position did, microseconds
    double now = 0;            // the time when the column at hand is taken
    Timer::time_point taken;
    std::size_t before = 0;  // columns of the rotations before
    const auto turnsOf = [&](std::size_t column) { return static_cast<double>(column) / per_turn; };
    std::size_t delivered = 0;
    std::uint64_t returns = 0;
    bool measured = false;
    lisco::EndlessClusterer clusterer;
    clusterer.begin(parameters, [&](const lisco::EndlessCluster& cluster) {
      delivered += cluster.size();
      if (!measured || cluster.isCut()) return;
      const auto column = static_cast<std::size_t>(std::ceil(cluster.reachEnd() * per_turn));
      if (column >= came.size()) return;
      deliveries.push_back((now + microsecondsSince(taken) - came[column]) / 1000);
    });
    for (unsigned run = 0; run <= runs; ++run) {
      measured = run > 0;
      const Rotation& rotation = one.rotations[run % one.rotations.size()];
      // A rotation may hold a little less or more than a turn.
      const std::size_t count = std::min(rotation.columns.size(), static_cast<std::size_t>(std::lround(per_turn)));
      for (std::size_t i = 0; i < count; ++i) {
        const double comes = static_cast<double>(before + i) * one.period_us;
        came.push_back(comes);
        now = std::max(now, comes);
        taken = Timer::now();
        clusterer.addColumn(rotation.columns[i].data(), rotation.columns[i].size(), turnsOf(before + i));
        const double time = microsecondsSince(taken);
        now += time;
        if (measured) columns.push_back(time);
        for (const lisco::Return& cell : rotation.columns[i])
          returns += lisco::isReturn(cell.x, cell.y, cell.z) ? 1 : 0;
      }
      before += count;
    }
    measured = false;
    clusterer.finish();
    if (clusterer.returnCount() == returns && delivered <= returns && !deliveries.empty()) return true;
    std::fprintf(stderr, "%s: of %zu returns, %zu were taken and %zu delivered\n", one.name.c_str(),
                 static_cast<std::size_t>(returns), static_cast<std::size_t>(clusterer.returnCount()), delivered);
    return false;
  }

  /// The azimuth of the first column, from all.
  static double startAzimuthOf(const Rotation& rotation, bool clockwise, double per_turn) {
    double east = 0;
    double north = 0;
    for (std::size_t column = 0; column < rotation.columns.size(); ++column)
      for (const lisco::Return& cell : rotation.columns[column]) {
        if (!lisco::isReturn(cell.x, cell.y, cell.z)) continue;
        const double turned = 2 * M_PI * static_cast<double>(column) / per_turn * (clockwise ? -1 : 1);
        const double azimuth = std::atan2(static_cast<double>(cell.y), static_cast<double>(cell.x)) - turned;
        east += std::cos(azimuth);
        north += std::sin(azimuth);
      }
    return std::atan2(north, east);
  }

  std::vector<double> shares_, paced_shares_, pcl_ratios_, grid_ratios_;
  double longest_ = 0;  ///< see longestOf ()
};

/// Who works when, in milliseconds since the first turn began, for two turns.
class TimelineTable {
 public:
  static void printTitles() { std::printf("# lane, begin and end in ms, share of that time at work\n"); }

  bool measure(const Case& one, unsigned runs) {
    const Rotation& rotation = one.rotations.front();
    RotationFeeder feeder;
    std::vector<std::vector<double>> runs_of_column(rotation.columns.size());
    std::vector<double> ends;
    for (unsigned run = 0; run < runs; ++run) {
      std::vector<double> columns;
      if (!feeder.feed(rotation, &columns, &ends, one)) return false;
      for (std::size_t i = 0; i < columns.size(); ++i) runs_of_column[i].push_back(columns[i]);
    }
    std::array<double, kTurnMs> work{};  // microseconds of each millisecond of the turn
    for (std::size_t i = 0; i < runs_of_column.size(); ++i)
      work[i * kTurnMs / runs_of_column.size()] += median(runs_of_column[i]);
    for (std::size_t turn = 0; turn < 2; ++turn) {
      for (std::size_t ms = 0; ms < kTurnMs; ++ms)
        print("Lisco", static_cast<double>(turn * kTurnMs + ms), 1, work[ms] / 1000);
      print("Lisco", static_cast<double>((turn + 1) * kTurnMs), median(ends), 1);
    }
    for (const Baseline& baseline : allBaselines()) {
      if (baseline.key != kReferenceKey && baseline.key != "grid") continue;
      std::vector<double> times;
      for (unsigned run = 0; run < runs; ++run) times.push_back(runMs(runOf(baseline, rotation.problem)));
      double free_from = 0;
      for (std::size_t turn = 1; turn <= 2; ++turn) {
        const double begin = std::max(free_from, static_cast<double>(turn * kTurnMs));
        print(baseline.key.c_str(), begin, median(times), 1);
        free_from = begin + median(times);
      }
    }
    return true;
  }

  void printEnd() const {}

 private:
  static constexpr std::size_t kTurnMs = 100;

  static void print(const char* lane, double begin, double time, double share) {
    std::printf("%s %.3f %.3f %.4f\n", lane, begin, begin + time, share);
  }
};

class WindowsTable {
 public:
  static void printTitles() {
    std::printf("%-20s %5s %8s", "scan", "eps", "anew ms");
    for (const std::size_t part : kParts) std::printf(" | 1/%-2zu ms %7s", part, "ratio");
    std::printf("\n");
  }

  bool measure(const Case& one, unsigned runs) {
    const Rotation& rotation = one.rotations.front();
    std::string row;
    std::vector<double> anew_all;
    for (std::size_t k = 0; k < kParts.size(); ++k) {
      const std::size_t hop = rotation.columns.size() / kParts[k];
      lisco::WindowClusterer clusterer;
      Collector collector;
      clusterer.begin({static_cast<float>(rotation.problem.tolerance), hop * kParts[k], hop, rotation.lasers});
      pcl::LiscoClusterExtraction<ComparedPoint> extraction;
      std::vector<double> hops, anew;
      std::size_t column = 0;
      for (unsigned window = 0; window < (runs + 1) * kParts[k]; ++window) {
        double time = 0;
        Clusters clusters;
        const auto width = hop * kParts[k];
        for (std::size_t i = 0; i < hop; ++i, ++column) {
          const auto& cells = rotation.columns[column % width];
          const Timer::time_point begin = Timer::now();
          const bool ends = clusterer.addColumn(cells.data(), cells.size());
          if (ends) clusters = collector.collect(clusterer, rotation.problem, clusterer.columnCount());
          time += microsecondsSince(begin) / 1000;
        }
        if (window < kParts[k]) continue;
        hops.push_back(time);
        const ComparedCloud::Ptr cloud = windowOf(rotation, column - width, width);
        Clusters expected;
        anew.push_back(runMs([&] {
          extraction.setInputCloud(cloud);
          extraction.setClusterTolerance(rotation.problem.tolerance);
          extraction.setMinClusterSize(rotation.problem.min_size);
          extraction.extract(expected);
        }));
        if (!same(expected, clusters)) {
          std::fprintf(stderr, "%s at %g m: a window's clusters are not those extracted from it\n", one.name.c_str(),
                       rotation.problem.tolerance);
          return false;
        }
      }
      const double ratio = median(anew) / median(hops);
      ratios_[k].push_back(ratio);
      row += formatted(" | %7.3f %7.2f", median(hops), ratio);
      anew_all.push_back(median(anew));
    }
    std::printf("%-20s %5.2f %8.3f%s\n", one.name.c_str(), rotation.problem.tolerance, median(anew_all), row.c_str());
    return true;
  }

  void printEnd() const {
    if (ratios_[0].empty()) return;
    std::printf("%-35s", "geometric mean");
    for (const auto& ratios : ratios_) std::printf(" | %7s %7.2f", "", geometricMean(ratios));
    std::printf("\n");
  }

 private:
  static constexpr std::array<std::size_t, 4> kParts{4, 8, 16, 32};

  /// The cloud of the columns of a window, which begins somewhere in the rotation and goes on around it.
  static ComparedCloud::Ptr windowOf(const Rotation& rotation, std::size_t first, std::size_t width) {
    const auto cloud =
        std::make_shared<ComparedCloud>(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(rotation.lasers));
    cloud->is_dense = false;
    for (std::size_t laser = 0; laser < rotation.lasers; ++laser)
      for (std::size_t i = 0; i < width; ++i) {
        const lisco::Return& cell = rotation.columns[(first + i) % width][laser];
        ComparedPoint& point = cloud->points[laser * width + i];
        point.x = cell.x;
        point.y = cell.y;
        point.z = cell.z;
      }
    return cloud;
  }

  static bool same(const Clusters& a, const Clusters& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& one, const auto& other) { return one.indices == other.indices; });
  }

  std::array<std::vector<double>, kParts.size()> ratios_;
};

template <typename Table>
int run(const Options& options, Table table) {
  std::vector<fs::path> files(options.inputs.begin(), options.inputs.end());
  const std::vector<std::string> names = namesOf(files);
  CompareSettings unlimited;
  unlimited.runs = 0;
  if (options.table != "timeline") std::fputs(describeRun(unlimited).c_str(), stdout);
  table.printTitles();
  bool good = true;
  std::vector<std::string> failures;
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      Case one;
      one.name = names[i];
      const float ground_z = options.ground.of(files[i].stem().string());
      const std::string model = options.sensors.modelOf(one.name);
      one.period_us = lisco_benchmarks::columnPeriodOf(model);
      if (files[i].extension() == ".pcap") {
        for (const Cloud::Ptr& cloud : readRotations(files[i], model, options.rotations))
          one.rotations.push_back(makeRotation(*cloud, ground_z));
      } else {
        one.rotations.push_back(makeRotation(*readScan(files[i]).cloud, ground_z));
      }
      for (const double tolerance : options.tolerances) {
        one.setTolerance(tolerance, options.min_size);
        if (!table.measure(one, options.runs)) {
          std::printf("%-20s %5.2f NOT the right clusters\n", one.name.c_str(), tolerance);
          good = false;
        }
        std::fflush(stdout);
      }
    } catch (const std::exception& error) {
      failures.emplace_back(error.what());
    }
  }
  table.printEnd();
  std::fflush(stdout);
  for (const std::string& failure : failures) std::fprintf(stderr, "stream_latency: %s\n", failure.c_str());
  return !good ? 1 : failures.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  return runProgram("stream_latency", [&] {
    Options options;
    if (!parse(argc, argv, options)) return 0;
    if (options.table == "windows") return run(options, WindowsTable());
    return options.table == "timeline" ? run(options, TimelineTable()) : run(options, ColumnsTable());
  });
}
