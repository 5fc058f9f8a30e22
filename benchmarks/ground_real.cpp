// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The ground filter on real scans: what it removes, what it leaves, what it takes.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "ground_picture.h"
#include "ground_quality.h"
#include "io/options.h"
#include "io/point_geometry.h"
#include "io/scan_file.h"
#include "io/text.h"
#include "lisco/ground_filter.h"
#include "lisco/label_ground.h"
#include "lisco/sensor_hints.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;
using namespace lisco_benchmarks;

double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

constexpr int kRuns = 100;
constexpr int kRunsTogether = 5;  ///< before a pause: disturbances last up to a tenth of a second

struct Filtered {
  std::vector<std::uint8_t> ground;
  double ns_per_cell;  ///< least of kRuns
};

Filtered filterCloud(const Cloud& cloud, lisco::GroundParameters parameters) {
  Filtered filtered{std::vector<std::uint8_t>(cloud.size()), std::numeric_limits<double>::infinity()};
  const pcl::PointXYZ* const points = cloud.points.data();
  const std::size_t width = cloud.width;
  const auto cells = [points, width](std::size_t laser, std::size_t column) {
    const pcl::PointXYZ& point = points[laser * width + column];
    return lisco::Return{point.x, point.y, point.z, 0};
  };
  lisco::GroundFilter filter;
  for (int run = 0; run < kRuns; ++run) {
    if (run % kRunsTogether == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (cloud.height == 1) {
      const double begin = threadSeconds();
      lisco::LabelGroundParameters unorganized;
      unorganized.sensor_height = parameters.sensor_height;
      lisco::labelGround(points, cloud.size(), sizeof *points, unorganized, filtered.ground.data());
      filtered.ns_per_cell =
          std::min(filtered.ns_per_cell, 1e9 * (threadSeconds() - begin) / static_cast<double>(cloud.size()));
      continue;
    }
    const double begin = threadSeconds();
    const std::array<float, 3> origin{cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2]};
    parameters.sensor = lisco::estimateSensor(cloud.width, cloud.height, origin, lisco::CellSource(cells));
    filter.filterScan(parameters, cloud.width, cloud.height, cells, filtered.ground.data());
    filtered.ns_per_cell =
        std::min(filtered.ns_per_cell, 1e9 * (threadSeconds() - begin) / static_cast<double>(cloud.size()));
  }
  return filtered;
}

struct Settings {
  double tolerance = 0.4, radius = 50;
  double threshold = std::numeric_limits<double>::quiet_NaN(), above_ground = threshold;  ///< NaN: the filter decides
  lisco::GroundParameters parameters;
  fs::path pictures;
};

void measure(const std::string& name, const Cloud& cloud, const Settings& settings) {
  Filtered filtered = filterCloud(cloud, settings.parameters);
  if (!std::isnan(settings.threshold))
    for (std::size_t i = 0; i < cloud.size(); ++i)
      filtered.ground[i] = static_cast<double>(cloud.points[i].z) < settings.threshold;
  const std::vector<float> local = localGround(cloud);
  if (!std::isnan(settings.above_ground))
    for (std::size_t i = 0; i < cloud.size(); ++i)
      filtered.ground[i] = static_cast<double>(cloud.points[i].z - local[i]) < settings.above_ground;
  std::vector<std::int32_t> labels;
  std::vector<std::uint8_t> flat;
  const GroundQuality quality = measureGround(cloud, filtered.ground, local, settings.tolerance, labels, flat);
  const auto percent = [](std::size_t part, std::size_t of) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(1, of));
  };
  std::printf("%-30s %8zu %8.1f %9.3f %9zu %6zu %9zu %8.1f\n", name.c_str(), quality.returns,
              percent(quality.removed, quality.returns), percent(quality.lost, quality.elevated), quality.clusters,
              quality.flat, quality.clusters - quality.flat, filtered.ns_per_cell);
  if (!settings.pictures.empty())
    drawGround(cloud, filtered.ground, local, labels, flat, settings.radius, settings.pictures / (name + ".png"));
}

/// A copy, each point of which `change` may move.
template <typename Change>
Cloud changed(const Cloud& cloud, Change&& change) {
  Cloud copy(cloud);
  for (auto& point : copy)
    if (isReturn(point)) change(point);
  return copy;
}

/// Every `row_step`-th row and `column_step`-th column.
Cloud thinned(const Cloud& cloud, std::uint32_t row_step, std::uint32_t column_step) {
  Cloud copy(cloud.width / column_step, cloud.height / row_step);
  for (std::uint32_t row = 0; row < copy.height; ++row)
    for (std::uint32_t column = 0; column < copy.width; ++column)
      copy.at(column, row) = cloud.at(column * column_step, row * row_step);
  return copy;
}

/// The scan as users may have it: tilted, moved, mirrored, with fewer lasers or columns, unorganized.
void measureForms(const std::string& name, const Cloud& cloud, const Settings& settings) {
  constexpr double kTilt = 4.0 * kPi / 180.0;
  const auto cosine = static_cast<float>(std::cos(kTilt)), sine = static_cast<float>(std::sin(kTilt));
  measure(name + ", tilted by 4 deg",
          changed(cloud,
                  [=](pcl::PointXYZ& point) {
                    const float x = point.x;
                    point.x = cosine * x + sine * point.z;
                    point.z = cosine * point.z - sine * x;
                  }),
          settings);
  measure(name + ", 2 m higher", changed(cloud, [](pcl::PointXYZ& point) { point.z += 2.0F; }), settings);
  measure(name + ", mirrored", changed(cloud, [](pcl::PointXYZ& point) { point.y = -point.y; }), settings);
  for (const std::uint32_t lasers : {32U, 16U})
    if (cloud.height > lasers)
      measure(name + formatted(", %u lasers", lasers), thinned(cloud, cloud.height / lasers, 1), settings);
  measure(name + ", half the columns", thinned(cloud, 1, 2), settings);
  Cloud shuffled(cloud);
  std::mt19937 random(1);
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  shuffled.width = static_cast<std::uint32_t>(shuffled.size());
  shuffled.height = 1;
  measure(name + ", shuffled", shuffled, settings);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Settings settings;
    double height = std::numeric_limits<double>::quiet_NaN();
    po::options_description shown(
        "Usage: ground_real [OPTION]... SCAN...\n\n"
        "Removes the ground of real scans, and prints the share of the returns that is removed, the share of the "
        "returns "
        "more than 0.5 m above the local ground that is lost, the clusters of 10 returns and more of the rest, those "
        "of "
        "them that are flat (lower than 0.15 m, longer than 1 m), and the time on one thread, estimates included");
    shown.add_options()("tolerance", numberOption("M", "--tolerance", settings.tolerance), "of the clusters, metres")(
        "sensor-height", numberOption("M", "--sensor-height", height), "instead of an estimate, metres")(
        "threshold", numberOption("M", "--threshold", settings.threshold), "remove all below this height instead")(
        "above-ground", numberOption("M", "--above-ground", settings.above_ground),
        "remove all up to this height above the local ground instead")(
        "forms", "also tilted, moved, mirrored, thinned and shuffled copies")(
        "radius", numberOption("M", "--radius", settings.radius), "of the pictures, metres")(
        "pictures", pathOption("DIR", "--pictures", settings.pictures), "draw a picture of each scan here");
    std::vector<std::string> inputs;
    po::variables_map given;
    if (!readCommandLine(argc, argv, "ground_real", shown, &inputs, given)) return 0;
    settings.parameters.sensor_height = static_cast<float>(height);
    std::vector<std::string> failures;
    std::printf("%-30s %8s %8s %9s %9s %6s %9s %8s\n", "scan", "returns", "ground", "lost", "clusters", "flat",
                "not flat", "time");
    std::printf("%-30s %8s %8s %9s %9s %6s %9s %8s\n", "", "", "%", "%", "", "", "", "ns/cell");
    for (const fs::path& file : expandInputs(inputs, failures)) {
      const auto cloud = readScan(file).cloud;
      measure(file.stem().string(), *cloud, settings);
      if (given.count("forms") > 0) measureForms(file.stem().string(), *cloud, settings);
    }
    for (const std::string& failure : failures) std::fprintf(stderr, "ground_real: %s\n", failure.c_str());
    return failures.empty() ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ground_real: %s\n", error.what());
    return 2;
  }
}
