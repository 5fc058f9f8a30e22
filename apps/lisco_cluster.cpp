// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Clusters scan files and writes what it found.
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
#include "io/progress_bar.h"
#include "io/result_files.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;

struct Options {
  std::vector<std::string> inputs;
  double tolerance = 0;
  unsigned min_size = 10;
  unsigned max_size = std::numeric_limits<int>::max();
  float ground_z = -std::numeric_limits<float>::infinity();
  fs::path output;
  bool cloud_per_cluster = false;
  unsigned threads = 1;  ///< files worked on side by side
};

double milliseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: lisco_cluster INPUT... --tolerance M [options]\n\n"
      "Finds the Euclidean clusters of LiDAR scans: the clusters of PCL's EuclideanClusterExtraction.\n"
      "An input is a scan (.pcd .ply, KITTI .bin, the paper authors' .csv) or a folder of "
      "scans.\n\n"
      "Options");
  std::string tolerance;
  std::string ground_z;
  std::string min_size = "10";
  std::string max_size;
  std::string threads = "1";
  std::string output;
  // clang-format off
  shown.add_options()
    ("tolerance,t", po::value<std::string>(&tolerance)->value_name("M"),
     "points nearer to each other than this many metres belong together")
    ("min-size", po::value<std::string>(&min_size)->value_name("N"), "least returns of a cluster (default 10)")
    ("max-size", po::value<std::string>(&max_size)->value_name("N"), "most returns of a cluster (default: no limit)")
    ("ground-z", po::value<std::string>(&ground_z)->value_name("M"),
     "leave out returns below this height in metres (default: none)")
    ("threads", po::value<std::string>(&threads)->value_name("N"),
     "work on N files side by side (default 1; 0: as many as there are processors)")
    ("output,o", po::value<std::string>(&output)->value_name("DIR"),
     "folder for labels.pcd, clusters.csv, range_image.png and top_view.png; of several inputs, each has a folder in it")
    ("clouds", po::bool_switch(&options.cloud_per_cluster), "also write one cloud per cluster (needs --output)");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "lisco_cluster", shown, &options.inputs, given)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  if (given.count("tolerance") == 0) throw std::runtime_error("--tolerance is missing; see --help");
  options.tolerance = toleranceOf(tolerance);
  if (given.count("ground-z") != 0) options.ground_z = heightOf(ground_z);
  options.min_size = countOf(min_size, "--min-size", 1);
  if (given.count("max-size") != 0) options.max_size = countOf(max_size, "--max-size", 1);
  if (options.max_size < options.min_size) throw std::runtime_error("--max-size is smaller than --min-size");
  options.threads = countOf(threads, "--threads", 0);
  if (options.threads == 0) options.threads = std::max(1U, std::thread::hardware_concurrency());
  if (given.count("output") != 0 && output.empty()) throw std::runtime_error("--output is empty");
  options.output = output;
  if (options.cloud_per_cluster && output.empty()) throw std::runtime_error("--clouds needs --output");
  return true;
}

/// What was found in one scan, for a person.
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
  if (std::isfinite(options.ground_z))
    std::printf(", %zu above the ground (z >= %g m)", scan.clustered.size(), static_cast<double>(options.ground_z));
  std::printf("\n  clusters  %zu of at least %u returns within %g m of each other; %zu returns are noise\n",
              scan.clusters.size(), options.min_size, options.tolerance, scan.clustered.size() - in_clusters);
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

/// A file and where its results go (nowhere, if empty).
struct Job {
  fs::path file, folder;
};

/// One job per input file; all_well tells whether there are files in all folders. Of several, each has a folder of its
/// own, numbered where file names repeat.
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

/// Works off jobs one after the other; any number of workers may share them.
class Workers {
 public:
  Workers(const Options& options, std::vector<Job> jobs)
      : options_(options), jobs_(std::move(jobs)), progress_(jobs_.size() > 1) {}

  /// \return whether all went well
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
    extraction.setClusterTolerance(options_.tolerance);
    extraction.setMinClusterSize(options_.min_size);
    extraction.setMaxClusterSize(options_.max_size);
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
    scan.tolerance = options_.tolerance;
    scan.cloud = readCloudFile(job.file);
    if (scan.cloud->empty()) throw std::runtime_error(job.file.string() + ": holds no points");
    scan.clustered = returnsAbove(*scan.cloud, options_.ground_z);

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
  std::mutex terminal_;  ///< guards what follows, and what is printed
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
