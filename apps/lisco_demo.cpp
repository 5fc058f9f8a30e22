// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The main job on a scan that is built in: a simulated street, clustered by PCL and by Lisco side by side, and
// pictures.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <pcl/io/pcd_io.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "clustering.h"
#include "lisco/version.h"
#include "result_files.h"
#include "simulated_street.h"

namespace {

using namespace lisco_apps;
using Point = pcl::PointXYZ;

/// Clusters of a few runs of an extraction, all the same, and the median time.
template <typename Extraction>
double medianMilliseconds(Extraction& extraction, std::vector<pcl::PointIndices>& clusters) {
  std::vector<double> times;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    clusters.clear();
    extraction.extract(clusters);
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

bool same(const std::vector<pcl::PointIndices>& a, const std::vector<pcl::PointIndices>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return x.indices == y.indices; });
}

int run(const std::string& folder) {
  constexpr double kTolerance = 0.4;
  constexpr unsigned kMinSize = 10;
  ClusteredScan scan;
  scan.name = "simulated street";
  scan.tolerance = kTolerance;
  scan.cloud = simulateStreet(1);
  scan.clustered = returnsAbove(*scan.cloud, kStreetZ + 0.15F);
  const auto indices = std::make_shared<const pcl::Indices>(scan.clustered);

  pcl::EuclideanClusterExtraction<Point> by_pcl;
  by_pcl.setSearchMethod(std::make_shared<pcl::search::KdTree<Point>>(false));
  pcl::LiscoClusterExtraction<Point> by_lisco;
  const auto prepare = [&](auto& extraction) {
    extraction.setInputCloud(scan.cloud);
    extraction.setIndices(indices);
    extraction.setClusterTolerance(kTolerance);
    extraction.setMinClusterSize(kMinSize);
  };
  prepare(by_pcl);
  prepare(by_lisco);

  std::vector<pcl::PointIndices> pcl_clusters;
  const double pcl_ms = medianMilliseconds(by_pcl, pcl_clusters);
  const double lisco_ms = medianMilliseconds(by_lisco, scan.clusters);
  const bool identical = same(pcl_clusters, scan.clusters);

  const std::filesystem::path scan_file = std::filesystem::path(folder) / "scan.pcd";
  if (std::filesystem::exists(scan_file) && !isResultFolder(folder))
    throw std::runtime_error(scan_file.string() +
                             ": exists and was not written by this program; choose another folder");
  writeResults(scan, folder, false);
  if (pcl::PCDWriter().writeBinary(scan_file.string(), *scan.cloud) != 0)
    throw std::runtime_error(scan_file.string() + ": cannot be written");
  std::printf("simulated street: 64 lasers x 1800 columns, %zu returns above the ground, tolerance %g m\n",
              scan.clustered.size(), kTolerance);
  std::printf("  PCL    %5zu clusters  %8.2f ms\n", pcl_clusters.size(), pcl_ms);
  std::printf("  Lisco  %5zu clusters  %8.2f ms  %.0f times as fast\n", scan.clusters.size(), lisco_ms,
              pcl_ms / lisco_ms);
  std::printf("  the clusters are %s\n", identical ? "identical" : "NOT IDENTICAL");
  std::printf("  written to %s: scan.pcd labels.pcd clusters.csv range_image.png top_view.png\n", folder.c_str());
  return identical ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string argument = argc == 2 ? argv[1] : "";
    if (argument == "--version") {
      std::cout << "lisco_demo " << LISCO_VERSION << '\n';
      return 0;
    }
    const bool asked = argument == "--help";
    if (asked || argument.empty() || argument[0] == '-') {
      (asked ? std::cout : std::cerr) << "Usage: lisco_demo FOLDER-FOR-RESULTS\n";
      return asked ? 0 : 2;
    }
    return run(argument);
  } catch (const std::exception& error) {
    std::cerr << "lisco_demo: " << error.what() << '\n';
    return 2;
  }
}
