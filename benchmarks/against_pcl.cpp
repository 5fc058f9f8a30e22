// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// How much faster than PCL, on real scans: whole extract () calls, from a cloud to clusters. The answers are
// compared before anything is timed, then the two run in turn, and medians and their ratio are printed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <omp.h>

#include <pcl/common/io.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <boost/program_options.hpp>

#include "cloud_file.h"
#include "lisco/version.h"

namespace {

using Point = pcl::PointXYZI;
using Clusters = std::vector<pcl::PointIndices>;
using lisco_apps::Cloud;

/// The scan with ground and no-returns taken out in place, so that it stays organized.
pcl::PointCloud<Point>::Ptr withoutGround(const Cloud& cloud, float ground_z) {
  auto above = std::make_shared<pcl::PointCloud<Point>>();
  pcl::copyPointCloud(cloud, *above);
  for (auto& point : *above)
    if (!(point.z >= ground_z)) point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
  return above;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Milliseconds of the two runs of a rival's turn. The second counts: the first brings the rival's memory
/// back, which the other has displaced from the caches (and, on virtual machines, its pages from the host's
/// attention), and makes the allocator tidy up what the other has left behind.
struct Turn {
  double first, second;
};

template <typename Run>
Turn timed(Run&& run) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  run();
  const auto middle = Clock::now();
  run();
  const auto end = Clock::now();
  return {std::chrono::duration<double, std::milli>(middle - start).count(),
          std::chrono::duration<double, std::milli>(end - middle).count()};
}

bool same(const Clusters& a, const Clusters& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const pcl::PointIndices& x, const pcl::PointIndices& y) {
           return x.indices == y.indices && x.header.frame_id == y.header.frame_id && x.header.seq == y.header.seq &&
                  x.header.stamp == y.header.stamp;
         });
}

int run(const std::vector<std::string>& inputs, const std::map<std::string, float>& ground,
        const std::vector<double>& tolerances, int runs, bool unorganized) {
  std::printf("lisco %s, compiler %s, %u threads on this machine, %d runs each in turn, medians\n", LISCO_VERSION,
              __VERSION__, std::thread::hardware_concurrency(), runs);
  std::printf("%-22s %9s %5s %9s %10s %10s %8s  %s\n", "scan", "returns", "eps", "clusters", "PCL ms", "Lisco ms",
              "ratio", "identical");
  double log_sum = 0;
  double first_log_sum = 0;
  double worst = std::numeric_limits<double>::infinity();
  int cases = 0;
  bool all_same = true;
  for (const auto& file : lisco_apps::expandInputs(inputs)) {
    const std::string name = file.stem().string();
    const auto entry = ground.find(name);
    const float ground_z = entry == ground.end() ? -std::numeric_limits<float>::infinity() : entry->second;
    const Cloud::Ptr raw = lisco_apps::readCloudFile(file);
    auto cloud = withoutGround(*raw, ground_z);
    auto indices = std::make_shared<pcl::Indices>(lisco_apps::returnsAbove(*raw, ground_z));
    if (unorganized) {  // the returns alone, in the file's order
      auto dense = std::make_shared<pcl::PointCloud<Point>>();
      pcl::copyPointCloud(*cloud, *indices, *dense);
      cloud = dense;
      for (std::size_t i = 0; i < indices->size(); ++i) (*indices)[i] = static_cast<pcl::index_t>(i);
      indices->resize(dense->size());
    }
    pcl::LiscoClusterExtraction<Point> lisco;
    for (const double tolerance : tolerances) {
      const auto by_lisco = [&](Clusters& clusters) {
        lisco.setInputCloud(cloud);
        lisco.setClusterTolerance(tolerance);
        lisco.setMinClusterSize(10);
        lisco.extract(clusters);
      };
      const auto by_pcl = [&](Clusters& clusters) {
        pcl::EuclideanClusterExtraction<Point> pcl;
        pcl.setSearchMethod(std::make_shared<pcl::search::KdTree<Point>>(false));
        pcl.setInputCloud(cloud);
        pcl.setIndices(indices);
        pcl.setClusterTolerance(tolerance);
        pcl.setMinClusterSize(10);
        pcl.extract(clusters);
      };
      Clusters expected, found;
      by_pcl(expected);
      by_lisco(found);
      const bool identical = same(expected, found);
      all_same = all_same && identical;
      std::vector<double> pcl_first, pcl_second, lisco_first, lisco_second;
      for (int i = 0; identical && i < runs; ++i) {
        const Turn pcl_turn = timed([&] {
          Clusters c;
          by_pcl(c);
        });
        const Turn lisco_turn = timed([&] {
          Clusters c;
          by_lisco(c);
        });
        pcl_first.push_back(pcl_turn.first);
        pcl_second.push_back(pcl_turn.second);
        lisco_first.push_back(lisco_turn.first);
        lisco_second.push_back(lisco_turn.second);
      }
      if (!identical || runs == 0) {
        std::printf("%-22s %9zu %5.2f %9zu %10s %10s %8s  %s\n", name.c_str(), indices->size(), tolerance,
                    expected.size(), "-", "-", "-", identical ? "yes" : "NO");
        continue;
      }
      const double pcl_ms = median(pcl_second);
      const double lisco_ms = median(lisco_second);
      std::printf("%-22s %9zu %5.2f %9zu %10.2f %10.3f %8.1f  yes\n", name.c_str(), indices->size(), tolerance,
                  expected.size(), pcl_ms, lisco_ms, pcl_ms / lisco_ms);
      std::fflush(stdout);
      log_sum += std::log(pcl_ms / lisco_ms);
      first_log_sum += std::log(median(pcl_first) / median(lisco_first));
      worst = std::min(worst, pcl_ms / lisco_ms);
      ++cases;
    }
  }
  if (cases > 0)
    std::printf("geometric mean of the ratios %.1f, lowest %.1f, %d cases; of first runs, with cold memory, %.1f\n",
                std::exp(log_sum / cases), worst, cases, std::exp(first_log_sum / cases));
  return all_same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  omp_set_num_threads(1);  // PCL's kd-tree would wake threads that spin on while its rival runs
  po::options_description options("against_pcl [options] SCAN-OR-FOLDER...");
  options.add_options()("help", "print this")("input", po::value<std::vector<std::string>>(), "scans or folders")(
      "ground", po::value<std::vector<std::string>>()->default_value({}, ""),
      "NAME=Z: remove what lies below z of the scan with that file name (without its ending)")(
      "tolerance",
      po::value<std::vector<double>>()->multitoken()->default_value({0.1, 0.3, 0.4, 0.7, 1.0}, "0.1 0.3 0.4 0.7 1.0"),
      "metres")("runs", po::value<int>()->default_value(5), "timed runs of each; 0: only compare the clusters")(
      "unorganized", po::bool_switch(), "cluster the returns as an unorganized cloud");
  po::positional_options_description positional;
  positional.add("input", -1);
  try {
    po::variables_map given;
    po::store(po::command_line_parser(argc, argv).options(options).positional(positional).run(), given);
    po::notify(given);
    if (given.count("help") || !given.count("input")) {
      std::cout << options;
      return given.count("help") ? 0 : 2;
    }
    std::map<std::string, float> ground;
    for (const std::string& entry : given["ground"].as<std::vector<std::string>>())
      ground[entry.substr(0, entry.find('='))] = std::stof(entry.substr(entry.find('=') + 1));
    return run(given["input"].as<std::vector<std::string>>(), ground, given["tolerance"].as<std::vector<double>>(),
               std::max(0, given["runs"].as<int>()), given["unorganized"].as<bool>());
  } catch (const std::exception& error) {
    std::cerr << "against_pcl: " << error.what() << '\n';
    return 2;
  }
}
