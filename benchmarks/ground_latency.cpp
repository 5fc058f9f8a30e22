// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// How long a column takes where the ground is removed and the rest clustered while the sensor turns.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "column_periods.h"
#include "core/sorted_element.h"
#include "io/options.h"
#include "io/scan_file.h"
#include "io/text.h"
#include "lisco/column_clusterer.h"
#include "lisco/ground_filter.h"
#include "lisco/sensor_hints.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;
using Timer = std::chrono::steady_clock;
using Columns = std::vector<std::vector<lisco::Return>>;

Columns columnsOf(const Cloud& cloud) {
  Columns columns(cloud.width);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& point = cloud.points[i];
    columns[i % cloud.width].push_back({point.x, point.y, point.z, static_cast<std::uint32_t>(i)});
  }
  return columns;
}

/// Keeps each column's least time of several runs: the work is the same in each, and the machine may disturb one.
class LeastTimes {
 public:
  explicit LeastTimes(std::size_t columns) : times_(columns, std::numeric_limits<double>::infinity()) {}

  void add(std::size_t column, Timer::time_point begin) {
    const double time = std::chrono::duration<double, std::micro>(Timer::now() - begin).count();
    times_[column] = std::min(times_[column], time);
  }
  /// Time that a share of the columns does not exceed, microseconds.
  double quantile(double share) const {
    std::vector<double> sorted = times_;
    return lisco::sortedElement(sorted, static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1)));
  }

 private:
  std::vector<double> times_;
};

/// Feeds one rotation after the other to the filter, and what it leaves to the clusterer, if there is one.
void feed(const Columns& columns, std::size_t lasers, const lisco::GroundParameters& ground,
          const lisco::Parameters* clustering, unsigned runs, LeastTimes& times) {
  lisco::GroundFilter filter;
  lisco::ColumnClusterer clusterer;
  std::vector<lisco::Return> rest;
  for (unsigned run = 0; run <= runs; ++run) {
    filter.begin(ground, lasers);
    if (clustering != nullptr) clusterer.begin(*clustering);
    const auto decided = [&](std::size_t column, const std::uint8_t* is_ground, std::size_t count) {
      if (clustering == nullptr) return;
      rest = columns[column];
      for (std::size_t laser = 0; laser < count; ++laser)
        if (is_ground[laser] != 0) rest[laser] = lisco::kNoReturn;
      clusterer.addColumn(rest.data(), count);
    };
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Timer::time_point begin = Timer::now();
      filter.addColumn(columns[i].data(), columns[i].size(), decided);
      if (run > 0) times.add(i, begin);  // the first run reaches all memory
    }
    filter.finish(decided);
  }
}

void measure(const std::string& name, const Cloud& cloud, double period_us, double tolerance, unsigned runs) {
  const Columns columns = columnsOf(cloud);
  const auto cells = [&](std::size_t laser, std::size_t column) { return columns[column][laser]; };
  const auto ground = lisco::estimateGround(cloud.width, cloud.height, {0, 0, 0}, lisco::CellSource(cells));
  lisco::Parameters clustering;
  clustering.sensor = ground.sensor;
  clustering.tolerance = static_cast<float>(tolerance);
  clustering.expected_returns = cloud.size();
  LeastTimes alone(columns.size()), together(columns.size());
  feed(columns, cloud.height, ground, nullptr, runs, alone);
  feed(columns, cloud.height, ground, &clustering, runs, together);
  const double p99 = together.quantile(0.99);
  std::printf("%-20s %6zu %7.1f | %6.2f %6.2f %6.2f | %6.2f %6.2f %6.2f %5.0f%%\n", name.c_str(), columns.size(),
              period_us, alone.quantile(0.5), alone.quantile(0.99), alone.quantile(1), together.quantile(0.5), p99,
              together.quantile(1), 100 * p99 / period_us);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    double tolerance = 0.4;
    std::string runs = "10";
    std::vector<std::string> sensors;
    po::options_description shown(
        "Usage: ground_latency [OPTION]... SCAN...\n\n"
        "How long a column takes, one thread, if the ground is removed and the rest clustered while the sensor turns: "
        "microseconds of the ground filter alone, and of both; median, 99th percentile and most, each column's least "
        "time of the runs; and the 99th percentile in percent of the time T between two columns of the sensor");
    shown.add_options()("tolerance", numberOption("M", "--tolerance", tolerance), "of the clusters, metres")(
        "runs", po::value<std::string>(&runs)->value_name("N"), "times that each scan is fed (default 10)")(
        "sensor", po::value<std::vector<std::string>>(&sensors)->value_name("NAME=MODEL"),
        "what scans whose names begin so were recorded with: os1, or as lisco_stream's --sensor");
    std::vector<std::string> inputs;
    po::variables_map given;
    if (!readCommandLine(argc, argv, "ground_latency", shown, &inputs, given)) return 0;
    lisco_benchmarks::SensorNames names;
    for (const std::string& item : sensors) names.add(item);
    std::vector<std::string> failures;
    std::printf("%-20s %6s %7s | %20s | %27s\n", "scan", "", "T", "ground us", "ground and clusters us");
    std::printf("%-20s %6s %7s | %6s %6s %6s | %6s %6s %6s %6s\n", "", "columns", "us", "50%", "99%", "most", "50%",
                "99%", "most", "of T");
    for (const fs::path& file : expandInputs(inputs, failures)) {
      const std::string name = file.stem().string();
      measure(name, *readScan(file).cloud, lisco_benchmarks::columnPeriodOf(names.modelOf(name)), tolerance,
              countOf(runs, "--runs", 1));
    }
    for (const std::string& failure : failures) std::fprintf(stderr, "ground_latency: %s\n", failure.c_str());
    return failures.empty() ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ground_latency: %s\n", error.what());
    return 2;
  }
}
