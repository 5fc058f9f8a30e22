// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Extracts the clusters of a scan again and again, for tools that count instructions.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <omp.h>

#include "lisco/simd.h"
#include "organized_scans.h"

namespace {

using namespace lisco_apps;

int run(const lisco_benchmarks::OrganizedScans& scans, const std::string& key, unsigned count) {
  std::vector<Baseline> baselines = allBaselines();
  const auto baseline =
      std::find_if(baselines.begin(), baselines.end(), [&](const Baseline& one) { return one.key == key; });
  if (baseline == baselines.end()) throw std::runtime_error("--baseline: there is no baseline '" + key + "'");
  scans.forEach([&](const std::string& name, const ComparedScan& scan) {
    Problem problem;
    problem.cloud = scan.cloud;
    problem.returns = scan.returns;
    problem.tolerance = scans.tolerances.front();
    std::size_t found = 0;
    for (unsigned i = 0; i < count; ++i) {
      Clusters clusters;
      baseline->extract(problem, clusters);
      found = clusters.size();
    }
    std::printf("%s,%zu,%g,%s,%s,%u,%zu\n", name.c_str(), scan.returns->size(), problem.tolerance, key.c_str(),
                lisco::simdLevel().c_str(), count, found);
  });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);
  return runProgram("extractions", [&] {
    boost::program_options::options_description shown(
        "Usage: extractions SCAN --baseline KEY --count N [options]\n\n"
        "Extracts the clusters of a scan N times by one of lisco_compare's baselines, on one thread. The instructions "
        "of\n"
        "one extraction are the difference between those of two programs over that of their counts.\n\n"
        "Options");
    lisco_benchmarks::OrganizedScans scans;
    std::string key = "lisco";
    std::string level;
    unsigned count = 1;
    scans.addTo(shown, "0.4");
    shown.add_options()("baseline", boost::program_options::value(&key)->value_name("KEY"), "(default lisco)")(
        "simd", boost::program_options::value(&level)->value_name("LEVEL"), "vector instructions (default: the best)")(
        "count", countOption("--count", count, 0), "(default 1)");
    boost::program_options::variables_map given;
    if (!readCommandLine(argc, argv, "extractions", shown, &scans.inputs, given)) return 0;
    scans.check();
    if (!lisco::useSimdLevel(level)) throw std::runtime_error("--simd: this machine has no level '" + level + "'");
    return run(scans, key, count);
  });
}
