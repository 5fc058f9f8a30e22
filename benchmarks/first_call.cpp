// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The first extraction of a process, whose memory and code are new, against later ones.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <omp.h>

#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "compare/comparison.h"
#include "compare/report.h"
#include "io/options.h"
#include "io/scan_file.h"
#include "io/text.h"
#include "organized_scans.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

/// What a process measured: milliseconds, and pages that the first call touched first.
struct Calls {
  double first, later;
  long pages;
};

long pageFaults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

/// The first call of this process and the median of some later ones, on the same object.
Calls timeCalls(const Problem& problem, Clusters& clusters) {
  constexpr int kLater = 5;
  pcl::LiscoClusterExtraction<ComparedPoint> extraction;
  const auto extract = [&](Clusters& found) {
    extraction.setInputCloud(problem.cloud);
    extraction.setClusterTolerance(problem.tolerance);
    extraction.setMinClusterSize(problem.min_size);
    extraction.extract(found);
  };
  Calls calls{};
  const long before = pageFaults();
  calls.first = runMs([&] { extract(clusters); });
  calls.pages = pageFaults() - before;
  std::vector<double> later;
  for (int i = 0; i < kLater; ++i) {
    Clusters again;
    later.push_back(runMs([&] { extract(again); }));
  }
  calls.later = median(later);
  return calls;
}

/// Times the calls in this process, and prints them and whether the clusters are PCL's.
void timeHere(const lisco_benchmarks::OrganizedScans& scans) {
  scans.forEach([&](const std::string&, const ComparedScan& scan) {
    Problem problem;
    problem.cloud = scan.cloud;
    problem.returns = scan.returns;
    problem.tolerance = scans.tolerances.front();
    problem.min_size = 10;
    Clusters clusters, expected;
    const Calls calls = timeCalls(problem, clusters);
    referenceBaseline().extract(problem, expected);
    if (!differenceOf(problem, referenceBaseline(), expected, Baseline(), clusters, false).identical)
      throw std::runtime_error("the clusters are not those of EuclideanClusterExtraction");
    std::printf("%zu %zu %.6f %.6f %ld\n", scan.cloud->size(), scan.returns->size(), calls.first, calls.later,
                calls.pages);
  });
}

/// What timeHere () prints in a process of its own.
/// \throws std::runtime_error if it fails
std::string timeInProcess(std::vector<std::string> arguments) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv("/proc/self/exe", pointers.data());
    _exit(2);
  }
  close(ends[1]);
  std::string line;
  char buffer[256];
  for (ssize_t count = 0; (count = read(ends[0], buffer, sizeof buffer)) > 0;)
    line.append(buffer, static_cast<std::size_t>(count));
  close(ends[0]);
  int status = 0;
  if (waitpid(child, &status, 0) != child || status != 0) throw std::runtime_error("a process failed");
  return line;
}

int run(const lisco_benchmarks::OrganizedScans& scans, unsigned runs) {
  CompareSettings untimed;
  untimed.runs = 0;
  std::fputs(describeRun(untimed).c_str(), stdout);
  std::printf("%u processes for each, medians, milliseconds; later: the next five calls on the same object\n", runs);
  std::printf("%-22s %8s %8s %5s %9s %9s %7s %7s\n", "scan", "cells", "returns", "eps", "first", "later", "ratio",
              "pages");
  std::vector<double> ratios;
  std::vector<std::string> failures;
  const auto files = expandInputs(scans.inputs, failures);
  if (!failures.empty()) throw std::runtime_error(failures.front());
  for (const auto& file : files)
    for (const double tolerance : scans.tolerances) {
      std::vector<std::string> arguments{"first_call", file.string(), "--here", "--tolerance",
                                         formatted("%g", tolerance)};
      for (const std::string& item : scans.ground) arguments.insert(arguments.end(), {"--ground-z", item});
      std::vector<double> first, later, pages;
      std::size_t cells = 0;
      std::size_t returns = 0;
      for (unsigned i = 0; i < runs; ++i) {
        Calls calls{};
        const std::string line = timeInProcess(arguments);
        if (std::sscanf(line.c_str(), "%zu %zu %lf %lf %ld", &cells, &returns, &calls.first, &calls.later,
                        &calls.pages) != 5)
          throw std::runtime_error("a process printed no times");
        first.push_back(calls.first);
        later.push_back(calls.later);
        pages.push_back(static_cast<double>(calls.pages));
      }
      ratios.push_back(median(first) / median(later));
      std::printf("%-22s %8zu %8zu %5.2f %9.3f %9.3f %7.2f %7.0f\n", file.stem().c_str(), cells, returns, tolerance,
                  median(first), median(later), ratios.back(), median(pages));
      std::fflush(stdout);
    }
  std::printf("first / later: geometric mean %.2f, highest %.2f; at most 1.4 is wanted\n", geometricMean(ratios),
              *std::max_element(ratios.begin(), ratios.end()));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  return runProgram("first_call", [&] {
    po::options_description shown(
        "Usage: first_call SCAN-OR-FOLDER... [options]\n\n"
        "The time of the first pcl::LiscoClusterExtraction::extract () of a process, for organized scans, against "
        "that\n"
        "of later calls; one thread, clusters of at least 10 returns.\n\n"
        "Exit code: 2 on bad input or usage, or if the clusters are not those of EuclideanClusterExtraction.\n\n"
        "Options");
    lisco_benchmarks::OrganizedScans scans;
    std::string runs = "11";
    scans.addTo(shown, "0.1,0.4,1");
    bool is_here = false;
    po::options_description hidden;
    hidden.add_options()("here", po::bool_switch(&is_here), "time in this process");
    shown.add_options()("runs", po::value<std::string>(&runs)->value_name("N"), "processes (default 11)");
    po::variables_map given;
    if (!readCommandLine(argc, argv, "first_call", shown, &scans.inputs, given, hidden)) return 0;
    scans.check();
    if (is_here) {
      timeHere(scans);
      return 0;
    }
    return run(scans, countOf(runs, "--runs", 1));
  });
}
