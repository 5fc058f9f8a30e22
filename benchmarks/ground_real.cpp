// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The ground filter on real scans: what it removes, what it leaves, what it takes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "ground_picture.h"
#include "ground_quality.h"
#include "io/cloud_file.h"
#include "io/options.h"
#include "lisco/ground_filter.h"
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

struct Filtered {
  std::vector<std::uint8_t> ground;
  double ns_per_cell;  ///< least of five runs
};

Filtered filterCloud(const Cloud& cloud, lisco::GroundParameters parameters) {
  Filtered filtered{std::vector<std::uint8_t>(cloud.size()), std::numeric_limits<double>::infinity()};
  const pcl::PointXYZ* const points = cloud.points.data();
  const std::size_t width = cloud.width;
  const auto cells = [points, width](std::size_t laser, std::size_t first, std::size_t count,
                                     const lisco::CellSource::Destination& to) {
    const pcl::PointXYZ* const from = points + laser * width + first;
    for (std::size_t i = 0; i < count; ++i) {
      to.x[i] = from[i].x;
      to.y[i] = from[i].y;
      to.z[i] = from[i].z;
      to.source_index[i] = 0;
    }
  };
  lisco::GroundFilter filter;
  for (int run = 0; run < 5; ++run) {
    const double begin = threadSeconds();
    const std::array<float, 3> origin{cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2]};
    auto estimated = lisco::estimateGround(cloud.width, cloud.height, origin, lisco::CellSource(cells));
    if (!std::isnan(parameters.sensor_height)) estimated.sensor_height = parameters.sensor_height;
    filter.filter(estimated, cloud.width, cloud.height, cells, filtered.ground.data());
    filtered.ns_per_cell =
        std::min(filtered.ns_per_cell, 1e9 * (threadSeconds() - begin) / static_cast<double>(cloud.size()));
  }
  return filtered;
}

/// \return whether the scan was measured
bool measure(const fs::path& file, double tolerance, double height_threshold, const lisco::GroundParameters& parameters,
             const std::string& pictures, double radius) {
  const auto cloud = readCloudFile(file);
  Filtered filtered = filterCloud(*cloud, parameters);
  if (!std::isnan(height_threshold))
    for (std::size_t i = 0; i < cloud->size(); ++i)
      filtered.ground[i] = static_cast<double>(cloud->points[i].z) < height_threshold;
  const std::vector<float> local = localGround(*cloud);
  std::vector<std::int32_t> labels;
  std::vector<std::uint8_t> flat;
  const GroundQuality quality = measureGround(*cloud, filtered.ground, local, tolerance, labels, flat);
  const auto percent = [](std::size_t part, std::size_t of) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(1, of));
  };
  std::printf("%-22s %8zu %8.1f %9.3f %9zu %6zu %9zu %8.1f\n", file.stem().c_str(), quality.returns,
              percent(quality.removed, quality.returns), percent(quality.lost, quality.elevated), quality.clusters,
              quality.flat, quality.clusters - quality.flat, filtered.ns_per_cell);
  if (!pictures.empty())
    drawGround(*cloud, filtered.ground, local, labels, flat, radius,
               fs::path(pictures) / (file.stem().string() + ".png"));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    double tolerance = 0.4, height = std::numeric_limits<double>::quiet_NaN(), threshold = height, radius = 50;
    fs::path pictures;
    po::options_description shown("ground_real [OPTION]... INPUT...");
    shown.add_options()("tolerance", numberOption("M", "--tolerance", tolerance), "of the clusters, metres")(
        "sensor-height", numberOption("M", "--sensor-height", height), "instead of an estimate, metres")(
        "threshold", numberOption("M", "--threshold", threshold), "remove all below this height instead")(
        "radius", numberOption("M", "--radius", radius), "of the pictures, metres")(
        "pictures", pathOption("DIR", "--pictures", pictures), "draw a picture of each scan here");
    std::vector<std::string> inputs;
    po::variables_map given;
    if (!readCommandLine(argc, argv, "ground_real", shown, &inputs, given)) return 0;
    std::vector<std::string> failures;
    lisco::GroundParameters parameters;
    parameters.sensor_height = static_cast<float>(height);
    std::printf("%-22s %8s %8s %9s %9s %6s %9s %8s\n", "scan", "returns", "ground", "lost", "clusters", "flat",
                "not flat", "time");
    std::printf("%-22s %8s %8s %9s %9s %6s %9s %8s\n", "", "", "%", "% > 0.5 m", "", "", "", "ns/cell");
    for (const fs::path& file : expandInputs(inputs, failures))
      measure(file, tolerance, threshold, parameters, pictures, radius);
    for (const std::string& failure : failures) std::fprintf(stderr, "ground_real: %s\n", failure.c_str());
    return failures.empty() ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ground_real: %s\n", error.what());
    return 2;
  }
}
