// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Clusters scan files and writes the clusters as tables, clouds and pictures.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <boost/program_options.hpp>

#include "io/cloud_file.h"
#include "io/clusters.h"
#include "io/options.h"
#include "io/terminal_line.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

struct Options {
  std::vector<std::string> inputs;
  ClusterOptions clustering;
  fs::path output;
  bool cloud_per_cluster = false;
  unsigned threads = 1;  ///< files clustered at the same time
};

double milliseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

/// \return false if --help or --version was given
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: lisco_cluster INPUT... --tolerance M [options]\n\n"
      "Finds the Euclidean clusters of LiDAR scans: the clusters of PCL's EuclideanClusterExtraction.\n"
      "An input is a scan (.pcd .ply, KITTI .bin, the paper authors' .csv) or a folder of scans.\n\n"
      "Options");
  options.clustering.addTo(shown);
  // clang-format off
  shown.add_options()
    ("threads", countOption("--threads", options.threads, 0),
     "cluster N files at the same time (default 1; 0: one per processor)")
    ("output,o", pathOption("DIR", "--output", options.output),
     "folder for labels.pcd, clusters.csv, range_image.png and top_view.png; with several inputs, a folder in it for "
     "each")
    ("clouds", po::bool_switch(&options.cloud_per_cluster), "also write one cloud per cluster (needs --output)");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "lisco_cluster", shown, &options.inputs, given)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  options.clustering.check();
  if (options.threads == 0) options.threads = std::max(1U, std::thread::hardware_concurrency());
  if (options.cloud_per_cluster && options.output.empty()) throw std::runtime_error("--clouds needs --output");
  return true;
}

/// Prints the result for one scan.
void printSummary(const ClusteredScan& scan, const Options& options, double read_ms, double cluster_ms, double write_ms,
                  const fs::path& folder) {
  const Cloud& cloud = *scan.cloud;
  const std::size_t returns = returnsAbove(cloud, -std::numeric_limits<float>::infinity()).size();
  std::size_t in_clusters = 0;
  for (const auto& cluster : scan.clusters) in_clusters += cluster.indices.size();

  std::printf("%s\n", scan.name.c_str());
  if (cloud.height > 1)
    std::printf("  scan      %u rows x %u columns, %zu returns", cloud.height, cloud.width, returns);
  else
    std::printf("  scan      unorganized, %zu points, %zu returns", cloud.size(), returns);
  if (std::isfinite(options.clustering.ground_z))
    std::printf(", %zu above the ground (z >= %g m)", scan.clustered.size(),
                static_cast<double>(options.clustering.ground_z));
  std::printf("\n  clusters  %zu of at least %u returns within %g m of each other; %zu returns are noise\n",
              scan.clusters.size(), options.clustering.min_size, scan.tolerance, scan.clustered.size() - in_clusters);
  if (!scan.clusters.empty())  // sorted by size
    std::printf("  sizes     largest %zu, median %zu, smallest %zu\n", scan.clusters.front().indices.size(),
                scan.clusters[scan.clusters.size() / 2].indices.size(), scan.clusters.back().indices.size());
  if (!scan.clusters.empty() && 2 * scan.clusters.front().indices.size() > scan.clustered.size())
    std::printf(
        "  note      one cluster has more than half of these returns: is it the ground (see --ground-z), or is the "
        "tolerance too large?\n");
  std::printf("  time      read %.1f ms, cluster %.2f ms", read_ms, cluster_ms);
  if (!folder.empty()) std::printf(", write %.1f ms\n  written   %s", write_ms, folder.c_str());
  std::printf("\n");
}

struct Job {
  fs::path file;
  fs::path folder;  ///< of its results; empty: none are written
};

/// One job per input file. Results of several go to a folder each, numbered where file names repeat.
/// \param all_well set to whether every input folder holds scans
std::vector<Job> jobsOf(const Options& options, bool& all_well) {
  std::vector<std::string> failures;
  const std::vector<fs::path> files = expandInputs(options.inputs, failures);
  for (const std::string& failure : failures) std::cerr << "lisco_cluster: " << failure << '\n';
  all_well = failures.empty();
  const std::vector<std::string> names = namesOf(files);
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < files.size(); ++i)
    jobs.push_back(
        {files[i], options.output.empty() || files.size() == 1 ? options.output : options.output / names[i]});
  return jobs;
}

/// Threads that share a list of jobs.
class Workers {
 public:
  Workers(const Options& options, std::vector<Job> jobs)
      : options_(options), jobs_(std::move(jobs)), progress_(jobs_.size() > 1) {}

  /// \return whether all jobs succeeded
  bool run() {
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < std::min<std::size_t>(options_.threads, jobs_.size()); ++i)
      others.emplace_back([this] { work(); });
    work();
    for (std::thread& other : others) other.join();
    return all_well_;
  }

 private:
  void work() {
    pcl::LiscoClusterExtraction<pcl::PointXYZ> extraction;
    extraction.setClusterTolerance(options_.clustering.tolerance);
    extraction.setMinClusterSize(options_.clustering.min_size);
    extraction.setMaxClusterSize(options_.clustering.max_size);
    for (std::size_t job = next_++; job < jobs_.size(); job = next_++) {
      {
        const std::lock_guard<std::mutex> lock(terminal_);
        progress_.show(static_cast<double>(done_) / static_cast<double>(jobs_.size()),
                       jobs_[job].file.filename().string());
      }
      std::string failure;
      try {
        clusterFile(jobs_[job], extraction);
      } catch (const std::exception& error) {
        failure = error.what();
      }
      const std::lock_guard<std::mutex> lock(terminal_);
      ++done_;
      if (failure.empty()) continue;
      progress_.clear();
      std::cerr << "lisco_cluster: " << failure << '\n';
      all_well_ = false;
    }
  }

  void clusterFile(const Job& job, pcl::LiscoClusterExtraction<pcl::PointXYZ>& extraction) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    ClusteredScan scan;
    scan.name = job.file.filename().string();
    scan.tolerance = options_.clustering.tolerance;
    scan.cloud = readCloudFile(job.file);
    if (scan.cloud->empty()) throw std::runtime_error(job.file.string() + ": holds no points");
    scan.clustered = returnsAbove(*scan.cloud, options_.clustering.ground_z);

    const auto read = Clock::now();
    extraction.setInputCloud(scan.cloud);
    extraction.setIndices(std::make_shared<const pcl::Indices>(scan.clustered));
    extraction.extract(scan.clusters);

    const auto clustered = Clock::now();
    if (!job.folder.empty()) writeResults(scan, job.folder, options_.cloud_per_cluster);
    const auto written = Clock::now();

    const std::lock_guard<std::mutex> lock(terminal_);
    progress_.clear();
    printSummary(scan, options_, milliseconds(read - start), milliseconds(clustered - read),
                 milliseconds(written - clustered), job.folder);
  }

  const Options& options_;
  const std::vector<Job> jobs_;
  std::atomic<std::size_t> next_{0};
  std::mutex terminal_;  ///< guards the terminal and the members after it
  ProgressBar progress_;
  std::size_t done_ = 0;
  bool all_well_ = true;
};

}  // namespace

int main(int argc, char** argv) {
  return runProgram("lisco_cluster", [&] {
    Options options;
    if (!parse(argc, argv, options)) return 0;
    bool all_well = true;
    const bool worked_off = Workers(options, jobsOf(options, all_well)).run();
    return all_well && worked_off ? 0 : 2;
  });
}
